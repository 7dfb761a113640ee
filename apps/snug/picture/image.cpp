#include <picture/image.h>

#include <png.h>

#include <string>

#include <support/error.h>

namespace snug {

std::vector<std::uint8_t> encode_png(const Image& image) {
  require_value(image.width >= 1 && image.height >= 1, "picture: width and height must be at least 1");
  require_value(image.rgb.size() == std::size_t{3} * image.width * image.height,
                "picture: there must be three bytes a pixel");
  png_image png{};
  png.version = PNG_IMAGE_VERSION;
  png.width = static_cast<png_uint_32>(image.width);
  png.height = static_cast<png_uint_32>(image.height);
  png.format = PNG_FORMAT_RGB;
  std::vector<std::uint8_t> bytes(PNG_IMAGE_PNG_SIZE_MAX(png));
  png_alloc_size_t size = bytes.size();
  // libpng's simplified interface reports by value: no longjmp passes through this function.
  if (!png_image_write_to_memory(&png, bytes.data(), &size, 0, image.rgb.data(), 0, nullptr))
    throw InputError(InputProblem::refused, "PNG cannot hold a picture of " + std::to_string(image.width) +
                                                " x " + std::to_string(image.height) +
                                                " pixels: " + png.message);
  bytes.resize(size);
  return bytes;
}

}  // namespace snug
