#pragma once

#include <support/scaling.h>

namespace snug {

/// The direction of a vector of any length, 1 long up to 5 roundings; zero for zero or one not finite.
inline Vector3 normalized(const Vector3& v) {
  if (const double size = length(v); size >= 0x1p-400 && size <= 0x1p400) return (1 / size) * v;
  if (!is_finite(v) || v == Vector3{}) return {};
  // Squares underflow or overflow.
  const Vector3 scaled = PowerOfTwo::normalising(max_abs(v)).apply(v);
  return (1 / length(scaled)) * scaled;
}

}  // namespace snug
