#include <picture/image.h>

#include <gtest/gtest.h>
#include <png.h>

#include <random>
#include <string>

#include <support/error.h>

namespace snug::image_test {
namespace {

Image decode(const std::vector<std::uint8_t>& bytes) {
  png_image png{};
  png.version = PNG_IMAGE_VERSION;
  EXPECT_NE(png_image_begin_read_from_memory(&png, bytes.data(), bytes.size()), 0) << png.message;
  png.format = PNG_FORMAT_RGB;
  Image image{static_cast<int>(png.width), static_cast<int>(png.height), {}};
  image.rgb.resize(PNG_IMAGE_SIZE(png));
  EXPECT_NE(png_image_finish_read(&png, nullptr, image.rgb.data(), 0, nullptr), 0) << png.message;
  return image;
}

Image noise(int width, int height) {
  std::mt19937 random(11);
  Image image{width, height, std::vector<std::uint8_t>(std::size_t{3} * width * height)};
  for (std::uint8_t& byte : image.rgb) byte = static_cast<std::uint8_t>(random());
  return image;
}

TEST(image, png_decodes_back_to_the_same_pixels) {
  for (const auto& [width, height] : {std::pair{1, 1}, {3, 2}, {1, 200}, {257, 1}, {120, 90}}) {
    const Image image = noise(width, height);
    EXPECT_EQ(decode(encode_png(image)), image) << width << " x " << height;
  }
}

TEST(image, png_bytes_carry_no_time_or_text_and_repeat) {
  const Image image = noise(40, 30);
  const std::vector<std::uint8_t> bytes = encode_png(image);
  EXPECT_EQ(bytes, encode_png(image));
  std::string chunks;
  for (std::size_t at = 8; at + 8 <= bytes.size();) {
    const std::size_t size = bytes[at] << 24U | bytes[at + 1] << 16U | bytes[at + 2] << 8U | bytes[at + 3];
    chunks += std::string(bytes.begin() + static_cast<std::ptrdiff_t>(at) + 4,
                          bytes.begin() + static_cast<std::ptrdiff_t>(at) + 8) +
              ' ';
    at += size + 12;
  }
  for (const char* changing : {"tIME", "tEXt", "zTXt", "iTXt"})
    EXPECT_EQ(chunks.find(changing), std::string::npos) << chunks;
  EXPECT_NE(chunks.find("IEND"), std::string::npos) << chunks;
}

TEST(image, png_refuses_a_width_that_libpng_does_not_write) {
  const Image image = noise(1'000'001, 1);
  try {
    (void)encode_png(image);
    FAIL() << "not refused";
  } catch (const InputError& error) {
    EXPECT_EQ(error.problem(), InputProblem::refused);
    EXPECT_NE(std::string(error.what()).find("1000001 x 1"), std::string::npos) << error.what();
  }
}

TEST(image, png_expects_a_pixel_for_each_place) {
  EXPECT_THROW((void)encode_png({0, 0, {}}), InputError);
  EXPECT_THROW((void)encode_png({2, 2, std::vector<std::uint8_t>(11)}), InputError);
}

}  // namespace
}  // namespace snug::image_test
