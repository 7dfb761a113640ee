#include <snug/enclose/hull_points.h>

#include <algorithm>

#include <snug/base/contract.h>
#include <snug/base/rounding.h>

namespace snug {
namespace {

double largest_of(const std::vector<double>& values) {
  double largest = 0;
  for (const double v : values) largest = std::max(largest, std::fabs(v));
  return largest;
}

void measure(HullPoints& points) {
  points.largest = std::max({largest_of(points.x), largest_of(points.y), largest_of(points.z)});
}

}  // namespace

void hull_points(const BoundRows& rows, const Patch& patch, HullPoints& out) {
  SNUG_EXPECT(rows.control_count() == patch.points.size());
  const std::size_t count = rows.count();
  out.origin = patch.origin;
  out.x.assign(count, 0.0);
  out.y.assign(count, 0.0);
  out.z.assign(count, 0.0);
  for (std::size_t c = 0; c < patch.points.size(); ++c) {
    const double* const weight = rows.column(c);
    const Vector3 p = patch.points[c];
    double* const x = out.x.data();
    double* const y = out.y.data();
    double* const z = out.z.data();
    for (std::size_t r = 0; r < count; ++r) {
      x[r] += weight[r] * p.x;
      y[r] += weight[r] * p.y;
      z[r] += weight[r] * p.z;
    }
  }
  measure(out);
  out.error = rows.result_error(patch.largest, patch.error);
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
  measure(out);
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
