#pragma once

#include <snug/bounds/hull_points.h>
#include <snug/geometry/triangle.h>

namespace snug {

/// Convex combinations of three boxes ("interval points"): sum l_k b_k with b_k in corner k's box, l_k >= 0,
/// sum l_k = 1.
struct IntervalTriangle {
  std::array<Box3, 3> corner;
};

/// Interval triangle around a patch: the corners of its base triangle, widened alike until every hull point
/// is covered.
///
/// Guarantee: contains every limit point of the patch, rounding included.
/// Requires:  as offset_triangle.
/// Cost:      about 15 ns a hull point.
/// Source:    [Wu05, lemma 11]; differs: fitted to hull rows instead of tabulated planes,
///            derivations/hull_rows.md.
[[nodiscard]] IntervalTriangle interval_triangle(const HullPoints& points,
                                                 const std::array<Vector3, 3>& corners);

/// Longest side of the three boxes [Wu05, sec. 4.7].
[[nodiscard]] double thickness(const IntervalTriangle& triangle);

}  // namespace snug
