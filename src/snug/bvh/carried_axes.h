#pragma once

#include <array>
#include <span>

#include <snug/bvh/obb.h>

namespace snug {

/// Axes that three points carry along when they move: turned as these are, so that a box around what moves
/// with the points stays as narrow as it was.
class CarriedAxes {
 public:
  CarriedAxes() = default;
  /// The axes where the points are now. Points on one line carry nothing: the axes then stay as they are.
  CarriedAxes(const Axes& axes, const Triangle& points);

  /// The axes where the points are.
  /// Guarantee: orthonormal up to a few roundings, whatever the points.
  /// Requires:  coordinates at most about 4.
  [[nodiscard]] Axes at(const Triangle& points) const;

 private:
  // The first two axes: along the points' two edges and across them, or as they are.
  std::array<Vector3, 2> coordinates_{Vector3{1, 0, 0}, Vector3{0, 1, 0}};
  bool carried_ = false;
};

/// Numbers of three points to carry axes by: the first, the one farthest from it, and the one farthest from
/// the line through these.
/// Requires:  a point at least.
[[nodiscard]] std::array<std::size_t, 3> spread_points(std::span<const Point3> points);

}  // namespace snug
