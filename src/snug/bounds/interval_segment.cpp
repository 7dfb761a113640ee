#include <snug/bounds/interval_segment.h>

#include <algorithm>
#include <cmath>

#include <snug/bounds/base_triangle.h>
#include <snug/geometry/rounding.h>

namespace snug {

IntervalSegment interval_segment(const HullPoints& points, const std::array<Vector3, 2>& ends) {
  const BaseSegment base = base_segment(points, ends);
  const SegmentFoot foot(base.relative[0], base.relative[1]);
  Vector3 lower{INFINITY, INFINITY, INFINITY}, upper{-INFINITY, -INFINITY, -INFINITY};
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Vector3 rest = foot.rest(points.at(i));
    for (std::size_t a = 0; a < 3; ++a) {
      lower[a] = std::min(lower[a], rest[a]);
      upper[a] = std::max(upper[a], rest[a]);
    }
  }
  const double error = enlarged(points.error + base.placing_error + foot_error(base.reach));
  IntervalSegment result;
  for (std::size_t k = 0; k < 2; ++k) {
    for (std::size_t a = 0; a < 3; ++a) {
      result.end[k].lower[a] = rounded_down(base.placed[k][a] + rounded_down(lower[a] - error));
      result.end[k].upper[a] = rounded_up(base.placed[k][a] + rounded_up(upper[a] + error));
    }
  }
  return result;
}

double thickness(const IntervalSegment& segment) {
  return std::max(segment.end[0].longest_side(), segment.end[1].longest_side());
}

}  // namespace snug
