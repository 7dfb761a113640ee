#pragma once

#include <array>
#include <span>

#include <snug/geometry/extent.h>
#include <snug/geometry/point.h>

namespace snug {

/// The set of x with |dot(axis_k, x - centre)| <= half_k for k = 0, 1, 2. Axes are orthonormal up to a few
/// roundings; the set is meant with these very doubles.
struct Obb {
  Point3 centre;
  std::array<Vector3, 3> axes{Vector3{1, 0, 0}, Vector3{0, 1, 0}, Vector3{0, 0, 1}};
  Vector3 half;
};

/// Axes for a box around points: the principal axes, orthonormal up to a few roundings.
/// Source:    [Gottschalk96].
[[nodiscard]] std::array<Vector3, 3> principal_axes(std::span<const Point3> points);

/// The box with given axes around a set with these extents along them; one that nothing is certainly apart from where an
/// extent is not finite.
/// Guarantee: contains the set, rounding included.
[[nodiscard]] Obb box_of(const std::array<Vector3, 3>& axes, const std::array<Extent, 3>& extents);

/// The same, extent(direction) being the set's Extent along a direction.
template <class Extents>
[[nodiscard]] Obb fit_box(const std::array<Vector3, 3>& axes, const Extents& extent) {
  return box_of(axes, {extent(axes[0]), extent(axes[1]), extent(axes[2])});
}

/// A box around boxes.
/// Requires:  at least one.
[[nodiscard]] Obb merge(std::span<const Obb> boxes);

/// A ball around a box.
struct Ball {
  Point3 centre;
  double radius;
};
[[nodiscard]] Ball ball_around(const Obb& box);

}  // namespace snug
