#pragma once

#include <snug/bounds/segment.h>

namespace snug {

/// Convex combinations of two boxes: (1 - l) b_0 + l b_1 with b_k in end k's box, 0 <= l <= 1.
struct IntervalSegment {
  std::array<Box3, 2> end;
};

/// Interval segment around a piece of a curve: the ends of its base segment, widened alike until every hull
/// point is covered.
///
/// Guarantee: contains every limit point of the piece, rounding included.
/// Requires:  as offset_segment.
/// Source:    as interval_triangle.h; derivations/curves.md.
[[nodiscard]] IntervalSegment interval_segment(const HullPoints& points, const std::array<Vector3, 2>& ends);

/// Longest side of both boxes.
[[nodiscard]] double thickness(const IntervalSegment& segment);

}  // namespace snug
