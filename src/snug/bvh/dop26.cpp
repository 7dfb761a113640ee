#include <snug/bvh/dop26.h>

#include <algorithm>
#include <cmath>

#include <snug/geometry/rounding.h>
#include <support/contract.h>

namespace snug {
namespace {

// Half of the places: the others are their opposites, at 26 minus theirs.
constexpr std::size_t half_count = 13;
// Those of the coordinate axes x, y and z, backwards.
constexpr std::array<std::size_t, 3> axis_planes{12, 10, 4};

Vector3 direction_at(std::size_t place) {
  return {static_cast<double>(place % 3) - 1, static_cast<double>(place / 3 % 3) - 1,
          static_cast<double>(place / 9) - 1};
}

}  // namespace

Dop26::Dop26(std::span<const Obb> boxes, const Point3& centre) : centre_(centre) {
  SNUG_EXPECT(!boxes.empty());
  reach_.fill(-INFINITY);
  reach_[half_count] = 0;
  for (const Obb& box : boxes) {
    if (!is_finite(box.centre) || !std::isfinite(box.half.x + box.half.y + box.half.z)) {
      reach_.fill(INFINITY);
      radius_ = INFINITY;
      return;
    }
    const Vector3 from = box.centre - centre;
    std::array<Vector3, 3> edges;
    for (std::size_t k = 0; k < 3; ++k) edges[k] = box.half[k] * box.axes[k];
    // As in merge(): at most 64 roundings, and what axes lack of orthonormality.
    const double error =
        256 * unit_roundoff *
        (max_abs(box.centre - Point3{}) + max_abs(centre - Point3{}) + box.half.x + box.half.y + box.half.z);
    for (std::size_t place = 0; place < half_count; ++place) {
      const Vector3 d = direction_at(place);
      double reach = error;
      for (const Vector3& edge : edges) reach += std::fabs(dot(d, edge));
      reach_[place] = std::max(reach_[place], reach + dot(d, from));
      reach_[26 - place] = std::max(reach_[26 - place], reach - dot(d, from));
    }
  }
  find_radius();
}

void Dop26::narrow(std::span<const Point3> hull) {
  SNUG_EXPECT(!hull.empty());
  std::array<Extent, half_count> extents;
  for (const Point3& point : hull) {
    const auto [x, y, z] = point - centre_;
    // In the order of places: those of direction_at().
    const std::array<double, half_count> heights{
        -x - y - z, -y - z, x - y - z, -x - z, -z, x - z, y - x - z, y - z, x + y - z, -x - y, -y, x - y, -x};
    for (std::size_t place = 0; place < half_count; ++place) extents[place].add(heights[place]);
  }
  double largest = 0;
  for (const std::size_t place : axis_planes) {
    largest = std::max({largest, extents[place].upper, -extents[place].lower});
  }
  // Differences and two sums of what is at most three times as large.
  const double error = 64 * unit_roundoff * largest + 16 * underflow_error;
  for (std::size_t place = 0; place < half_count; ++place) {
    reach_[place] = std::min(reach_[place], extents[place].upper + error);
    reach_[26 - place] = std::min(reach_[26 - place], error - extents[place].lower);
  }
  // No reach is more than those along its axes, which may be narrower now on either account: reach() counts on it.
  for (std::size_t place = 0; place < reach_.size(); ++place) {
    const Vector3 d = direction_at(place);
    double sum = error;
    for (std::size_t k = 0; k < 3; ++k) {
      if (d[k] != 0) sum += reach_[d[k] > 0 ? 26 - axis_planes[k] : axis_planes[k]];
    }
    if (place != half_count) reach_[place] = std::min(reach_[place], sum);
  }
  find_radius();
}

void Dop26::find_radius() {
  radius_ = 0;
  for (const std::size_t place : axis_planes)
    radius_ = std::max({radius_, reach_[place], reach_[26 - place]});
}

}  // namespace snug
