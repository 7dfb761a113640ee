#pragma once

#include <span>
#include <vector>

#include <snug/search/precision.h>
#include <snug/search/workspace.h>
#include <snug/surface/evaluate.h>

namespace snug {

/// The budget is for each point.
using ClosestOptions = DistanceOptions;

/// A limit point near the closest one, in mesh units.
struct ClosestPoint {
  double lower = 0, upper = 0;  ///< bounds of the distance of the surface; the point is at most `upper` away
  bool reached = false;         ///< are they as near as was asked for?
  Point3 point;
  double point_error = 0;  ///< upper bound, a coordinate, of how far `point` is from the limit point at `at`
  SurfaceParameter at;     ///< where it lies on the surface, rounded to doubles
};

/// The point of a limit surface that is closest to another one.
///
/// Guarantee: lower <= distance <= upper, and there is a limit point at a distance of at most `upper`, also where precision
///            is not reached. The result depends on the input alone.
/// Errors:    InputError (value) for a point that is not finite or more than 10^12 sizes of the surface away, and for a
///            precision that is negative or not finite; (unrepresentable) for a result that does not fit a double.
/// Cost:      some 10 microseconds at 0.1 % of the size, some 100 at 1e-9 (bench/results/distance.txt).
[[nodiscard]] ClosestPoint closest_point(SurfaceWorkspace& workspace, const Point3& to,
                                         const ClosestOptions& options, const WorkMonitor& monitor = {});

/// The same for many points, in their order; results do not depend on threads.
[[nodiscard]] std::vector<ClosestPoint> closest_points(const SurfaceBvh& model, std::span<const Point3> to,
                                                       const ClosestOptions& options, int threads = 0,
                                                       const WorkMonitor& monitor = {});

}  // namespace snug
