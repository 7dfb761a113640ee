#pragma once

#include <snug/bounds/bounding_points.h>
#include <snug/geometry/triangle.h>

/// Enclosures of a piece of a limit surface (N = 3) or of a limit curve (N = 2), fitted to its bounding points.
///
/// Both are made from the triangle, or segment, of the piece's limit corners, moved to the middle of the hull
/// points: a triangle along its normal, if it has one; a segment by the middle of the two rests, point minus
/// foot, that are farthest apart.
namespace snug {

/// The radius at which the moved segment covers the piece.
///
/// Guarantee: every limit point of the piece is within `radius` of `base`, these very doubles, rounding
///            included. Infinite radius if anything is not finite.
/// Requires:  ends: limit positions of the piece's ends, relative to points.origin.
/// Source:    [Wu05, eq. 5.1, 5.2]; differs: fitted to bounding points instead of corner boxes,
///            derivations/curves.md.
[[nodiscard]] OffsetSegment offset_segment(const BoundingPoints& points, const std::array<Vector3, 2>& ends);

/// The same for a triangle, derivations/bounding_rows.md. Where a tip makes the radius larger than the patch
/// needs, it is refined first, and `points` with it.
///
/// Tightness: the radius is at most 1.08 times the least possible for the same base in the median, 1.02 on
///            gently bent nets (docs/convergence.md).
/// Requires:  points of bounding_points() with rows of this library.
/// Cost:      about 3 ns a bounding point, and one more fit, with about 30 more points, a refinement; on average
///            there is one for three tips.
[[nodiscard]] OffsetTriangle offset_triangle(BoundsCache& library, BoundingPoints& points,
                                             const std::array<Vector3, 3>& corners);

/// The corners of the moved simplex, widened alike until every bounding point is covered.
///
/// Guarantee: contains every limit point of the piece, rounding included.
/// Requires:  as offset_segment().
/// Source:    [Wu05, lemma 11]; differs: as offset_segment().
template <std::size_t N>
[[nodiscard]] IntervalSimplex<N> interval_simplex(const BoundingPoints& points,
                                                  const std::array<Vector3, N>& corners);

}  // namespace snug
