#pragma once

#include <snug/self.h>
#include <snug/surface/limit_surface.h>

namespace snug {

/// self_contact() of self.h.
[[nodiscard]] SelfContact self_contact(const LimitSurface& surface, const SelfContactOptions& options,
                                       const WorkMonitor& monitor = {});

}  // namespace snug
