#pragma once

#include <snug/base/progress.h>
#include <snug/scheme/curve_masks.h>

namespace snug {

/// The polylines of a mesh after `level` steps of subdivision, or the limit positions of their vertices.
/// Every polyline gets vertices of its own, in its order; faces and vertices that no polyline uses are left
/// out.
///
/// Guarantee: order and ends as in scheme/curve_masks.h; positions in double precision, within a few units in
///            the last place of the largest coordinate a level.
/// Errors:    InputError (refused) from require_curves, and if the result has more than 2^31 vertices or a
///            coordinate that does not fit a double.
/// Cost:      linear in the result.
[[nodiscard]] ControlMesh subdivide_curves(const ControlMesh& mesh, CurveDegree degree, unsigned level,
                                           bool limit, const WorkMonitor& monitor = {});

}  // namespace snug
