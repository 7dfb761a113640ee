#pragma once

#include <snug/bounds/enclosure.h>
#include <snug/geometry/rounding.h>
#include <support/scaling.h>

namespace snug {

/// Enclosures back in mesh units.
/// Guarantee: they contain all that they contained; where scaling is not exact they are widened.
/// Errors:    InputError if a coordinate no longer fits a double.
template <std::size_t N>
[[nodiscard]] OffsetSimplex<N> unscaled(const OffsetSimplex<N>& simplex, PowerOfTwo back);
template <std::size_t N>
[[nodiscard]] IntervalSimplex<N> unscaled(const IntervalSimplex<N>& simplex, PowerOfTwo back);
[[nodiscard]] Box3 unscaled(const Box3& box, PowerOfTwo back);

/// A point, its error enlarged where scaling is not exact.
/// Errors:    likewise.
[[nodiscard]] BoundedPoint unscaled_exactly(const BoundedPoint& point, PowerOfTwo back);
[[nodiscard]] inline BoundedPoint unscaled(const BoundedPoint& point, PowerOfTwo back) {
  if (!back.moderate()) return unscaled_exactly(point, back);
  // Nothing overflows, and each product loses less than underflow_error.
  return {back.apply(point.position), back.apply(enlarged(point.error)) + 2 * underflow_error};
}

/// A lower bound, an upper bound of a distance, back in mesh units. Upper ones may be infinite.
[[nodiscard]] double unscaled_down(double x, PowerOfTwo back);
[[nodiscard]] double unscaled_up(double x, PowerOfTwo back);

}  // namespace snug
