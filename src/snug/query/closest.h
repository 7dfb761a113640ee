#pragma once

#include <snug/closest.h>
#include <snug/search/surface_workspace.h>

/// The questions of closest.h about a surface whose tree and workspace are at hand.
namespace snug {

[[nodiscard]] ClosestPoint closest_point(SurfaceWorkspace& workspace, const Point3& to,
                                         const ClosestOptions& options, const WorkMonitor& monitor = {});
[[nodiscard]] std::vector<ClosestPoint> closest_points(const SurfaceBvh& model, std::span<const Point3> to,
                                                       const ClosestOptions& options, int threads = 0,
                                                       const WorkMonitor& monitor = {});

[[nodiscard]] std::optional<bool> contains(SurfaceWorkspace& workspace, const Point3& point,
                                           const WorkMonitor& monitor = {});
[[nodiscard]] std::vector<std::optional<bool>> contains(const SurfaceBvh& model,
                                                        std::span<const Point3> points, int threads = 0,
                                                        const WorkMonitor& monitor = {});

[[nodiscard]] SignedDistance signed_distance(SurfaceWorkspace& workspace, const Point3& point,
                                             const ClosestOptions& options, const WorkMonitor& monitor = {});
[[nodiscard]] std::vector<SignedDistance> signed_distances(const SurfaceBvh& model,
                                                           std::span<const Point3> points,
                                                           const ClosestOptions& options, int threads = 0,
                                                           const WorkMonitor& monitor = {});

}  // namespace snug
