#pragma once

#include <array>

#include <snug/bounds/hull_points.h>

namespace snug {

using Segment = std::array<Point3, 2>;

/// Feet of many points on one segment, prepared once. The segment may be a point.
///
/// Guarantee: 0 <= t <= 1: whatever the rounding, a + t (b - a) is a point of the segment. That it is the
///            nearest one is true up to rounding only, and no proof rests on it.
class SegmentFoot {
 public:
  SegmentFoot(const Vector3& a, const Vector3& b);
  /// p - foot, off by at most foot_error(reach) a coordinate (base_triangle.h), where |p - a| and the edge
  /// are at most `reach`.
  [[nodiscard]] Vector3 rest(const Vector3& p) const;

 private:
  Vector3 a_, edge_;
  double inverse_;  // of the squared length; 0 for a point
};

/// The segment through both limit ends of a piece of a curve, moved to the middle of its hull points: what
/// offset and interval segments share.
struct BaseSegment {
  std::array<Vector3, 2> relative;  ///< to the hull points' origin
  Segment placed;                   ///< origin + relative, rounded
  double placing_error;             ///< of `placed`, a coordinate
  double reach;  ///< largest |coordinate| of an edge or of a point relative to its first end
};

/// The middle is that of the two rests, point minus foot, that are farthest apart.
[[nodiscard]] BaseSegment base_segment(const HullPoints& points, const std::array<Vector3, 2>& ends);

}  // namespace snug
