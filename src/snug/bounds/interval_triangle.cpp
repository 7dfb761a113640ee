#include <snug/bounds/interval_triangle.h>

#include <algorithm>

#include <snug/bounds/base_triangle.h>
#include <snug/geometry/rounding.h>

namespace snug {

IntervalTriangle interval_triangle(const HullPoints& points, const std::array<Vector3, 3>& corners) {
  const BaseTriangle base = base_triangle(points, corners);
  const TriangleFoot foot(base.relative[0], base.relative[1], base.relative[2]);
  Vector3 lower{INFINITY, INFINITY, INFINITY}, upper{-INFINITY, -INFINITY, -INFINITY};
  double reach = extent(base.relative[0], base.relative[1], base.relative[2]);
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Vector3 p = points.at(i);
    const Vector3 d = p - base.relative[0];
    const Barycentric at = foot(p);
    const Vector3 rest = d - at.b * foot.edge_b() - at.c * foot.edge_c();
    for (std::size_t a = 0; a < 3; ++a) {
      if (!(rest[a] >= lower[a])) lower[a] = rest[a];
      if (!(rest[a] <= upper[a])) upper[a] = rest[a];
    }
    reach = std::max(reach, max_abs(d));
  }
  const double error = enlarged(points.error + base.placing_error + foot_error(reach));
  IntervalTriangle result;
  for (std::size_t k = 0; k < 3; ++k) {
    for (std::size_t a = 0; a < 3; ++a) {
      result.corner[k].lower[a] = rounded_down(base.placed[k][a] + rounded_down(lower[a] - error));
      result.corner[k].upper[a] = rounded_up(base.placed[k][a] + rounded_up(upper[a] + error));
    }
  }
  return result;
}

double thickness(const IntervalTriangle& triangle) {
  double widest = 0;
  for (const Box3& box : triangle.corner) widest = std::max(widest, box.longest_side());
  return widest;
}

}  // namespace snug
