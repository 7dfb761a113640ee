#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <span>

#include <snug/bvh/obb.h>

/// Extents of many sets along axes, a set a lane: the same bits on every instruction set.
namespace snug::kernels {

/// A set within `reach` of a triangle: what boxes around many of them need.
struct SetTriangle {
  std::array<std::array<float, 3>, 3> corner;
  float reach;  ///< that of roundings along axes included
};
[[nodiscard]] SetTriangle triangle_of(const FittedSet& set);

/// Extents of a set along three axes, nearly: for choices.
struct alignas(16) SetSides {
  /// How far against each axis, and along it, with a place between that is not used: in vectors of four.
  std::array<float, 8> reach{-INFINITY, -INFINITY, -INFINITY, 0, -INFINITY, -INFINITY, -INFINITY, 0};
  [[nodiscard]] float lower(std::size_t k) const { return -reach[k]; }
  [[nodiscard]] float upper(std::size_t k) const { return reach[4 + k]; }
  void add(SetSides other) {
    for (std::size_t k = 0; k < reach.size(); ++k) reach[k] = std::max(reach[k], other.reach[k]);
  }
  /// Of the box, up to a factor.
  [[nodiscard]] float surface() const {
    const float x = reach[4] + reach[0], y = reach[5] + reach[1], z = reach[6] + reach[2];
    return x * y + y * z + z * x;
  }
};

/// Bounds of dot(axis, x) over all of these sets, and to `sides` those of each, in their order.
/// Guarantee: rounding included. Source: that of error_along().
/// Requires:  axes of length 1 up to a few roundings; at least one set.
/// Cost:      about 0.05 microseconds a set.
[[nodiscard]] std::array<Extent, 3> extents_along(const Axes& axes, std::span<const FittedSet> sets,
                                                  std::span<const std::uint32_t> which, SetSides* sides);
/// The same, looser, of sets of which there are many.
/// Source:    derivations/boxes.md, "Boxes above are fitted to what lies below".
/// Cost:      about 0.01 microseconds a set.
[[nodiscard]] std::array<Extent, 3> extents_along(const Axes& axes, std::span<const SetTriangle> sets,
                                                  SetSides* sides);

}  // namespace snug::kernels
