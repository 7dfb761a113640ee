#pragma once

#include <span>
#include <vector>

#include <snug/ray.h>
#include <snug/search/surface_workspace.h>

/// The questions of ray.h about a surface whose tree and workspace are at hand.
namespace snug {

/// Throws InputError (value) unless these are a ray.
void require_ray(const Ray& ray);

[[nodiscard]] RayHits trace(SurfaceWorkspace& workspace, const Ray& ray, const RayOptions& options,
                            const WorkMonitor& monitor = {});
[[nodiscard]] std::vector<RayHits> trace(const SurfaceBvh& model, std::span<const Ray> rays,
                                         const RayOptions& options, int threads = 0,
                                         const WorkMonitor& monitor = {});

}  // namespace snug
