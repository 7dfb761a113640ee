#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include <snug/geometry.h>
#include <snug/run.h>

namespace snug {

/// A closed mesh of triangles.
struct ClosedMesh {
  std::vector<Point3> points;
  std::vector<std::array<std::uint32_t, 3>> triangles;
};

/// Leaves out points that no triangle names; the others are in the order in which triangles name them.
void drop_unused_points(ClosedMesh& mesh);

/// Does each edge belong to two triangles, which run along it opposite ways, and are the triangles around each vertex one fan?
[[nodiscard]] bool is_manifold(const ClosedMesh& mesh);

/// Collapses edges, those first that move planes least, while vertices stay within `error` of the planes of the triangles that
/// they replace, by the root of the mean square [Garland97], and `accept` is true of each triangle that is new, if it is given.
/// Triangles do not turn by more than 60 degrees at a time. Vertices that `kept` marks stay; none does if it is empty.
///
/// Guarantee: a manifold stays one. Results depend on the input alone, not on the number of threads, which all call `accept`.
/// Requires:  a manifold; coordinates of about 1.
/// Errors:    Interrupted.
/// Cost:      4 microseconds a triangle.
void simplify(ClosedMesh& mesh, double error, const std::function<bool(const Triangle&)>& accept,
              std::span<const std::uint8_t> kept, int threads, const WorkMonitor& monitor);

/// Halves the longest side of triangles that are marked with 1, the longest of all first, and the triangle across it with it, each
/// triangle once. `marks` grows with the mesh: halves have the mark of the whole. Returns the vertices that are new, in the middles.
///
/// Guarantee: a manifold stays one.
/// Requires:  a manifold, a mark for each triangle.
std::vector<std::uint32_t> halve_longest_sides(ClosedMesh& mesh, std::vector<std::uint8_t>& marks);

}  // namespace snug
