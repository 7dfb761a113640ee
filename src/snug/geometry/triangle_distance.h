#pragma once

#include <array>
#include <cstddef>
#include <optional>

#include <snug/geometry/triangle.h>

namespace snug {

/// Two triangles as near as they come.
struct NearestTriangles {
  Barycentric on_a, on_b;  ///< of the points that were found nearest, in double precision
  /// Distance of the supporting planes across the direction between those points: zero or a lower bound of
  /// the triangles', equal to it up to rounding where the points are the nearest ones.
  double certain_distance;
};

/// Nearest points of two triangles, with a lower bound of their distance that does not depend on the points.
///
/// Guarantee: the exact distance of the triangles is at least certain_distance.
/// Requires:  finite corners of at most about 4.
/// Source:    [Ericson05, sec. 5.1.9, 5.1.10]; differs: a supporting slab certifies the result.
[[nodiscard]] NearestTriangles nearest(const Triangle& a, const Triangle& b);

/// Weights that roundings may have left a little outside of the triangle, as a parameter inside.
[[nodiscard]] TriangleParameter clamped(Barycentric weights);

/// A point of each of two triangles.
struct PairOfPoints {
  Barycentric on_a, on_b;
};

/// Where edges of one triangle pass through the inside of the other: edge 0 of a, edge 0 of b, edge 1 of a...
struct Crossings {
  std::size_t count = 0;
  std::array<PairOfPoints, 6> points;
};

/// About the middle of the segment in which two triangles cut each other; nothing if none is found.
[[nodiscard]] std::optional<PairOfPoints> middle_of_contact(const Triangle& a, const Triangle& b);

}  // namespace snug
