#pragma once

#include <snug/geometry/triangle.h>

namespace snug {

/// How far a point is from the sixteen triangles between the points of a quadratic Bezier triangle at quarters of its edges,
/// in single precision.
struct FlattenedDistance {
  float lower, upper;    ///< but for roundings: derivations/closest.md, "Rounding"
  TriangleParameter at;  ///< of a point of them that far away
};
/// `net`: corners, then middles of the edges 01, 12, 20, three coordinates each.
/// Guarantee: the same bits on every instruction set. Not finite where a coordinate is not.
/// Source:    derivations/closest.md.
[[nodiscard]] FlattenedDistance flattened_distance(const float* net, const float point[3]);

}  // namespace snug
