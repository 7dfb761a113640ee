#pragma once

#include <span>

#include <support/point.h>

namespace snug {

/// The point nearest to the origin in the convex hull of some points, in double precision; zero if the origin
/// is in the hull, up to rounding. With z, dot(z, p) >= |z|^2 for all points p, up to rounding: where it is not
/// zero, z / |z|^2 is the shortest x with dot(x, p) >= 1 for all p.
/// Requires:  at least one point; finite, of lengths not far from 1.
/// Cost:      linear in the points, some ten times.
/// Source:    [Gilbert88].
[[nodiscard]] Vector3 nearest_to_origin(std::span<const Vector3> points);

}  // namespace snug
