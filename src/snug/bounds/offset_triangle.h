#pragma once

#include <snug/bounds/hull_points.h>
#include <snug/geometry/triangle.h>

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
/// Requires:  corners: limit positions of the patch's corners, relative to points.origin.
/// Cost:      about 15 ns a hull point.
/// Source:    [Wu05, eq. 5.1, 5.2]; differs: fitted to hull rows instead of corner boxes,
/// derivations/hull_rows.md.
[[nodiscard]] OffsetTriangle offset_triangle(const HullPoints& points, const std::array<Vector3, 3>& corners);

/// The same; where the net of a tip makes the radius larger than the patch needs, the tip is refined first, and
/// `points` with it.
///
/// Tightness: the radius is at most 1.08 times the least possible for the same base in the median, 1.02 on gently
///            bent nets (docs/convergence.md).
/// Requires:  points of hull_points() with rows of this library.
/// Cost:      one fit, and one more with about 200 points a refinement, of which there are at most three.
[[nodiscard]] OffsetTriangle offset_triangle(BoundsCache& library, HullPoints& points,
                                             const std::array<Vector3, 3>& corners);

}  // namespace snug
