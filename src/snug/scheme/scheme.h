#pragma once

#include <cstdint>

#include <snug/mesh/control_mesh.h>
#include <snug/mesh/topology.h>
#include <snug/mesh/validate.h>

namespace snug {

enum class Scheme : std::uint8_t { loop, catmark, doo_sabin, midedge };

[[nodiscard]] const char* name_of(Scheme scheme);

/// Does a patch belong to a face, and do vertices stay vertices? Dual schemes: a patch belongs to a vertex.
[[nodiscard]] constexpr bool is_primal(Scheme scheme) {
  return scheme == Scheme::loop || scheme == Scheme::catmark;
}

/// Rules that turn a mesh into a surface, beside the scheme itself.
struct SchemeOptions {
  Scheme scheme = Scheme::loop;
  BoundaryRule boundary = BoundaryRule::edge_and_corner;
  CreaseMethod creases = CreaseMethod::uniform;
  SmoothTriangles triangles = SmoothTriangles::catmark;
  friend bool operator==(const SchemeOptions&, const SchemeOptions&) = default;
};

/// The rules for this mesh: its tags name the crease method and the treatment of triangles.
[[nodiscard]] SchemeOptions with_tags(SchemeOptions options, const MeshTags& tags);

/// Least and largest valence of an interior vertex that is answered. Loop takes no 2: one step makes two edges between the
/// same two vertices there.
[[nodiscard]] constexpr std::size_t min_interior_valence(Scheme scheme) {
  return scheme == Scheme::catmark ? 2 : 3;
}
inline constexpr std::size_t max_interior_valence = 1000;
/// Most faces around a boundary or non-manifold vertex.
inline constexpr std::size_t max_boundary_faces = 1000;
/// Most vertices of a face.
inline constexpr std::size_t max_face_size = 1000;

/// Does the scheme answer questions about the surface of a mesh with such a defect all the same? Loop takes no duplicate faces:
/// one step makes two edges between the same two vertices there, which are not one. Nor does a face that names a vertex
/// twice have patches with corners that can be told apart.
[[nodiscard]] bool is_answered(DefectKind kind, Scheme scheme);

/// The scheme of a mesh that names none: Loop for triangles alone, else Catmull-Clark.
[[nodiscard]] Scheme natural_scheme(const ControlMesh& mesh);

/// Throws InputError (refused) unless the limit surface of this mesh under these rules is one that snug
/// answers questions about: no refusing defect (mesh/validate.h), Loop on triangles, valences in range. Non-manifold
/// edges and vertices and faces of inconsistent orientation are kept by Loop and Catmull-Clark, infinitely sharp, as
/// OpenSubdiv has them; dual schemes refuse them. The message names elements and the next step.
/// Returns:   the topology of the mesh.
Topology require_surface(const ControlMesh& mesh, const SchemeOptions& options);
/// The same for refinement alone, which Loop and Catmull-Clark also do to faces that name a vertex twice.
Topology require_subdividable(const ControlMesh& mesh, const SchemeOptions& options);

}  // namespace snug
