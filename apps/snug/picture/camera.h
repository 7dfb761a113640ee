#pragma once

#include <span>

#include <support/point.h>

namespace snug {

/// A perspective camera: what lies at eye + z (forward + s right + t up), z > 0, appears at (s, t) of the
/// image plane,
///
///        t = tangent
///      +-------------+
///      |      ^ up   |      the picture shows |t| <= tangent and |s| <= tangent * width / height;
///      |      +--> right    forward points into the page.
///      |             |
///      +-------------+
///
/// Requires: right, up and forward are orthonormal, right = forward x up; tangent > 0.
struct Camera {
  Point3 eye;
  Vector3 right{1, 0, 0}, up{0, 1, 0}, forward{0, 0, -1};
  double tangent = 0.25;  ///< of half the vertical angle of view
};

/// The camera that looks along `view_direction` and shows all the points as large as possible, centred, but
/// for a margin of 5 % of the picture's height and width at each side. The angle of view is 28 degrees
/// vertically.
///
/// Guarantee: each point is in front of the eye and inside the picture, up to rounding. A single point is
/// shown from
///            distance 1.
/// Requires:  at least one point, all finite; aspect = width / height > 0; `view_direction` and `up` finite,
/// not zero
///            and not parallel (they need not be unit or perpendicular).
/// Errors:    InputError (value) on what is required.
[[nodiscard]] Camera frame(std::span<const Point3> points, Vector3 view_direction, Vector3 up, double aspect);

/// The same for the corners of a box that is not empty: looser around what is in it, and still when that
/// moves.
[[nodiscard]] Camera frame(const Box3& box, Vector3 view_direction, Vector3 up, double aspect);

}  // namespace snug
