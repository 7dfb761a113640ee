#pragma once

#include <string>
#include <vector>

#include <snug/inspect.h>
#include <snug/mesh/control_mesh.h>
#include <snug/mesh/topology.h>

namespace snug {

/// Legal defects are reported, and answered all the same.
[[nodiscard]] constexpr bool is_legal(DefectKind kind) {
  return kind == DefectKind::isolated_vertex || kind == DefectKind::zero_area_face;
}
/// Defects that Catmull-Clark answers all the same, the elements infinitely sharp; and Loop, but for
/// duplicate faces.
[[nodiscard]] constexpr bool is_non_manifold(DefectKind kind) {
  return kind == DefectKind::repeated_vertex || kind == DefectKind::duplicate_face ||
         kind == DefectKind::edge_of_many_faces || kind == DefectKind::inconsistent_orientation ||
         kind == DefectKind::pinched_vertex;
}

/// Those of defects() that show without looking at neighbours: of faces each on its own, of duplicate faces,
/// points and tags. All but legal ones.
/// Requires:  faces of three vertices or more, in range; the mesh's topology, which is manifold.
[[nodiscard]] std::vector<Defect> defects_of_elements(const ControlMesh& mesh, const Topology& manifold);

/// "text; text; ... and 12 more": at most ten.
[[nodiscard]] std::string summary(const std::vector<Defect>& list);

}  // namespace snug
