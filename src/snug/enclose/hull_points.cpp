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
  out.tips = rows.tips();
}

void refine_tip(BoundLibrary& library, std::size_t i, HullPoints& points) {
  thread_local Patch tip;
  thread_local HullPoints finer;
  const auto begin = static_cast<std::ptrdiff_t>(points.tips[i].begin);
  tip.kind = points.tips[i].kind;
  tip.origin = points.origin;
  const auto count = static_cast<std::ptrdiff_t>(tip.kind->control_count());
  tip.points.resize(tip.kind->control_count());
  tip.largest = 0;
  for (std::size_t k = 0; k < tip.points.size(); ++k) {
    tip.points[k] = points.at(points.tips[i].begin + k);
    tip.largest = std::max(tip.largest, max_abs(tip.points[k]));
  }
  tip.error = points.error;
  hull_points(library.rows(*tip.kind), tip, finer);

  // What is no tip goes before the tips, the new tip where the old one was: as large, being of the same kind.
  const auto kept = static_cast<std::ptrdiff_t>(finer.tips_begin());
  const auto rest = static_cast<std::ptrdiff_t>(points.tips_begin());
  const auto replace = [&](std::vector<double>& old, const std::vector<double>& fresh) {
    std::copy(fresh.begin() + kept, fresh.end(), old.begin() + begin);
    old.insert(old.begin() + rest, fresh.begin(), fresh.begin() + kept);
  };
  SNUG_EXPECT(static_cast<std::ptrdiff_t>(finer.size()) - kept == count && finer.tips[0].kind == tip.kind);
  replace(points.x, finer.x);
  replace(points.y, finer.y);
  replace(points.z, finer.z);
  for (BoundRows::Tip& other : points.tips) other.begin += static_cast<std::size_t>(kept);
  points.error = std::max(points.error, finer.error);
  points.largest = std::max(points.largest, finer.largest);
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
  out.tips = {};
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
