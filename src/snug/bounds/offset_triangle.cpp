#include <snug/bounds/offset_triangle.h>

#include <algorithm>

#include <snug/bounds/base_triangle.h>
#include <snug/geometry/rounding.h>

namespace snug {

namespace {

// For triangles without a plane of their own, of the points `begin` to `end` - 1: the nearest points of the
// edges, each found on its own.
kernels::Reach farthest_by_feet(const HullPoints& points, std::size_t begin, std::size_t end,
                                const std::array<Vector3, 3>& corner) {
  const TriangleFoot foot(corner[0], corner[1], corner[2]);
  bool finite = true;
  double farthest_sq = 0, reach = extent(corner[0], corner[1], corner[2]);
  for (std::size_t i = begin; i < end; ++i) {
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

OffsetTriangle finished(const BaseTriangle& base, const HullPoints& points, const kernels::Reach& reach) {
  const double given = spatial_error(enlarged(points.error + base.placing_error));
  const double radius = reach.distance + given;
  return {base.placed, std::isfinite(radius) ? enlarged(radius) : INFINITY, enlarged(reach.rounding + given)};
}

// Refines the tips whose nets stick out of the rest of the hull, which is within `rest` of the base. Nets that stick out
// along the normal have moved the base towards them: then both sides are about as far.
bool refine_what_sticks_out(BoundsCache& library, const BaseTriangle& base, double rest, HullPoints& points) {
  const auto& corner = base.relative;
  const double most = (base.tips_stick_out ? 1 - notable_excess : 1 + notable_excess) * rest;
  std::array<bool, 3> which{};
  for (std::size_t i = 0; i < 3 && points.tips[i].kind; ++i) {
    const std::size_t begin = points.tips[i].begin, count = points.tips[i].kind->control_count();
    const auto reach =
        kernels::farthest(points.coordinates().from(begin).first(count), corner[0], corner[1], corner[2]);
    which[i] = (reach ? *reach : farthest_by_feet(points, begin, begin + count, corner)).distance > most;
  }
  if (which == std::array<bool, 3>{}) return false;
  refine_tips(library, which, points);
  return true;
}

}  // namespace

OffsetTriangle offset_triangle(const HullPoints& points, const std::array<Vector3, 3>& corners) {
  const BaseTriangle base = base_triangle(points, corners);
  const auto in_plane =
      kernels::farthest(points.coordinates(), base.relative[0], base.relative[1], base.relative[2]);
  return finished(base, points,
                  in_plane ? *in_plane : farthest_by_feet(points, 0, points.size(), base.relative));
}

OffsetTriangle offset_triangle(BoundsCache& library, HullPoints& points,
                               const std::array<Vector3, 3>& corners) {
  for (std::size_t round = 0;; ++round) {
    const BaseTriangle base = base_triangle(points, corners);
    const auto& c = base.relative;
    const std::size_t begin = points.tips_begin();
    auto reach = kernels::farthest(points.coordinates(), begin, c[0], c[1], c[2]);
    if (!reach) {
      reach = {farthest_by_feet(points, 0, begin, c), farthest_by_feet(points, begin, points.size(), c)};
    }
    const auto& [rest, tips] = *reach;
    const bool tight = !base.tips_stick_out && tips.distance <= (1 + notable_excess) * rest.distance;
    if (tight || round == max_tip_refinements ||
        !refine_what_sticks_out(library, base, rest.distance, points)) {
      return finished(base, points, rest.distance >= tips.distance ? rest : tips);
    }
  }
}

}  // namespace snug
