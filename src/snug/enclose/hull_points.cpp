#include <snug/enclose/hull_points.h>

#include <algorithm>

#include <snug/base/contract.h>
#include <snug/base/rounding.h>
#include <snug/enclose/fit_kernels.h>

namespace snug {
void hull_points(const BoundRows& rows, const Patch& patch, HullPoints& out) {
  SNUG_EXPECT(rows.control_count() == patch.points.size());
  const std::size_t count = rows.count();
  out.origin = patch.origin;
  out.x.resize(count);
  out.y.resize(count);
  out.z.resize(count);
  kernels::apply_rows(rows.column(0), count, patch.points, out.x.data(), out.y.data(), out.z.data());
  out.error = rows.result_error(patch.largest, patch.error);
  out.largest = enlarged((rows.abs_sum() + rows.entry_error()) * patch.largest);
}

void control_points(const Patch& patch, HullPoints& out) {
  out.origin = patch.origin;
  out.x.clear();
  out.y.clear();
  out.z.clear();
  for (const Vector3& p : patch.points) {
    out.x.push_back(p.x);
    out.y.push_back(p.y);
    out.z.push_back(p.z);
  }
  out.largest = patch.largest;
  out.error = patch.error;
}

Box3 outer_box(const HullPoints& points) {
  Box3 box;
  const std::vector<double>* const axes[3] = {&points.x, &points.y, &points.z};
  for (std::size_t a = 0; a < 3; ++a) {
    const auto [low, high] = std::minmax_element(axes[a]->begin(), axes[a]->end());
    const double o = points.origin[a];
    box.lower[a] = rounded_down(o + rounded_down(*low - points.error));
    box.upper[a] = rounded_up(o + rounded_up(*high + points.error));
  }
  return box;
}

Slab outer_slab(const HullPoints& points, const Vector3& normal) {
  double lower = INFINITY, upper = -INFINITY;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const double height = dot(normal, points.at(i));
    lower = std::min(lower, height);
    upper = std::max(upper, height);
  }
  const double sum = std::fabs(normal.x) + std::fabs(normal.y) + std::fabs(normal.z);
  const double error = enlarged(sum * (points.error + gamma_bound(5) * points.largest)) + 8 * underflow_error;
  return {normal, rounded_down(lower - error), rounded_up(upper + error)};
}

}  // namespace snug
