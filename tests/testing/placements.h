#pragma once

#include <cmath>
#include <random>

#include <snug/geometry/motion.h>

namespace snug::testing {

/// A random rotation about the origin and a translation, rigid to a few roundings.
[[nodiscard]] inline Motion random_placement(std::mt19937_64& random, const Vector3& translation) {
  std::normal_distribution<double> normal;
  double w = normal(random), x = normal(random), y = normal(random), z = normal(random);
  const double s = 1 / std::sqrt(w * w + x * x + y * y + z * z);
  w *= s, x *= s, y *= s, z *= s;
  return Motion::from_3x4({1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y), translation.x,
                           2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x), translation.y,
                           2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y), translation.z});
}

[[nodiscard]] inline Vector3 random_vector(std::mt19937_64& random, double half_side) {
  std::uniform_real_distribution<double> unit(-half_side, half_side);
  return {unit(random), unit(random), unit(random)};
}

}  // namespace snug::testing
