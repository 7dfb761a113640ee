#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <span>

#include <support/point.h>

namespace snug {

/// Bounds of dot(direction, x) over a set, rounding included; empty at first.
struct Extent {
  double lower = INFINITY, upper = -INFINITY;

  void add(const Extent& other) {
    lower = std::min(lower, other.lower);
    upper = std::max(upper, other.upper);
  }
  void add(double height) { add(Extent{height, height}); }
};
/// Bounds of what cannot be bounded.
inline constexpr Extent unbounded{-INFINITY, INFINITY};

/// The set of x with |dot(axis_k, x - centre)| <= half_k for k = 0, 1, 2. Axes are orthonormal up to a few
/// roundings; the set is meant with these very doubles.
struct Obb {
  Point3 centre;
  std::array<Vector3, 3> axes{Vector3{1, 0, 0}, Vector3{0, 1, 0}, Vector3{0, 0, 1}};
  Vector3 half;
};

using Axes = std::array<Vector3, 3>;

/// Axes for a box around points: the principal axes, orthonormal up to a few roundings.
/// Source:    [Gottschalk96].
[[nodiscard]] Axes principal_axes(std::span<const Point3> points);

/// Axes that are orthonormal up to a few roundings: the first along `a`, the second in the plane of a and b
/// where that is determined, else anywhere; the coordinate axes where `a` is zero or not finite.
[[nodiscard]] Axes orthonormal_axes(const Vector3& a, const Vector3& b);

/// The box with given axes around a set with these extents along them, rounding included; one that nothing is
/// certainly apart from where an extent is not finite.
[[nodiscard]] Obb box_of(const std::array<Vector3, 3>& axes, const std::array<Extent, 3>& extents);

/// The same, extent(direction) being the set's Extent along a direction.
template <class Extents>
[[nodiscard]] Obb fit_box(const std::array<Vector3, 3>& axes, const Extents& extent) {
  return box_of(axes, {extent(axes[0]), extent(axes[1]), extent(axes[2])});
}

/// Principal axes of one or more boxes.
[[nodiscard]] Axes axes_around(std::span<const Obb> boxes);
/// A box around one or more boxes.
[[nodiscard]] Obb merge(std::span<const Obb> boxes);
/// The same along given axes.
[[nodiscard]] Obb merge(std::span<const Obb> boxes, const Axes& axes);

/// Upper bound of |dot(w, d)| for differences d with |d| <= error and |dot(n, d)| <= normal_error.
/// Guarantee: whatever n is, rounding included. Tightness: the least where n has length 1.
/// Requires:  |w|, |n| at most about 1; normal_error finite.
/// Source:    derivations/quadratics.md, "Errors with a direction".
[[nodiscard]] double error_along(const Vector3& w, const Vector3& n, double error, double normal_error);

/// A set that boxes are fitted to, as vectors read it: in a box, and off a quadratic Bezier triangle by differences as in
/// error_along().
struct FittedSet {
  FittedSet() = default;
  /// Requires:  `net`: corners, then middles of the edges 01, 12, 20; `error` infinite where nothing but the box is known.
  FittedSet(const Obb& box, const std::array<Point3, 6>& net, double error, const Vector3& normal = {},
            double normal_error = 0);

  Obb box;
  double box_error = INFINITY;   ///< of its extents; infinite: there is no box, and nothing is known
  std::array<Vector3, 6> net{};  ///< the first corner, the other points from it
  Vector3 normal{};
  double error = 0, normal_error = 0;
  double tilt = 0;          ///< normal_error over what of the error is left across the normal
  double slack = INFINITY;  ///< added to the error; infinite: nothing but the box is known
};
/// Axes that suit a box around one or more of these.
[[nodiscard]] Axes axes_around(std::span<const FittedSet> sets, std::span<const std::uint32_t> which);

/// A ball around a box.
struct Ball {
  Point3 centre;
  double radius;
};
[[nodiscard]] Ball ball_around(const Obb& box);
/// A ball around one or more boxes, some percent larger than the smallest.
/// Source:    [Badoiu03].
[[nodiscard]] Ball ball_around(std::span<const Obb> boxes);
/// A ball around them with this centre.
[[nodiscard]] Ball ball_around(std::span<const Obb> boxes, const Point3& centre);

}  // namespace snug
