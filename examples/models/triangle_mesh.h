#pragma once
// A control mesh of triangles and the small edits that all models share.

#include <array>
#include <span>
#include <string>
#include <vector>

#include "vec.h"

namespace models {

using Triangle = std::array<Index, 3>;
using Quad = std::array<Index, 4>;

struct TriangleMesh {
  std::vector<Vec3> points;
  std::vector<Triangle> faces;
};

/// Neighbours of every vertex, each list ascending.
std::vector<std::vector<Index>> neighbours(const TriangleMesh& mesh);

/// Splits quads into triangles. A non-planar quad takes its shorter diagonal; where both are within a tenth of each
/// other the diagonals alternate, so that valences vary.
std::vector<Triangle> triangulate(std::span<const Vec3> points, std::span<const Quad> quads);

/// Joins the mesh with its mirror image in x = 0; vertices with x == 0 are shared.
TriangleMesh mirrored(const TriangleMesh& half);

/// Replaces the edge (a, b) of two triangles by the edge of their far corners.
/// Returns false, and changes nothing, if that edge exists already, a valence would drop below four or exceed ten, or a
/// face would turn by more than about 60 degrees.
bool flip_edge(TriangleMesh& mesh, Index a, Index b);

/// Flips about one edge in `stride`, deterministic in `seed`; returns how many were flipped.
std::size_t scatter_flips(TriangleMesh& mesh, std::uint32_t seed, std::uint32_t stride);

/// Puts a vertex of valence three into a face, raised along the normal by `raise` times the mean edge length.
Index split_face(TriangleMesh& mesh, std::size_t face, double raise);

/// Makes closed parts wind counter-clockwise seen from outside: reverses all faces if the volume is negative.
void orient_outward(TriangleMesh& mesh);

/// Rounds to four decimals. Throws std::runtime_error if the result is not an oriented 2-manifold (with or without
/// boundary) free of isolated vertices, duplicate points and degenerate faces.
void finish(TriangleMesh& mesh, const std::string& name);

/// Text of a Wavefront OBJ file, "\n" line ends, four decimals at most.
std::string obj_text(const TriangleMesh& mesh, const std::string& title);

}  // namespace models
