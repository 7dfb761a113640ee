#pragma once

#include <span>
#include <vector>

#include <snug/ray.h>
#include <snug/search/surface_workspace.h>

/// The questions of ray.h about a surface whose tree and workspace are at hand.
namespace snug {

/// Throws InputError (value) unless these are a ray.
void require_ray(const Ray& ray);

[[nodiscard]] RayHits ray(SurfaceWorkspace& workspace, const Ray& ray, const RayOptions& options,
                          const Run& run = {});
[[nodiscard]] std::vector<RayHits> ray(const SurfaceBvh& model, std::span<const Ray> rays,
                                       const RayOptions& options, const Run& run = {});

}  // namespace snug
