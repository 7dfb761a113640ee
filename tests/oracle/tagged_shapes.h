#pragma once

#include <oracle/tagged_mesh.h>

#include <array>
#include <cstdint>
#include <random>
#include <set>

/// Small control meshes with tags or flaws.
namespace oracle::meshes {

[[nodiscard]] TaggedMesh cube();  ///< corner i + 2j + 4k at (i, j, k); faces seen from outside
[[nodiscard]] TaggedMesh quad_grid(std::uint32_t columns, std::uint32_t rows);
[[nodiscard]] TaggedMesh triangulated(const TaggedMesh& mesh);  ///< fans at each face's first corner
[[nodiscard]] TaggedMesh prism(std::uint32_t n);                ///< two n-gons and n quads
[[nodiscard]] TaggedMesh pyramid(std::uint32_t n);              ///< apex 0, triangles and an n-gon
[[nodiscard]] TaggedMesh mixed_strip();  ///< open: triangle, quad, pentagon, triangle around one vertex
[[nodiscard]] TaggedMesh book(std::uint32_t pages);  ///< quads on a common spine of two edges
[[nodiscard]] TaggedMesh two_cubes_at_a_vertex();
/// The surface of unit cubes with these least corners: a quad between each and each that is not among them, turned outwards.
[[nodiscard]] TaggedMesh cells(const std::set<std::array<int, 3>>& corners);
[[nodiscard]] TaggedMesh moebius(std::uint32_t n);  ///< n quads; one edge is crossed against its direction
[[nodiscard]] TaggedMesh back_to_back();            ///< two quads with the same four corners: valence 2
[[nodiscard]] TaggedMesh
vertices_twice();                      ///< faces that name a vertex twice or three times, in a row and not
[[nodiscard]] TaggedMesh same_ways();  ///< edges that faces run along in the same direction, among others
[[nodiscard]] TaggedMesh pole(std::uint32_t n, bool open);  ///< n quads around vertex 0
[[nodiscard]] TaggedMesh valence_two_inside();  ///< two quads share two edges in a row, others around

/// Moves every point by up to `amount` along each axis, by amounts a float holds.
[[nodiscard]] TaggedMesh shaken(TaggedMesh mesh, double amount, std::mt19937_64& random);

}  // namespace oracle::meshes
