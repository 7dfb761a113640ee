#include <snug/enclose/offset_triangle.h>

#include <algorithm>

#include <snug/base/rounding.h>
#include <snug/enclose/base_triangle.h>

namespace snug {

OffsetTriangle offset_triangle(const HullPoints& points, const std::array<Vector3, 3>& corners) {
  const BaseTriangle base = base_triangle(points, corners);
  const TriangleFoot foot(base.relative[0], base.relative[1], base.relative[2]);
  bool finite = true;
  double farthest_sq = 0, reach = extent(base.relative[0], base.relative[1], base.relative[2]);
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Vector3 p = points.at(i);
    const Vector3 d = p - base.relative[0];
    const Barycentric at = foot(p);
    const double dist_sq = length_sq(d - at.b * foot.edge_b() - at.c * foot.edge_c());
    finite = finite && dist_sq < INFINITY;
    farthest_sq = std::max(farthest_sq, dist_sq);
    reach = std::max(reach, max_abs(d));
  }
  const double rounding = spatial_error(fit_error(points, base, reach));
  const double radius = std::sqrt(farthest_sq + 8 * underflow_error) + rounding;
  return {base.placed, finite && std::isfinite(radius) ? enlarged(radius) : INFINITY, rounding};
}

}  // namespace snug
