#pragma once

#include <array>
#include <cstdint>
#include <vector>

namespace oracle {

using Point = std::array<double, 3>;
using Triangle = std::array<std::uint32_t, 3>;

/// Boundary rule, in the words of OpenSubdiv's vertex boundary interpolation.
enum class Boundary {
  edge_and_corner,  ///< boundary edges are creases, boundary vertices of one face are corners
  edge_only,        ///< boundary edges are creases, all boundary vertices lie on them smoothly
  none,             ///< a face with a boundary vertex has no surface
};

/// Control mesh of a Loop surface, as plain arrays.
///
/// Every function that takes one throws std::invalid_argument unless: indices are in range, coordinates of
/// used points are finite, the three corners of a face differ, an edge has at most two faces, the faces at a
/// vertex form a single fan, and an interior vertex has valence 3 to 1000. Functions that look at one face
/// check its neighbourhood only. Orientation does not matter, unused points are ignored.
struct TwinMesh {
  std::vector<Point> points;
  std::vector<Triangle> triangles;
  Boundary boundary = Boundary::edge_and_corner;
};

}  // namespace oracle
