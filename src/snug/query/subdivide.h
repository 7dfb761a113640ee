#pragma once

#include <snug/mesh/control_mesh.h>
#include <snug/scheme/curve_masks.h>
#include <snug/scheme/scheme.h>

namespace snug {

/// The control mesh after `level` steps of subdivision, or the limit positions of its vertices.
///
/// With `limit`, faces without a limit surface are left out: holes, with BoundaryRule::none those at boundary vertices, and
/// of dual schemes those that touch a boundary vertex of the refined mesh; and with them the vertices that no face uses
/// any more. Of a dual scheme the limit position of a vertex is the middle of its patch.
///
/// Guarantee: connectivity and numbering as in scheme/refine.h; positions in double precision, within a few
///            units in the last place of the largest coordinate a level. Tags are decayed by as many steps.
/// Errors:    InputError (refused) from require_subdividable, and if the result has more than 2^31 faces or a
///            coordinate that does not fit a double. Interrupted.
/// Cost:      linear in the result.
[[nodiscard]] ControlMesh subdivide(ControlMesh mesh, const SchemeOptions& options, unsigned level,
                                    bool limit, const WorkMonitor& monitor = {});

/// The polylines of a mesh after `level` steps of subdivision, or the limit positions of their vertices. Every polyline gets
/// vertices of its own, in its order; faces and vertices that no polyline uses are left out.
///
/// Guarantee: order and ends as in scheme/curve_masks.h; positions as above.
/// Errors:    InputError (refused) from require_curves, and if the result has more than 2^31 vertices or a coordinate that
///            does not fit a double. Interrupted.
/// Cost:      linear in the result.
[[nodiscard]] ControlMesh subdivide_curves(const ControlMesh& mesh, CurveDegree degree, unsigned level,
                                           bool limit, const WorkMonitor& monitor = {});

}  // namespace snug
