#pragma once

#include <algorithm>

#include <snug/bounds/hull_points.h>
#include <snug/geometry/rounding.h>
#include <snug/geometry/triangle.h>

namespace snug {

/// How much the nets of tips may add to a hull before it is worth refining them.
inline constexpr double notable_excess = 0.01;

/// The triangle that enclosures of a patch are fitted to: its limit corners, moved along the normal to the
/// middle of the hull. Shared by offset_triangle.h and interval_triangle.h.
struct BaseTriangle {
  std::array<Vector3, 3> relative;  ///< to the hull points' origin
  Triangle placed;                  ///< origin + relative, rounded
  double placing_error;             ///< of `placed`, a coordinate
  bool tips_stick_out;              ///< along the normal, by a notable part of the hull's height
};

[[nodiscard]] BaseTriangle base_triangle(const HullPoints& points, const std::array<Vector3, 3>& corners);

/// Upper bound, a coordinate, of the error of  p - a - beta e_b - gamma e_c  by rounding, where p - a and the
/// edges are at most `reach`.
[[nodiscard]] inline double foot_error(double reach) {
  return enlarged(32 * unit_roundoff * reach + 32 * underflow_error);
}

}  // namespace snug
