#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <snug/mesh/control_mesh.h>

namespace snug {

enum class DefectKind : std::uint8_t {
  index_out_of_range,        ///< face uses a vertex that is not there
  coordinate_not_finite,     ///< vertex
  too_few_vertices,          ///< face with fewer than three corners
  repeated_vertex,           ///< face names a vertex twice
  duplicate_face,            ///< two faces with the same vertices
  edge_of_many_faces,        ///< edge with more than two faces
  inconsistent_orientation,  ///< two faces run along an edge in the same direction
  pinched_vertex,            ///< the faces around a vertex form more than one fan
  bad_tag,          ///< a tag names something that is not there, or a sharpness that is not a number >= 0
  isolated_vertex,  ///< no face uses it: legal, it has no surface
  zero_area_face,   ///< legal: the limit surface is defined all the same
};

/// A fault of a mesh, with the elements it touches.
struct Defect {
  DefectKind kind;
  std::string text;  ///< one line without a full stop that names the elements, e.g. "edge (12, 57) has 3
                     ///< faces: 4, 9, 31"
};

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

/// All defects of a mesh, by kind, then by element.
///
/// Guarantee: a mesh without defects that are not legal is an oriented manifold, closed or with boundary, of
///            finite coordinates. zero_area_face is found in double precision.
/// Requires:  well-formed arrays; else nothing. Indices out of range hide the defects that depend on
///            neighbours.
[[nodiscard]] std::vector<Defect> defects(const ControlMesh& mesh);

/// Those of them that show without looking at neighbours: of faces each on its own, of duplicate faces,
/// points and tags. All but legal ones, where the mesh's topology is manifold.
/// Requires:  faces of three vertices or more, in range.
[[nodiscard]] std::vector<Defect> defects_of_elements(const ControlMesh& mesh);

/// "text; text; ... and 12 more": at most ten.
[[nodiscard]] std::string summary(const std::vector<Defect>& list);

}  // namespace snug
