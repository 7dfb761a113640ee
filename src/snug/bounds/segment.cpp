#include <snug/bounds/segment.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include <snug/geometry/rounding.h>

namespace snug {
namespace {

Vector3 middle_of_farthest(const std::vector<Vector3>& rests) {
  Vector3 middle;
  double farthest_sq = 0;
  for (std::size_t i = 0; i < rests.size(); ++i) {
    for (std::size_t k = 0; k < i; ++k) {
      const double apart_sq = length_sq(rests[i] - rests[k]);
      if (!(apart_sq > farthest_sq)) continue;
      farthest_sq = apart_sq;
      middle = 0.5 * rests[i] + 0.5 * rests[k];
    }
  }
  return middle;
}

}  // namespace

SegmentFoot::SegmentFoot(const Vector3& a, const Vector3& b) : a_(a), edge_(b - a) {
  const double inverse = 1 / length_sq(edge_);
  inverse_ = std::isfinite(inverse) ? inverse : 0;
}

Vector3 SegmentFoot::rest(const Vector3& p) const {
  const Vector3 d = p - a_;
  const double t = dot(d, edge_) * inverse_;
  return d - (t > 0 ? std::min(t, 1.0) : 0.0) * edge_;
}

BaseSegment base_segment(const HullPoints& points, const std::array<Vector3, 2>& ends) {
  thread_local std::vector<Vector3> rests;
  rests.clear();
  const SegmentFoot foot(ends[0], ends[1]);
  for (std::size_t i = 0; i < points.size(); ++i) rests.push_back(foot.rest(points.at(i)));
  const Vector3 shift = middle_of_farthest(rests);
  BaseSegment base;
  double largest = 0;
  for (std::size_t k = 0; k < 2; ++k) {
    base.relative[k] = ends[k] + shift;
    base.placed[k] = points.origin + base.relative[k];
    largest = std::max(largest, max_abs(base.placed[k] - Point3{}));
  }
  base.placing_error = unit_roundoff * largest * (1 + 0x1p-50);
  base.reach = max_abs(base.relative[1] - base.relative[0]);
  for (std::size_t i = 0; i < points.size(); ++i) {
    base.reach = std::max(base.reach, max_abs(points.at(i) - base.relative[0]));
  }
  return base;
}

}  // namespace snug
