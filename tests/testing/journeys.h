#pragma once

#include <snug/mesh.h>

#include <array>
#include <cmath>
#include <cstdint>
#include <random>
#include <string>
#include <vector>

/// Ways in which the control points of a surface come from somewhere else to where they are.
namespace snug::testing {

enum class Journey : std::uint8_t {
  tiny,        ///< by a billionth
  thrown,      ///< each point by about the size of the whole
  turned,      ///< as a whole
  bent,        ///< by half a turn
  mirrored,    ///< turned inside out
  from_plane,  ///< all in a plane
  from_line,
  from_point,
  from_small,  ///< 1e-3 times as large
  from_large,  ///< 1e3 times
  from_huge,   ///< 1e200 times
};
inline constexpr std::size_t journey_count = 11;

[[nodiscard]] inline std::string name_of(Journey journey) {
  static const std::array<const char*, journey_count> names{
      "tiny",      "thrown",     "turned",     "bent",       "mirrored", "from a plane",
      "from line", "from point", "from small", "from large", "from huge"};
  return names[static_cast<std::size_t>(journey)];
}

/// Where points that are here now have been.
[[nodiscard]] inline std::vector<Point3> start_of(Journey journey, const std::vector<Point3>& here,
                                                  std::mt19937_64& random) {
  double size = 0;
  for (const Point3& p : here) size = std::max({size, std::abs(p.x), std::abs(p.y), std::abs(p.z)});
  std::uniform_real_distribution<double> unit(-1, 1);
  const auto noise = [&](double by) { return by * size * unit(random); };
  std::vector<Point3> start = here;
  for (Point3& p : start) {
    const Point3 q = p;
    switch (journey) {
      case Journey::tiny:
        p = {q.x + noise(1e-9), q.y + noise(1e-9), q.z + noise(1e-9)};
        break;
      case Journey::thrown:
        p = {q.x + noise(1), q.y + noise(1), q.z + noise(1)};
        break;
      case Journey::turned:
        p = {0.36 * q.x - 0.48 * q.y + 0.8 * q.z, 0.8 * q.x + 0.6 * q.y,
             -0.48 * q.x + 0.64 * q.y + 0.6 * q.z};
        break;
      case Journey::bent: {
        const double angle = size > 0 ? 3 * q.x / size : 0;
        p = {(size + q.z) * std::sin(angle), q.y, (size + q.z) * std::cos(angle)};
        break;
      }
      case Journey::mirrored:
        p.x = -q.x;
        break;
      case Journey::from_plane:
        p.z = 0.25 * q.x;
        break;
      case Journey::from_line:
        p = {q.x, 2 * q.x, 3 * q.x};
        break;
      case Journey::from_point:
        p = {0.5 * size, 1, -1};
        break;
      case Journey::from_small:
      case Journey::from_large:
      case Journey::from_huge: {
        const double by = journey == Journey::from_small   ? 1e-3
                          : journey == Journey::from_large ? 1e3
                                                           : 1e200;
        p = {by * q.x, by * q.y, by * q.z};
        break;
      }
    }
  }
  return start;
}

}  // namespace snug::testing
