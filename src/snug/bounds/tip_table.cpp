#include <snug/bounds/tip_table.h>

#include <algorithm>
#include <cmath>

#include <snug/geometry/rounding.h>
#include <support/contract.h>

namespace snug {
namespace {

double reach(const LayoutPoint& u) { return 1 + std::fabs(u[0]) + std::fabs(u[1]); }

}  // namespace

// The half width covers the rounding of both. Errors: derivations/rounding.md, "Interval triangles from
// tables" and "Batches".
TipTable::TipTable(const BoundTable& table)
    : triangle_(table.triangle), first_bounded_(table.first_bounded()) {
  const std::size_t count = table.control_count();
  std::array<double, 3> gain;
  for (std::size_t k = 0; k < 3; ++k) gain[k] = reach(triangle_[k]);
  for (std::size_t i = first_bounded_; i < count; ++i) {
    Column column{table.layout[i][0], table.layout[i][1], {}, {}};
    for (std::size_t k = 0; k < 3; ++k) {
      const double low = table.lower[i - first_bounded_][k], high = table.upper[i - first_bounded_][k];
      const double most = std::max(std::fabs(low), std::fabs(high));
      column.middle[k] = 0.5 * (low + high);
      column.half[k] = enlarged(0.5 * (high - low) + 2 * unit_roundoff * most);
      gain[k] += reach(table.layout[i]) * (most + column.half[k]);
    }
    columns_.push_back(column);
  }
  const double most = 2 * *std::max_element(gain.begin(), gain.end());
  error_of_points_ = enlarged(most);
  error_of_largest_ = enlarged(most * (12 * unit_roundoff + gamma_bound(count + 4)));
  error_at_least_ = enlarged((16 * most + 8 * static_cast<double>(count)) * underflow_error);
}

TipBoxes TipTable::boxes(const Patch& patch) const {
  SNUG_EXPECT(patch.points.size() == first_bounded_ + columns_.size());
  // The linear function through the first three control points, or about through the limits of the corners.
  std::array<Vector3, 3> through;
  for (std::size_t k = 0; k < 3; ++k) {
    through[k] =
        first_bounded_ > 0 ? patch.points[k] : patch.kind->corner_limits().apply<Vector3>(k, patch.points);
  }
  const Vector3 zero = through[0], along_u = through[1] - zero, along_v = through[2] - zero;
  std::array<std::array<double, 4>, 3> middle{}, half{};  // [axis][corner]
  const Vector3* point = patch.points.data() + first_bounded_;
  for (const Column& column : columns_) {
    const Vector3 off = *point++ - (zero + column.u * along_u + column.v * along_v);
    const std::array<double, 3> d{off.x, off.y, off.z};
    for (std::size_t a = 0; a < 3; ++a) {
      const double size = std::fabs(d[a]);
      for (std::size_t k = 0; k < 4; ++k) middle[a][k] += d[a] * column.middle[k];
      for (std::size_t k = 0; k < 4; ++k) half[a][k] += size * column.half[k];
    }
  }
  const double largest =
      std::max({patch.largest, max_abs(through[0]), max_abs(through[1]), max_abs(through[2])});
  const double error =
      enlarged(error_of_points_ * patch.error + error_of_largest_ * largest) + error_at_least_;
  TipBoxes boxes;
  for (std::size_t k = 0; k < 3; ++k) {
    const Vector3 at = zero + triangle_[k][0] * along_u + triangle_[k][1] * along_v;
    for (std::size_t a = 0; a < 3; ++a) {
      const double wide = half[a][k] + error;
      boxes.lower[k][a] = at[a] + middle[a][k] - wide;
      boxes.upper[k][a] = at[a] + middle[a][k] + wide;
    }
  }
  return boxes;
}

}  // namespace snug
