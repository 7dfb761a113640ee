#pragma once

#include <snug/distance.h>
#include <snug/search/surface_workspace.h>

/// The questions of distance.h about a surface whose tree and workspace are at hand.
namespace snug {

[[nodiscard]] ClosestPoint closest_point(SurfaceWorkspace& workspace, const Point3& to,
                                         const Precision& options, const Run& run = {});
[[nodiscard]] std::vector<ClosestPoint> closest_point(const SurfaceBvh& model, std::span<const Point3> to,
                                                      const Precision& options, const Run& run = {});

[[nodiscard]] std::optional<bool> contains(SurfaceWorkspace& workspace, const Point3& point,
                                           const Run& run = {});
[[nodiscard]] std::vector<std::optional<bool>> contains(const SurfaceBvh& model,
                                                        std::span<const Point3> points, const Run& run = {});

[[nodiscard]] SignedDistance signed_distance(SurfaceWorkspace& workspace, const Point3& point,
                                             const Precision& options, const Run& run = {});
[[nodiscard]] std::vector<SignedDistance> signed_distance(const SurfaceBvh& model,
                                                          std::span<const Point3> points,
                                                          const Precision& options, const Run& run = {});

}  // namespace snug
