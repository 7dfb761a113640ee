#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include <snug/mesh/control_mesh.h>
#include <snug/surface/limit_surface.h>

namespace snug::bench {

/// Closed torus of 2 columns * rows triangles, every vertex of valence 6. Radii 3 and 1.
/// Requires:  columns, rows >= 3.
[[nodiscard]] ControlMesh torus_grid(std::size_t columns, std::size_t rows);

/// A torus grid of about `faces` triangles.
[[nodiscard]] ControlMesh regular_mesh(std::size_t faces);

/// Closed torus of about `faces` quads, every vertex of valence 4.
[[nodiscard]] ControlMesh quad_torus(std::size_t faces);

/// A torus of about `faces` faces, a quarter of them triangles and hexagons, after random moves, with about
/// `creases` creased edges in curves of one sharpness each: 0.5 to 3.5 in halves, some infinite.
/// Guarantee: the same mesh for the same arguments on every machine.
[[nodiscard]] ControlMesh character_mesh(std::size_t faces, std::size_t creases);

/// A torus of about `faces` quads with panels as of a car: extraordinary vertices, a tenth of whose network of
/// edges is creased, of sharpness 6, with ends and crossings there.
/// Guarantee: the same mesh for the same arguments on every machine.
[[nodiscard]] ControlMesh panelled_mesh(std::size_t faces);

/// A torus of quads with `count` creased edges, no two of the same sharpness, from 0 to 4.
[[nodiscard]] ControlMesh many_sharpnesses(std::size_t count);

struct Irregularity {
  double flips = 0.1;    ///< flipped edges, of all edges: 0.1 leaves a third of the vertices regular
  double jitter = 0.15;  ///< vertices move by at most this part of a grid edge a coordinate
  std::uint64_t seed = 1;
};

/// A torus grid of about `faces` triangles after random edge flips and moves of its vertices: valences 3 to
/// 12 in the mixture of a simplified or scanned mesh.
///
/// Guarantee: closed, manifold, no edge twice; the same mesh for the same arguments on every machine.
[[nodiscard]] ControlMesh irregular_mesh(std::size_t faces, const Irregularity& options = {});

/// The same with quads: `flips` of the edges turned in the hexagons of the two quads at them; valences 3 to 8.
[[nodiscard]] ControlMesh irregular_quads(std::size_t faces, const Irregularity& options = {});

/// Corners of a face that are not regular.
[[nodiscard]] std::size_t extraordinary_corners(const Kind& kind);
/// First patches of the faces with `corners` extraordinary corners.
[[nodiscard]] std::vector<PatchId> faces_with(const LimitSurface& surface, std::size_t corners);

/// Prints sizes, the histogram of valences, the number of kinds, the shares of faces by extraordinary
/// corners.
void print_statistics(const char* name, const LimitSurface& surface);

}  // namespace snug::bench
