#pragma once

#include <snug/enclose/hull_points.h>
#include <snug/enclose/triangle.h>

namespace snug {

/// All points within `radius` of a triangle: the triangle swept by a ball.
struct OffsetTriangle {
  Triangle base;
  double radius = 0;
  double rounding =
      0;  ///< the part of the radius that accounts for rounding; splitting does not make it smaller
};

/// The limit triangle of a patch moved along its normal, and the radius at which it covers the patch.
///
/// Guarantee: every limit point of the patch is within `radius` of `base`, these very doubles, rounding
/// included.
///            base is the triangle of the limit corners, moved to the middle of the hull along its normal;
///            one without a normal is not moved. Infinite radius if anything is not finite.
/// Tightness: the radius is at most 1.08 times the least possible for the same base in the median, but for
///            nearly flat patches with an extraordinary corner of valence above 6 (docs/convergence.md).
/// Requires:  corners: limit positions of the patch's corners, relative to points.origin.
/// Cost:      about 15 ns a hull point.
/// Source:    [Wu05, eq. 5.1, 5.2]; differs: fitted to hull rows instead of corner boxes,
/// derivations/hull_rows.md.
[[nodiscard]] OffsetTriangle offset_triangle(const HullPoints& points, const std::array<Vector3, 3>& corners);

}  // namespace snug
