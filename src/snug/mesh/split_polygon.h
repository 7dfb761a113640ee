#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include <support/point.h>

namespace snug {

/// A point of a plane.
using PlanePoint = std::array<double, 2>;

/// On which side of the line from a to b lies c? 1 left, -1 right, 0 on it.
///
/// Guarantee: exact, unless products of coordinates overflow or fall below the least normal double times
///            2^53.
[[nodiscard]] int side_of(const PlanePoint& a, const PlanePoint& b, const PlanePoint& c);

/// Points without the coordinate along which the normal is longest, in an order that keeps counter-clockwise
/// polygons so, seen against the normal.
[[nodiscard]] std::vector<PlanePoint> dropped_along(const Vector3& normal, std::span<const Point3> points);

/// Is the closed polygon convex and counter-clockwise? Points on an edge between its neighbours are allowed;
/// edges that run back, or around twice, are not. Exact as side_of().
[[nodiscard]] bool is_convex(std::span<const PlanePoint> polygon);

/// Corners of triangles that together are the polygon, each counter-clockwise and with an area, or nothing
/// where a polygon that crosses itself stops this. Every corner is one of a triangle, and every edge the edge
/// of one.
///
/// Requires:  counter-clockwise. Its edges may touch, as a bridge to a hole does.
/// Cost:      quadratic in the corners, cubic at worst.
/// Source:    ears [Meisters75].
[[nodiscard]] std::vector<std::array<std::uint32_t, 3>> triangles_of(std::span<const PlanePoint> polygon);

}  // namespace snug
