#pragma once

#include <cstddef>

#include <snug/mesh.h>

namespace snug::command {

/// Counts of a mesh, of a broken one too. Faces that use vertices which are not there are left out.
struct MeshCounts {
  std::size_t used_vertices = 0;
  std::size_t edges = 0;
  std::size_t boundary_edges = 0;  ///< edges with one face
  std::size_t components = 0;      ///< sets of faces joined by vertices
  bool boxes_meet = false;         ///< do the boxes around two components have a point in common?
  std::size_t min_valence = 0;     ///< least number of edges at a used vertex
  std::size_t max_valence = 0;
  std::size_t extraordinary = 0;  ///< used vertices unlike those of a regular lattice, by valence
  bool closed = false;            ///< it has faces, and along every edge as many run one way as the other
};

/// `regular_valence`: edges at an interior vertex of the scheme's regular lattice, 6 for Loop and 4 for
/// Catmull-Clark; at a boundary vertex it is 4 and 3.
/// Cost:      linear, times the logarithm of the largest valence.
[[nodiscard]] MeshCounts count_elements(const ControlMesh& mesh, std::size_t regular_valence);

/// Does an edge belong to three faces or more?
[[nodiscard]] bool has_edges_of_many_faces(const ControlMesh& mesh);

/// Vertices and boundary edges that stand where others do and are not joined: faces meet there to the eye
/// alone.
struct Coincidences {
  std::size_t vertices = 0;  ///< vertices of faces that stand exactly where another one stands
  std::size_t places = 0;    ///< where these stand
  std::size_t edges = 0;     ///< edges with one face whose ends stand where those of another such edge stand
  /// Further vertices on edges with one face that weld() would join if given `reach`, and the least and
  /// largest distance of one of them from the vertex that it would become.
  std::size_t near = 0;
  double nearest = 0, farthest = 0;
  double reach = 0;  ///< 2^-17 of the longest side of used_box()
};

/// Finds them; nothing is changed. Vertices without a face, and meshes with faces that name vertices which
/// are not there or coordinates that are not finite, have none.
///
/// Cost:      linear; on meshes with a boundary that of weld() on its vertices.
[[nodiscard]] Coincidences coincidences(const ControlMesh& mesh);

}  // namespace snug::command
