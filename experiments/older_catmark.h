#pragma once

#include <snug/mesh/control_mesh.h>

namespace snug {

/// The control mesh after `level` steps of Catmull-Clark by the rule of [DooSabin78] for inner vertices, (Q +
/// 2 R + S) / 4 at every valence: Q the mean of the new points of the faces around, R that of the middles of
/// the edges, S the vertex. The rule that lasted is (Q + 2 R + (n - 3) S) / n.
///
/// Errors:    InputError (refused) for meshes that require_subdividable refuses, and for creases and corners.
/// Cost:      linear in the result.
[[nodiscard]] ControlMesh subdivide_by_older_rule(ControlMesh mesh, unsigned level);

}  // namespace snug
