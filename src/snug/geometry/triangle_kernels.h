#pragma once

#include <array>
#include <cstddef>

#include <snug/geometry/triangle_distance.h>

/// Searches over the edges and corners of two triangles, four at once; the same bits on every instruction set.
namespace snug::kernels {

using Corners = std::array<Vector3, 3>;

/// Where edges of one triangle pass through the inside of the other: edge 0 of a, edge 0 of b, edge 1 of a and so on.
struct Crossings {
  std::size_t count = 0;
  std::array<PairOfPoints, 6> points;
};
[[nodiscard]] Crossings crossings(const Corners& a, const Corners& b);

/// Nearest points in double precision, or the first of crossings() if there are any; true then.
///
/// Guarantee: b >= 0, c >= 0 and b + c <= 1 of both points, in doubles. That they are nearest is true up to rounding
///            only.
/// Requires:  finite corners.
/// Source:    [Ericson05, sec. 5.1.5, 5.1.9]; differs: corners and edges, insides of edges, and corners and faces are
///            tried each on their own, without branches.
[[nodiscard]] bool nearest_points(const Corners& a, const Corners& b, PairOfPoints& out);

}  // namespace snug::kernels
