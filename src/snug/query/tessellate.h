#pragma once

#include <span>
#include <vector>

#include <snug/surface/limit_surface.h>
#include <snug/tessellate.h>

namespace snug {

/// Of a refinement with tolerances of its own for each owner, in mesh units: also a proved error for each triangle.
struct LocalTessellation {
  Tessellation mesh;
  std::vector<double> errors;
};
/// Requires:  finite, positive tolerances, one an owner; none of `options` counts.
[[nodiscard]] LocalTessellation tessellate(const LimitSurface& surface, std::span<const double> tolerances,
                                           const TessellateOptions& options, const Run& run = {});

}  // namespace snug
