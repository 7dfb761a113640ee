#pragma once

#include <array>
#include <cstdint>
#include <span>

#include <snug/bvh/obb.h>

/// Extents of many sets along axes, a set a lane: the same bits on every instruction set.
namespace snug::kernels {

/// A FittedSet as vectors read it.
struct SetNumbers {
  std::array<Vector3, 5> box;  ///< centre, axes, halves
  double box_error;
  std::array<Vector3, 6> net;  ///< a corner, the other points from it
  Vector3 normal;
  double error, normal_error;
  double tilt;   ///< normal_error over what of the error is left across the normal
  double slack;  ///< added to the error
};
[[nodiscard]] SetNumbers numbers_of(const FittedSet& set);

/// A set within `reach` of a triangle: what boxes around many of them need.
struct SetTriangle {
  std::array<std::array<float, 3>, 3> corner;
  float reach;  ///< that of roundings along axes included
};
[[nodiscard]] SetTriangle triangle_of(const FittedSet& set);

/// What a set takes of three axes, nearly: for choices.
struct SetSides {
  std::array<float, 3> lower{INFINITY, INFINITY, INFINITY}, upper{-INFINITY, -INFINITY, -INFINITY};
  void add(const SetSides& other) {
    for (std::size_t k = 0; k < 3; ++k) {
      lower[k] = std::min(lower[k], other.lower[k]);
      upper[k] = std::max(upper[k], other.upper[k]);
    }
  }
  /// Of the box, up to a factor.
  [[nodiscard]] float surface() const {
    const float x = upper[0] - lower[0], y = upper[1] - lower[1], z = upper[2] - lower[2];
    return x * y + y * z + z * x;
  }
};

/// Bounds of dot(axis, x) over all sets of these numbers, and to `sides` those of each, in their order.
/// Guarantee: rounding included. Source: that of error_along().
/// Requires:  axes of length 1 up to a few roundings; at least one set.
/// Cost:      about 0.05 microseconds a set.
[[nodiscard]] std::array<Extent, 3> extents_along(const Axes& axes, std::span<const SetNumbers> sets,
                                                  std::span<const std::uint32_t> which, SetSides* sides);
/// The same, looser, of sets of which there are many.
/// Source:    derivations/boxes.md, "Boxes above are fitted to what lies below".
/// Cost:      about 0.01 microseconds a set.
[[nodiscard]] std::array<Extent, 3> extents_along(const Axes& axes, std::span<const SetTriangle> sets,
                                                  SetSides* sides);

}  // namespace snug::kernels
