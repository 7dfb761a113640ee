#include <snug/bounds/offset_segment.h>

#include <algorithm>
#include <cmath>

#include <snug/bounds/base_triangle.h>
#include <snug/geometry/rounding.h>

namespace snug {

OffsetSegment offset_segment(const HullPoints& points, const std::array<Vector3, 2>& ends) {
  const BaseSegment base = base_segment(points, ends);
  const SegmentFoot foot(base.relative[0], base.relative[1]);
  bool finite = true;
  double farthest_sq = 0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const double dist_sq = length_sq(foot.rest(points.at(i)));
    finite = finite && dist_sq < INFINITY;
    farthest_sq = std::max(farthest_sq, dist_sq);
  }
  const double rounding =
      enlarged(spatial_error(enlarged(points.error + base.placing_error + foot_error(base.reach))));
  // Squares of parts much smaller than the whole may underflow.
  const double radius = enlarged(std::sqrt(farthest_sq + 8 * underflow_error) + rounding);
  return {base.placed, finite && std::isfinite(radius) ? radius : INFINITY, rounding};
}

}  // namespace snug
