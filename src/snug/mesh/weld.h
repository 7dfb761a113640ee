#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include <snug/mesh/control_mesh.h>

namespace snug {

/// For each point the number of the first one in the list that is welded to it; its own if it is the first.
///
/// Guarantee: without a distance, points with equal coordinates are welded, 0 and -0 being equal. With one,
///            two points are welded if their distance, as measured in double precision, is at most
///            `distance`, or if a chain of such points links them: points at the ends of a chain may be
///            farther apart. The result depends on nothing but the points and their order.
/// Requires:  fewer than 2^32 - 1 points.
/// Errors:    InputError: (value) for a distance that is negative or not finite; (refused) for one above 0
///            that is smaller than 2^-40 of the largest coordinate, and for points that are not finite.
/// Cost:      linear without a distance; with one also sorting the points and their pairs in neighbouring
///            cells of half that distance until one welds the two cells: about a second for a million points.
[[nodiscard]] std::vector<std::uint32_t> first_of_welded(std::span<const Point3> points, double distance = 0);
/// The mesh of triangles that are given by three corners each. Corners become one vertex where they are equal,
/// 0 and -0 being equal; vertices are numbered in the order of their first corners, triangles keep theirs.
///
/// Requires:  fewer than 2^32 - 1 corners, a multiple of three.
[[nodiscard]] ControlMesh mesh_of_triangles(std::span<const Point3> corners);

}  // namespace snug
