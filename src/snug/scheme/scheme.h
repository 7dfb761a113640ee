#pragma once

#include <cstdint>

#include <snug/mesh/control_mesh.h>

namespace snug {

enum class Scheme : std::uint8_t { loop, catmark, doo_sabin, midedge };

[[nodiscard]] const char* name_of(Scheme scheme);

/// Rules that turn a mesh into a surface, beside the scheme itself.
struct SchemeOptions {
  Scheme scheme = Scheme::loop;
  BoundaryRule boundary = BoundaryRule::edge_and_corner;
  friend bool operator==(const SchemeOptions&, const SchemeOptions&) = default;
};

/// Largest and least valence of an interior vertex that is answered.
inline constexpr std::size_t min_interior_valence = 3;
inline constexpr std::size_t max_interior_valence = 1000;
/// Most faces around a boundary vertex.
inline constexpr std::size_t max_boundary_faces = 1000;

/// The scheme of a mesh that names none: Loop for triangles alone, else Catmull-Clark.
[[nodiscard]] Scheme natural_scheme(const ControlMesh& mesh);

/// Throws InputError (refused) unless the limit surface of this mesh under these rules is one that snug
/// answers questions about: no refusing defect (mesh/validate.h), Loop on triangles, valences in range, no
/// tag that would change the surface. The message names elements and the next step.
void require_subdividable(const ControlMesh& mesh, const SchemeOptions& options);

}  // namespace snug
