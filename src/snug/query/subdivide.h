#pragma once

#include <snug/base/progress.h>
#include <snug/mesh/control_mesh.h>
#include <snug/scheme/scheme.h>

namespace snug {

/// The control mesh after `level` steps of subdivision, or the limit positions of its vertices.
///
/// With BoundaryRule::none, `limit` leaves out the faces at boundary vertices and with them the vertices that
/// no face uses any more: what is left is the part of the mesh that has a limit surface.
///
/// Guarantee: connectivity and numbering as in scheme/refine.h; positions in double precision, within a few
///            units in the last place of the largest coordinate a level.
/// Errors:    InputError (refused) from require_subdividable, and if the result has more than 2^31 faces or a
///            coordinate that does not fit a double.
/// Cost:      linear in the result.
[[nodiscard]] ControlMesh subdivide(ControlMesh mesh, const SchemeOptions& options, unsigned level,
                                    bool limit, const WorkMonitor& monitor = {});

}  // namespace snug
