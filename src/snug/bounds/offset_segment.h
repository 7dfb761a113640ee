#pragma once

#include <snug/bounds/segment.h>

namespace snug {

/// All points within `radius` of a segment: the segment swept by a ball.
struct OffsetSegment {
  Segment base;
  double radius = 0;
  double rounding =
      0;  ///< the part of the radius that accounts for rounding; splitting does not make it smaller
};

/// The segment through the limit ends of a piece of a curve, moved to the middle of its hull points, and the
/// radius at which it covers the piece.
///
/// Guarantee: every limit point of the piece is within `radius` of `base`, these very doubles, rounding
///            included. Infinite radius if anything is not finite.
/// Requires:  ends: limit positions of both ends, relative to points.origin.
/// Source:    as offset_triangle.h; derivations/curves.md.
[[nodiscard]] OffsetSegment offset_segment(const HullPoints& points, const std::array<Vector3, 2>& ends);

}  // namespace snug
