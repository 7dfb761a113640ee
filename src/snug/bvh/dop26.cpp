#include <snug/bvh/dop26.h>

#include <algorithm>
#include <cmath>

#include <snug/base/contract.h>
#include <snug/geometry/rounding.h>

namespace snug {
namespace {

// Half of the places: the others are their opposites, at 26 minus theirs.
constexpr std::size_t half = 13;

Vector3 direction_at(std::size_t place) {
  return {static_cast<double>(place % 3) - 1, static_cast<double>(place / 3 % 3) - 1,
          static_cast<double>(place / 9) - 1};
}

}  // namespace

Dop26::Dop26(std::span<const Obb> boxes, const Point3& centre) {
  SNUG_EXPECT(!boxes.empty());
  reach_.fill(-INFINITY);
  reach_[half] = 0;
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
    for (std::size_t place = 0; place < half; ++place) {
      const Vector3 d = direction_at(place);
      double reach = error;
      for (const Vector3& edge : edges) reach += std::fabs(dot(d, edge));
      reach_[place] = std::max(reach_[place], reach + dot(d, from));
      reach_[26 - place] = std::max(reach_[26 - place], reach - dot(d, from));
    }
  }
  for (const std::size_t place : {4u, 10u, 12u}) {
    radius_ = std::max({radius_, reach_[place], reach_[26 - place]});
  }
}

}  // namespace snug
