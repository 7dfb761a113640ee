#pragma once

#include <cmath>

#include <snug/geometry/point.h>

namespace snug {

/// The direction of a vector, of length 1 up to 5 roundings; zero for a vector that has none: zero, not finite, or below
/// about 1e-308.
///
/// Made from coordinates of about 1: squares of vectors shorter than 1e-150 lose digits, and the direction its length.
inline Vector3 normalized(const Vector3& v) {
  const double size = max_abs(v);
  if (!(size > 0) || !std::isfinite(1 / size)) return {};
  const Vector3 w = (1 / size) * v;
  const double rest = length(w);
  return rest > 0 ? (1 / rest) * w : Vector3{};  // zero if it is not a number
}

}  // namespace snug
