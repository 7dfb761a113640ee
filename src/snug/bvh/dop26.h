#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <span>

#include <snug/bvh/obb.h>

namespace snug {

/// A k-DOP around a set: half spaces across the 26 directions whose coordinates are -1, 0 and 1. Other than a
/// box it says at once how far the set reaches along any direction.
class Dop26 {
 public:
  /// Holds nothing.
  Dop26() = default;
  /// Around one or more boxes, seen from `centre`.
  Dop26(std::span<const Obb> boxes, const Point3& centre);
  /// The set lies in the convex hull of these points, too: planes beyond it move to it.
  /// Requires:  at least one point, all finite; each may be off by underflow_error a coordinate.
  void narrow(std::span<const Point3> hull);

  [[nodiscard]] const Point3& centre() const { return centre_; }
  /// Upper bound of dot(direction, x - centre()) over the set, but for roundings.
  ///
  /// Guarantee: the exact maximum is at most the result plus 16 u |direction|_1 radius(), for doubles between
  ///            2^-400 and 2^400 in size, or 0. Infinite or NaN where a box is not finite.
  /// Source:    derivations/boxes.md.
  [[nodiscard]] double reach(const Vector3& direction) const {
    // Coordinates by size, without branches that depend on them; places of directions count 1, 3 and 9 each.
    double s0 = std::fabs(direction.x), s1 = std::fabs(direction.y), s2 = std::fabs(direction.z);
    int step0 = std::signbit(direction.x) ? -1 : 1, step1 = std::signbit(direction.y) ? -3 : 3,
        step2 = std::signbit(direction.z) ? -9 : 9;
    larger_first(s0, step0, s1, step1);
    larger_first(s1, step1, s2, step2);
    larger_first(s0, step0, s1, step1);
    const int axis = middle + step0, edge = axis + step1, corner = edge + step2;
    return (s0 - s1) * reach_[static_cast<std::size_t>(axis)] +
           (s1 - s2) * reach_[static_cast<std::size_t>(edge)] + s2 * reach_[static_cast<std::size_t>(corner)];
  }
  /// Upper bound of |x - centre()| a coordinate.
  [[nodiscard]] double radius() const { return radius_; }

 private:
  static constexpr int middle = 13;
  static void larger_first(double& x, int& step_x, double& y, int& step_y) {
    const bool less = x < y;
    const double larger = less ? y : x, smaller = less ? x : y;
    const int first = less ? step_y : step_x, second = less ? step_x : step_y;
    x = larger, y = smaller, step_x = first, step_y = second;
  }
  void find_radius();

  std::array<double, 27> reach_{};  // along (i - 1, j - 1, k - 1) at i + 3 j + 9 k
  double radius_ = 0;
  Point3 centre_;
};

}  // namespace snug
