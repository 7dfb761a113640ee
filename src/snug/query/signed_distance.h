#pragma once

#include <snug/query/closest.h>

namespace snug {

/// signed_distance() of a surface whose tree and workspace are at hand.
[[nodiscard]] SignedDistance signed_distance(SurfaceWorkspace& scratch, const Point3& point,
                                             const ClosestOptions& options, const WorkMonitor& monitor = {});
[[nodiscard]] std::vector<SignedDistance> signed_distances(const SurfaceBvh& model,
                                                           std::span<const Point3> points,
                                                           const ClosestOptions& options, int threads = 0,
                                                           const WorkMonitor& monitor = {});

}  // namespace snug
