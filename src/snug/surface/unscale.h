#pragma once

#include <snug/base/rounding.h>
#include <snug/base/scaling.h>
#include <snug/enclose/interval_triangle.h>
#include <snug/enclose/offset_triangle.h>

namespace snug {

/// Enclosures back in mesh units.
/// Guarantee: they contain all that they contained; where scaling is not exact they are widened.
/// Errors:    InputError if a coordinate no longer fits a double.
[[nodiscard]] inline OffsetTriangle unscaled(const OffsetTriangle& triangle, PowerOfTwo back);
[[nodiscard]] IntervalTriangle unscaled(const IntervalTriangle& triangle, PowerOfTwo back);
[[nodiscard]] Box3 unscaled(const Box3& box, PowerOfTwo back);

/// A lower bound, an upper bound of a distance, back in mesh units. Upper ones may be infinite.
[[nodiscard]] double unscaled_down(double x, PowerOfTwo back);
[[nodiscard]] double unscaled_up(double x, PowerOfTwo back);

/// unscaled() at any power of two.
[[nodiscard]] OffsetTriangle unscaled_with_care(const OffsetTriangle& triangle, PowerOfTwo back);

OffsetTriangle unscaled(const OffsetTriangle& triangle, PowerOfTwo back) {
  if (!back.moderate() || !(triangle.radius <= 0x1p50)) return unscaled_with_care(triangle, back);
  // What underflow may take from the base and the radius costs less than testing for it.
  const double factor = back.factor();
  OffsetTriangle result;
  for (std::size_t k = 0; k < 3; ++k) {
    const Point3& p = triangle.base[k];
    result.base[k] = {factor * p.x, factor * p.y, factor * p.z};
  }
  result.radius = enlarged(factor * triangle.radius + 4 * underflow_error);
  result.rounding = enlarged(factor * triangle.rounding + 4 * underflow_error);
  return result;
}

}  // namespace snug
