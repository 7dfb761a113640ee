#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include <snug/mesh/control_mesh.h>

namespace snug {

/// For each point the number of the first one in the list that is welded to it; its own if it is the first.
///
/// Guarantee: without a distance, points with equal coordinates are welded, 0 and -0 being equal. With one, two
///            points are welded if their distance, as measured in double precision, is at most `distance`, or
///            if a chain of such points links them: points at the ends of a chain may be farther apart. The
///            result depends on nothing but the points and their order.
/// Requires:  fewer than 2^32 - 1 points.
/// Errors:    InputError: (value) for a distance that is negative or not finite; (refused) for one above 0 that is
///            smaller than 2^-40 of the largest coordinate, and for points that are not finite.
/// Cost:      linear without a distance; with one also sorting the points and their pairs in neighbouring cells of
///            half that distance until one welds the two cells: about a second for a million points.
[[nodiscard]] std::vector<std::uint32_t> first_of_welded(std::span<const Point3> points, double distance = 0);

/// Vertices and boundary edges that stand where others do and are not joined: faces meet there to the eye alone.
struct Coincidences {
  std::size_t vertices = 0;  ///< vertices of faces that stand exactly where another one stands
  std::size_t places = 0;    ///< where these stand
  std::size_t edges = 0;     ///< edges with one face whose ends stand where those of another such edge stand
  /// Further vertices on edges with one face that weld() would join if given `reach`, and the least and largest
  /// distance of one of them from the vertex that it would become.
  std::size_t near = 0;
  double nearest = 0, farthest = 0;
  double reach = 0;  ///< 2^-17 of the longest side of used_box()
};

/// Finds them; nothing is changed. Vertices without a face, and meshes with faces that name vertices which are not there or
/// coordinates that are not finite, have none.
///
/// Cost:      linear; on meshes with a boundary that of weld() on its vertices.
[[nodiscard]] Coincidences coincidences(const ControlMesh& mesh);

}  // namespace snug
