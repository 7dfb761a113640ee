#include <snug/picture/image.h>

#include <gtest/gtest.h>
#include <png.h>

#include <random>

namespace snug {
namespace {

TEST(encode_png, decodes_to_the_same_pixels) {
  std::mt19937_64 random(31);
  for (const auto& [width, height] : {std::pair{1, 1}, {7, 3}, {64, 64}}) {
    Image image;
    image.width = width;
    image.height = height;
    image.rgb.resize(static_cast<std::size_t>(3 * width * height));
    for (auto& channel : image.rgb) channel = static_cast<std::uint8_t>(random());
    const auto bytes = encode_png(image);
    EXPECT_EQ(bytes, encode_png(image));

    png_image png{};
    png.version = PNG_IMAGE_VERSION;
    ASSERT_TRUE(png_image_begin_read_from_memory(&png, bytes.data(), bytes.size())) << png.message;
    png.format = PNG_FORMAT_RGB;
    EXPECT_EQ(png.width, static_cast<unsigned>(width));
    EXPECT_EQ(png.height, static_cast<unsigned>(height));
    std::vector<std::uint8_t> decoded(PNG_IMAGE_SIZE(png));
    ASSERT_TRUE(png_image_finish_read(&png, nullptr, decoded.data(), 0, nullptr)) << png.message;
    EXPECT_EQ(decoded, image.rgb);
  }
}

}  // namespace
}  // namespace snug
