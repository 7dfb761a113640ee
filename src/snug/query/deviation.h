#pragma once

#include <span>

#include <snug/distance.h>
#include <snug/search/surface_bvh.h>

/// The deviations of distance.h about surfaces whose trees are at hand.
namespace snug {

[[nodiscard]] Deviation deviation(const SurfaceBvh& surface, std::span<const Triangle> candidate,
                                  const DeviationOptions& options, const Run& run = {});
[[nodiscard]] Deviation deviation(const SurfaceBvh& surface, const SurfaceBvh& candidate,
                                  const DeviationOptions& options, const Run& run = {});

}  // namespace snug
