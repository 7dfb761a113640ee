#pragma once

#include <snug/measure.h>
#include <snug/surface/limit_surface.h>

namespace snug {

/// measure() of measure.h.
[[nodiscard]] Measures measure(const LimitSurface& surface, const MeasureOptions& options,
                               const WorkMonitor& monitor = {});

}  // namespace snug
