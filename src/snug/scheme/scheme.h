#pragma once

#include <optional>

#include <snug/mesh/control_mesh.h>
#include <snug/mesh/topology.h>
#include <snug/mesh/validate.h>

namespace snug {

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

/// Scheme and boundary rule of a mesh: the given ones, else its tags', else natural_scheme() and edge_and_corner.
[[nodiscard]] SchemeOptions rules_for(const ControlMesh& mesh, std::optional<Scheme> scheme,
                                      std::optional<BoundaryRule> boundary);

/// Loop for triangles alone, else Catmull-Clark, whatever the tag.
[[nodiscard]] Scheme scheme_of_faces(const ControlMesh& mesh);
/// Do tags other than that of the scheme change the surface?
[[nodiscard]] bool has_rules(const MeshTags& tags);
/// Does natural_scheme() smooth triangles although no tag says that they are a control mesh?
[[nodiscard]] bool smooths_untagged(const ControlMesh& mesh);

/// The topology of the mesh. Throws InputError (refused), naming elements and the next step, unless the limit
/// surface under these rules is one that snug answers questions about: no refusing defect (mesh/validate.h),
/// faces and valences that the scheme takes. Non-manifold edges and vertices and faces of inconsistent
/// orientation are kept by Loop and Catmull-Clark, infinitely sharp, as OpenSubdiv has them; dual schemes
/// refuse them.
Topology require_surface(const ControlMesh& mesh, const SchemeOptions& options);
/// The same for refinement alone, which Loop and Catmull-Clark also do to faces that name a vertex twice.
Topology require_subdividable(const ControlMesh& mesh, const SchemeOptions& options);

}  // namespace snug
