#pragma once

#include <snug/hull.h>
#include <snug/search/surface_bvh.h>

namespace snug {

/// hulls() of hull.h.
[[nodiscard]] Hulls hulls(const SurfaceBvh& surface, const HullOptions& options,
                          const WorkMonitor& monitor = {});

}  // namespace snug
