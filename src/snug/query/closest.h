#pragma once

#include <snug/distance.h>
#include <snug/search/surface_workspace.h>

/// Questions of distance.h about a surface whose workspace is at hand.
namespace snug {

[[nodiscard]] ClosestPoint closest_point(SurfaceWorkspace& workspace, const Point3& to,
                                         const Precision& options, const Run& run = {});
[[nodiscard]] std::optional<bool> contains(SurfaceWorkspace& workspace, const Point3& point,
                                           const Run& run = {});
[[nodiscard]] SignedDistance signed_distance(SurfaceWorkspace& workspace, const Point3& point,
                                             const Precision& options, const Run& run = {});

}  // namespace snug
