#pragma once

#include <cstdint>
#include <vector>

namespace snug {

/// A picture: rows from the top, pixels from the left, three bytes (red, green, blue; sRGB) a pixel.
struct Image {
  int width = 0, height = 0;
  std::vector<std::uint8_t> rgb;
  friend bool operator==(const Image&, const Image&) = default;
};

/// The bytes of a PNG file that holds `image`.
///
/// Guarantee: lossless; the same image gives the same bytes with the same libpng and zlib (no time, no text).
/// Requires:  width, height >= 1; rgb.size() == 3 * width * height.
/// Errors:    InputError (refused) with libpng's words for an image that PNG cannot hold; (value) on
///            what is required.
/// Cost:      about 0.1 s for a million pixels.
[[nodiscard]] std::vector<std::uint8_t> encode_png(const Image& image);

}  // namespace snug
