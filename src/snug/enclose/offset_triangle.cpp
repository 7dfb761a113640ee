#include <snug/enclose/offset_triangle.h>

#include <algorithm>

#include <snug/base/rounding.h>
#include <snug/enclose/base_triangle.h>

namespace snug {

namespace {

// For triangles without a plane of their own: the nearest points of the edges, each found on its own.
kernels::Reach farthest_by_feet(const HullPoints& points, const std::array<Vector3, 3>& corner) {
  const TriangleFoot foot(corner[0], corner[1], corner[2]);
  bool finite = true;
  double farthest_sq = 0, reach = extent(corner[0], corner[1], corner[2]);
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Vector3 p = points.at(i);
    const Vector3 d = p - corner[0];
    const Barycentric at = foot(p);
    const double dist_sq = length_sq(d - at.b * foot.edge_b() - at.c * foot.edge_c());
    finite = finite && dist_sq < INFINITY;
    farthest_sq = std::max(farthest_sq, dist_sq);
    reach = std::max(reach, max_abs(d));
  }
  const double rounding = spatial_error(foot_error(reach));
  return {finite ? std::sqrt(farthest_sq + 8 * underflow_error) + rounding : INFINITY, rounding};
}

}  // namespace

OffsetTriangle offset_triangle(const HullPoints& points, const std::array<Vector3, 3>& corners) {
  const BaseTriangle base = base_triangle(points, corners);
  const auto in_plane =
      kernels::farthest(points.coordinates(), base.relative[0], base.relative[1], base.relative[2]);
  const kernels::Reach reach = in_plane ? *in_plane : farthest_by_feet(points, base.relative);
  const double given = spatial_error(enlarged(points.error + base.placing_error));
  const double radius = reach.distance + given;
  return {base.placed, std::isfinite(radius) ? enlarged(radius) : INFINITY, enlarged(reach.rounding + given)};
}

}  // namespace snug
