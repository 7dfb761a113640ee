#pragma once

#include <snug/mesh/control_mesh.h>
#include <snug/scheme/scheme.h>

namespace snug {

/// subdivided() of evaluate.h, with connectivity and numbering as in scheme/refine.h.
[[nodiscard]] ControlMesh subdivide(ControlMesh mesh, const SchemeOptions& options, unsigned level,
                                    bool limit, const Run& run = {});

}  // namespace snug
