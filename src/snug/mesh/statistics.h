#pragma once

#include <cstddef>

#include <snug/mesh/control_mesh.h>

namespace snug {

/// Counts of a mesh, of a broken one too. Faces that use vertices which are not there are left out.
struct MeshStatistics {
  std::size_t used_vertices = 0;
  std::size_t edges = 0;
  std::size_t boundary_edges = 0;  ///< edges with one face
  std::size_t components = 0;      ///< sets of faces joined by vertices
  std::size_t min_valence = 0;     ///< least number of edges at a used vertex
  std::size_t max_valence = 0;
  std::size_t extraordinary = 0;  ///< used vertices unlike those of a regular lattice, by valence
  bool closed = false;            ///< it has faces, and every edge has two
};

/// `regular_valence`: edges at an interior vertex of the scheme's regular lattice, 6 for Loop and 4 for
/// Catmull-Clark; at a boundary vertex it is 4 and 3.
/// Cost:      linear, times the logarithm of the largest valence.
[[nodiscard]] MeshStatistics statistics(const ControlMesh& mesh, std::size_t regular_valence);

}  // namespace snug
