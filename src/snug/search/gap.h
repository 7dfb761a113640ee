#pragma once

#include <cmath>

#include <snug/geometry/rounding.h>
#include <snug/geometry/triangle_distance.h>
#include <support/point.h>

/// Distances of what is known up to an error: each rounding of them once.
/// Source:    derivations/rounding.md, "Two sets, two points".
namespace snug {

/// Lower bound of the distance of two sets that are within `radius_a` and `radius_b` of two triangles; negative where none shows. A
/// point that is known up to an error is a set, too.
[[nodiscard]] inline double gap_of(const NearestTriangles& near, double radius_a, double radius_b) {
  return rounded_down(near.certain_distance - enlarged(radius_a + radius_b));
}

/// Upper bound of the distance of two points that are together at most `errors` from two computed ones; `between` is the computed
/// difference of these. Nothing is added that grows with anything but these, which would be more than all else far from the origin.
[[nodiscard]] inline double distance_at_most(const Vector3& between, double errors) {
  return (std::sqrt(length_sq(between) + 8 * underflow_error) + errors) * (1 + 16 * unit_roundoff);
}

/// Lower bound of the distance of two sets on either side of planes across a direction of length 1, up to 8 roundings. `taken`: an
/// upper bound of how far the one reaches along it, less a lower bound of where the other one begins.
[[nodiscard]] inline double gap_of_planes(double taken) { return -taken * (1 - 16 * unit_roundoff); }

}  // namespace snug
