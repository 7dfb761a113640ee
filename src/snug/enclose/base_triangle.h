#pragma once

#include <algorithm>

#include <snug/base/rounding.h>
#include <snug/enclose/hull_points.h>
#include <snug/enclose/triangle.h>

namespace snug {

/// The triangle that enclosures of a patch are fitted to: its limit corners, moved along the normal to the
/// middle of the hull. Shared by offset_triangle.h and interval_triangle.h.
struct BaseTriangle {
  std::array<Vector3, 3> relative;  ///< to the hull points' origin
  Triangle placed;                  ///< origin + relative, rounded
  double placing_error;             ///< of `placed`, a coordinate
};

[[nodiscard]] BaseTriangle base_triangle(const HullPoints& points, const std::array<Vector3, 3>& corners);

/// Upper bound, a coordinate, of the error of p - foot for hull points p and feet on the base: the points'
/// own error, the base's rounding, and that of p - a - beta e_b - gamma e_c, where p - a and the edges are at
/// most `reach`.
[[nodiscard]] inline double fit_error(const HullPoints& points, const BaseTriangle& base, double reach) {
  return enlarged(points.error + base.placing_error + 32 * unit_roundoff * reach + 32 * underflow_error);
}

}  // namespace snug
