#pragma once

#include <snug/bounds/interval_triangle.h>
#include <snug/bounds/offset_triangle.h>
#include <snug/geometry/scaling.h>

namespace snug {

/// Enclosures back in mesh units.
/// Guarantee: they contain all that they contained; where scaling is not exact they are widened.
/// Errors:    InputError if a coordinate no longer fits a double.
[[nodiscard]] OffsetTriangle unscaled(const OffsetTriangle& triangle, PowerOfTwo back);
[[nodiscard]] IntervalTriangle unscaled(const IntervalTriangle& triangle, PowerOfTwo back);
[[nodiscard]] Box3 unscaled(const Box3& box, PowerOfTwo back);

/// A lower bound, an upper bound of a distance, back in mesh units. Upper ones may be infinite.
[[nodiscard]] double unscaled_down(double x, PowerOfTwo back);
[[nodiscard]] double unscaled_up(double x, PowerOfTwo back);

}  // namespace snug
