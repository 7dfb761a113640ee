#pragma once

#include <oracle/twin_mesh.h>

#include <cstdint>
#include <vector>

namespace oracle {

/// Control mesh with tags, as plain arrays. Faces are polygons; whatever their connection is, it is taken.
///
/// Every function that takes one throws std::invalid_argument unless indices are in range, coordinates are
/// finite, sharpnesses are no NaN, and a face has two corners or more. A corner may repeat in a face.
struct TaggedMesh {
  struct Crease {
    std::uint32_t a, b;
    double sharpness;
  };
  struct Corner {
    std::uint32_t vertex;
    double sharpness;
  };
  std::vector<Point> points;
  std::vector<std::vector<std::uint32_t>> polygons;
  std::vector<Crease> creases;  ///< the last one for an edge counts; one for no edge is ignored
  std::vector<Corner> corners;  ///< the same
  std::vector<std::uint32_t> holes;
};

/// From here on a sharpness is infinite.
constexpr double kInfinitelySharp = 10;

enum class PrimalScheme { loop, catmull_clark };

/// Rules that refine the mesh, in OpenSubdiv's words.
struct Rules {
  PrimalScheme scheme = PrimalScheme::catmull_clark;
  Boundary boundary = Boundary::edge_and_corner;
  bool chaikin = false;           ///< the other way for sharpness to fall
  bool smooth_triangles = false;  ///< Catmull-Clark only
  bool old_vertex_rule = false;   ///< Catmull-Clark only: (Q + 2R + S) / 4 at every valence
  /// With chaikin an edge of sharpness > 1 may become smooth at one end only. OpenSubdiv's refiner then
  /// weights the midpoint with the sharpness itself, though its comments say that more than one counts as
  /// one.
  bool clamp_dart_edges = false;
};

}  // namespace oracle
