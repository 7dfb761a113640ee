#pragma once

#include <span>
#include <vector>

#include <snug/query/closest.h>

namespace snug {

/// How far a point is from a closed limit surface, negative in the solid that it bounds, in mesh units.
struct SignedDistance {
  double lower = 0, upper = 0;  ///< bounds; 0 lies between them where inside and outside cannot be told apart
  bool reached = false;         ///< are they as near as was asked for, with a sign that is proved?
  ClosestPoint nearest;
};

/// The signed distance of a point. The sign is that of the winding number, never that of a normal.
///
/// Guarantee: lower <= signed distance <= upper, also where precision is not reached. The result depends on the input alone.
/// Errors:    those of closest_point(), and of SurfaceBvh::solid() for a surface that is not closed, wherever the point is.
/// Cost:      those of closest_point() and winding_number().
[[nodiscard]] SignedDistance signed_distance(SurfaceWorkspace& scratch, const Point3& point,
                                             const ClosestOptions& options, const WorkMonitor& monitor = {});

/// The same for many points, in their order; results do not depend on threads.
[[nodiscard]] std::vector<SignedDistance> signed_distances(const SurfaceBvh& model,
                                                           std::span<const Point3> points,
                                                           const ClosestOptions& options, int threads = 0,
                                                           const WorkMonitor& monitor = {});

}  // namespace snug
