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
  /// Around one or more boxes, relative to `centre`.
  Dop26(std::span<const Obb> boxes, const Point3& centre);

  /// Upper bound of dot(direction, x - centre) over the set, but for roundings.
  ///
  /// Guarantee: the exact maximum is at most the result plus 16 u |direction|_1 radius(), for doubles between
  ///            2^-400 and 2^400 in size, or 0. Infinite or NaN where a box is not finite.
  /// Source:    derivations/boxes.md.
  [[nodiscard]] double reach(const Vector3& direction) const {
    // Coordinates by size, without branches on them; places of directions count 1, 3 and 9 a coordinate.
    const double x = std::fabs(direction.x), y = std::fabs(direction.y), z = std::fabs(direction.z);
    const int xy = x < y ? 1 : 0, xz = x < z ? 1 : 0, yz = y < z ? 1 : 0;
    const std::array<int, 3> rank{xy + xz, 1 - xy + yz, 2 - xz - yz};
    const std::array<double, 3> size{x, y, z};
    std::array<double, 3> sizes;
    std::array<int, 3> steps;
    for (std::size_t k = 0, step = 1; k < 3; ++k, step *= 3) {
      const auto r = static_cast<std::size_t>(rank[k]);
      sizes[r] = size[k];
      steps[r] = std::signbit(direction[k]) ? -static_cast<int>(step) : static_cast<int>(step);
    }
    const int axis = middle + steps[0], edge = axis + steps[1], corner = edge + steps[2];
    return (sizes[0] - sizes[1]) * reach_[static_cast<std::size_t>(axis)] +
           (sizes[1] - sizes[2]) * reach_[static_cast<std::size_t>(edge)] +
           sizes[2] * reach_[static_cast<std::size_t>(corner)];
  }
  /// Upper bound of |x - centre| a coordinate.
  [[nodiscard]] double radius() const { return radius_; }

 private:
  static constexpr int middle = 13;
  std::array<double, 27> reach_{};  // along (i - 1, j - 1, k - 1) at i + 3 j + 9 k
  double radius_ = 0;
};

}  // namespace snug
