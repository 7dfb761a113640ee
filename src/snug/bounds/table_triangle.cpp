#include <snug/bounds/table_triangle.h>

#include <algorithm>
#include <cmath>

#include <snug/geometry/rounding.h>
#include <support/contract.h>

namespace snug {
namespace {

// The linear function through three points: control points of the corners, or about their limits.
struct Linear {
  Vector3 at_zero, along_one, along_two;
  double largest;  // coordinate of the three
  Linear(const Vector3& zero, const Vector3& one, const Vector3& two)
      : at_zero(zero),
        along_one(one - zero),
        along_two(two - zero),
        largest(std::max({max_abs(zero), max_abs(one), max_abs(two)})) {}
  [[nodiscard]] Vector3 operator()(const LayoutPoint& u) const {
    return at_zero + u[0] * along_one + u[1] * along_two;
  }
};

Linear linear_of(const BoundTable& table, const Patch& patch) {
  if (table.first_bounded() > 0) return {patch.points[0], patch.points[1], patch.points[2]};
  std::array<Vector3, 3> corner;
  const Stencils& limits = patch.kind->corner_limits();
  for (std::size_t k = 0; k < 3; ++k) corner[k] = limits.apply<Vector3>(k, patch.points);
  return {corner[0], corner[1], corner[2]};
}

// Twice this, times `largest`, bounds |l(u)| and |c - l(u)|.
double reach(const LayoutPoint& u) { return 1 + std::fabs(u[0]) + std::fabs(u[1]); }

}  // namespace

TableTriangle table_triangle(const BoundTable& table, const Patch& patch) {
  const std::size_t count = table.control_count();
  SNUG_EXPECT(patch.points.size() == count && patch.kind->control_count() == count);
  const std::size_t begin = table.first_bounded();
  const Linear linear = linear_of(table, patch);
  const double largest = std::max(patch.largest, linear.largest);
  std::array<Vector3, 3> lower, upper;
  std::array<double, 3> gain;  // sum of reach times the larger of |lower| and |upper|
  for (std::size_t k = 0; k < 3; ++k) {
    lower[k] = upper[k] = linear(table.triangle[k]);
    gain[k] = reach(table.triangle[k]);
  }
  for (std::size_t i = begin; i < count; ++i) {
    const Vector3 d = patch.points[i] - linear(table.layout[i]);
    const double of_point = reach(table.layout[i]);
    const BoundTable::CornerValues &low = table.lower[i - begin], &high = table.upper[i - begin];
    for (std::size_t k = 0; k < 3; ++k) {
      for (std::size_t a = 0; a < 3; ++a) {
        const double by_low = d[a] * low[k], by_high = d[a] * high[k];
        lower[k][a] += std::min(by_low, by_high);
        upper[k][a] += std::max(by_low, by_high);
      }
      gain[k] += of_point * std::max(std::fabs(low[k]), std::fabs(high[k]));
    }
  }
  const double most = *std::max_element(gain.begin(), gain.end());
  const double error =
      enlarged(2 * most *
               (patch.error + (8 * unit_roundoff + gamma_bound(count + 4)) * largest + 8 * underflow_error)) +
      8 * static_cast<double>(count) * underflow_error;

  TableTriangle result;
  double placing = 0;
  for (std::size_t k = 0; k < 3; ++k) {
    Box3& box = result.interval.corner[k];
    const std::size_t own = patch.to_kind(k);
    for (std::size_t a = 0; a < 3; ++a) {
      const double o = patch.origin[a];
      box.lower[a] = rounded_down(o + rounded_down(lower[own][a] - error));
      box.upper[a] = rounded_up(o + rounded_up(upper[own][a] + error));
      placing = std::max({placing, std::fabs(box.lower[a]), std::fabs(box.upper[a])});
    }
  }
  result.rounding = enlarged(error + 8 * unit_roundoff * placing);
  return result;
}

OffsetTriangle offset_triangle(const TableTriangle& triangle) {
  OffsetTriangle result;
  double farthest_sq = 0;
  bool finite = true;
  for (std::size_t k = 0; k < 3; ++k) {
    const Box3& box = triangle.interval.corner[k];
    Vector3 half;
    for (std::size_t a = 0; a < 3; ++a) {
      const double centre = box.lower[a] + 0.5 * (box.upper[a] - box.lower[a]);
      result.base[k][a] = centre;
      half[a] = rounded_up(std::max(centre - box.lower[a], box.upper[a] - centre));
      finite = finite && std::isfinite(half[a]);
    }
    farthest_sq = std::max(farthest_sq, length_sq(half));
  }
  const double radius = std::sqrt(farthest_sq + 8 * underflow_error);
  result.radius = finite && std::isfinite(radius) ? enlarged(radius) : INFINITY;
  result.rounding = spatial_error(triangle.rounding);
  return result;
}

}  // namespace snug
