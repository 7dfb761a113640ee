#pragma once

#include <span>

#include <snug/scheme/stencils.h>
#include <snug/surface/limit_surface.h>

namespace snug::command {

/// A row for each place: its limit point as a weighted sum of the control points, in double precision.
///
/// Requires:  patch_at(surface, each place).
/// Cost:      that of evaluating each place a third as often as its patch has control points.
[[nodiscard]] Stencils limit_weights(const LimitSurface& surface, std::span<const Place> at,
                                     const WorkMonitor& monitor = {});

}  // namespace snug::command
