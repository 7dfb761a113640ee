#pragma once

#include <snug/mesh.h>

namespace snug {

/// A polyhedron around a convex body, centred at the origin.
struct OuterMesh {
  ControlMesh mesh;    ///< flat, closed, facing outwards
  double outward = 0;  ///< it goes no farther beyond the body
};

/// The box of these sides: 12 triangles, exact.
/// Requires:  positive, finite numbers below 1e150; here and below.
[[nodiscard]] ControlMesh box_mesh(const Vector3& sides);

/// Contains the cylinder of this radius and length, whose axis is z.
/// `error`:   how far it may go beyond it, as a share of the radius, >= 1e-6.
/// Guarantee: rounding included.
[[nodiscard]] OuterMesh cylinder_mesh(double radius, double length, double error);

/// The same of a sphere.
/// Guarantee: each facet's plane is at least the radius away from the origin, so the ball is inside.
/// Requires:  error >= 1e-5: 1.3 million triangles.
[[nodiscard]] OuterMesh sphere_mesh(double radius, double error);

}  // namespace snug
