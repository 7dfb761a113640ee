#pragma once

#include <vector>

#include <snug/query/local_tolerances.h>
#include <snug/surface/limit_surface.h>
#include <snug/tessellate.h>

namespace snug {

/// A refinement with tolerances that differ from place to place, in mesh units; for each triangle its part of the surface and a
/// proved error, at most the tolerance of that part.
struct LocalTessellation {
  Tessellation mesh;
  std::vector<PatchPart> parts;
  std::vector<double> errors;
};
/// Requires:  none of `options` counts.
[[nodiscard]] LocalTessellation tessellate(const LimitSurface& surface, const LocalTolerances& tolerances,
                                           const TessellateOptions& options, const Run& run = {});

}  // namespace snug
