#pragma once

#include <cmath>
#include <cstdint>

namespace snug {

/// A colour as it is shown: sRGB, each share in [0, 1].
struct Colour {
  double red = 0, green = 0, blue = 0;

  /// From the notation of the web: 0xff8000 is orange.
  [[nodiscard]] static constexpr Colour hex(std::uint32_t code) {
    return {((code >> 16) & 255) / 255.0, ((code >> 8) & 255) / 255.0, (code & 255) / 255.0};
  }
  friend constexpr bool operator==(const Colour&, const Colour&) = default;
};

/// Amounts of light, proportional to power: what may be added and averaged. 1 is paper white.
struct Radiance {
  double red = 0, green = 0, blue = 0;
  friend constexpr auto operator<=>(const Radiance&, const Radiance&) = default;
};

constexpr Radiance operator+(const Radiance& a, const Radiance& b) {
  return {a.red + b.red, a.green + b.green, a.blue + b.blue};
}
constexpr Radiance operator*(double s, const Radiance& a) { return {s * a.red, s * a.green, s * a.blue}; }
/// Light that is filtered: share by share.
constexpr Radiance operator*(const Radiance& a, const Radiance& b) {
  return {a.red * b.red, a.green * b.green, a.blue * b.blue};
}

/// The transfer curve of sRGB and its inverse, on [0, 1]. Source: IEC 61966-2-1.
[[nodiscard]] inline double light_from_srgb(double share) {
  return share <= 0.04045 ? share / 12.92 : std::pow((share + 0.055) / 1.055, 2.4);
}
[[nodiscard]] inline double srgb_from_light(double light) {
  return light <= 0.0031308 ? 12.92 * light : 1.055 * std::pow(light, 1 / 2.4) - 0.055;
}

[[nodiscard]] inline Radiance light_of(const Colour& c) {
  return {light_from_srgb(c.red), light_from_srgb(c.green), light_from_srgb(c.blue)};
}

}  // namespace snug
