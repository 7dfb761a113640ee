#include <snug/geometry/triangle_distance.h>

#include <algorithm>
#include <cmath>

#include <snug/geometry/rounding.h>
#include <snug/geometry/triangle_kernels.h>

namespace snug {
namespace {

using kernels::Corners;

Vector3 at(const Corners& c, Barycentric p) { return c[0] + p.b * (c[1] - c[0]) + p.c * (c[2] - c[0]); }

// Largest coordinate of all corners. No branches on signs, which are as good as random.
double reach_of(const Corners& a, const Corners& b) {
  double reach = 0;
  for (const Corners* corners : {&a, &b}) {
    for (const Vector3& p : *corners) {
      reach = std::max(reach, std::max(std::abs(p.x), std::max(std::abs(p.y), std::abs(p.z))));
    }
  }
  return reach;
}

// Lower bound of the distance along the direction w.
double supporting_gap(const Corners& a, const Corners& b, Vector3 w, double reach) {
  // Where squares underflow, w gets shorter.
  const double size = std::sqrt(length_sq(w) + 8 * underflow_error);
  if (!(size > 0) || !std::isfinite(1 / size)) return 0;
  w = (1 / size) * w;
  double highest_a = -INFINITY, lowest_b = INFINITY;
  for (std::size_t k = 0; k < 3; ++k) {
    highest_a = std::max(highest_a, dot(w, a[k]));
    lowest_b = std::min(lowest_b, dot(w, b[k]));
  }
  // |w| <= 1 + 6 u; two dot products of sum |w_i| |x_i| <= 2 reach and a difference.
  const double gap =
      (lowest_b - highest_a) * (1 - 16 * unit_roundoff) - 24 * unit_roundoff * reach - 16 * underflow_error;
  return std::isfinite(gap) ? std::max(0.0, gap) : 0.0;
}

}  // namespace

TriangleParameter clamped(Barycentric weights) {
  const double b = std::clamp(weights.b, 0.0, 1.0);
  const double c = std::clamp(weights.c, 0.0, 1.0 - b);
  return {b, b + c > 1 ? 0 : c};
}

NearestTriangles nearest(const Triangle& first, const Triangle& second) {
  // Relative to one corner: triangles far from the coordinates' origin lose nothing. Each difference errs by half a
  // unit in its last place; the gap is lowered for it below.
  const Point3 origin = first[0];
  const Corners a{Vector3{}, first[1] - origin, first[2] - origin};
  const Corners b{second[0] - origin, second[1] - origin, second[2] - origin};
  PairOfPoints found;
  if (kernels::nearest_points(a, b, found)) return {found.on_a, found.on_b, 0};
  const double reach = reach_of(a, b);
  const double gap = supporting_gap(a, b, at(b, found.on_b) - at(a, found.on_a), reach);
  return {found.on_a, found.on_b, std::max(0.0, gap - 4 * unit_roundoff * reach)};
}

std::optional<PairOfPoints> middle_of_contact(const Triangle& first, const Triangle& second) {
  const Point3 origin = first[0];
  const Corners a{Vector3{}, first[1] - origin, first[2] - origin};
  const Corners b{second[0] - origin, second[1] - origin, second[2] - origin};
  const kernels::Crossings found = kernels::crossings(a, b);
  if (found.count == 0) return std::nullopt;
  PairOfPoints sum;
  double weights = 0;
  for (std::size_t i = 0; i < found.count; ++i) {
    const auto& [on_a, on_b] = found.points[i];
    // Not quite the middle: that lies on lines where pieces are split more often than not.
    const double weight = i == 0 ? 1.0 : 1.1234567;
    sum.on_a = {sum.on_a.b + weight * on_a.b, sum.on_a.c + weight * on_a.c};
    sum.on_b = {sum.on_b.b + weight * on_b.b, sum.on_b.c + weight * on_b.c};
    weights += weight;
  }
  const double share = 1.0 / weights;
  return PairOfPoints{{share * sum.on_a.b, share * sum.on_a.c}, {share * sum.on_b.b, share * sum.on_b.c}};
}

}  // namespace snug
