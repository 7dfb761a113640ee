#pragma once

#include <snug/mesh/control_mesh.h>
#include <snug/scheme/curve_masks.h>
#include <snug/scheme/scheme.h>

namespace snug {

/// subdivided() of evaluate.h, with connectivity and numbering as in scheme/refine.h.
[[nodiscard]] ControlMesh subdivide(ControlMesh mesh, const SchemeOptions& options, unsigned level,
                                    bool limit, const Run& run = {});

/// The polylines of a mesh after `level` steps of subdivision, or the limit positions of their vertices:
/// every polyline with vertices of its own, order and ends as in scheme/curve_masks.h. InputError (refused)
/// from require_curves, and for more than 2^31 vertices.
[[nodiscard]] ControlMesh subdivide_curves(const ControlMesh& mesh, CurveDegree degree, unsigned level,
                                           bool limit, const Run& run = {});

}  // namespace snug
