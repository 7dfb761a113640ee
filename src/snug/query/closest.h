#pragma once

#include <snug/closest.h>
#include <snug/search/workspace.h>

namespace snug {

/// closest_point() of a surface whose tree and workspace are at hand.
[[nodiscard]] ClosestPoint closest_point(SurfaceWorkspace& workspace, const Point3& to,
                                         const ClosestOptions& options, const WorkMonitor& monitor = {});
[[nodiscard]] std::vector<ClosestPoint> closest_points(const SurfaceBvh& model, std::span<const Point3> to,
                                                       const ClosestOptions& options, int threads = 0,
                                                       const WorkMonitor& monitor = {});

}  // namespace snug
