#pragma once

#include <snug/surface/limit_surface.h>
#include <snug/tessellate.h>

namespace snug {

/// tessellate() of tessellate.h.
[[nodiscard]] Tessellation tessellate(const LimitSurface& surface, const TessellateOptions& options,
                                      const WorkMonitor& monitor = {});

}  // namespace snug
