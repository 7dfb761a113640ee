#include <snug/query/signed_distance.h>

#include <snug/query/containment.h>
#include <snug/search/point_batch.h>
#include <snug/search/precision.h>
#include <snug/search/solid.h>

namespace snug {

SignedDistance signed_distance(SurfaceWorkspace& scratch, const Point3& point, const ClosestOptions& options,
                               const WorkMonitor& monitor) {
  static_cast<void>(scratch.model().solid());
  SignedDistance answer;
  answer.nearest = closest_point(scratch, point, options, monitor);
  const ClosestPoint& nearest = answer.nearest;
  const std::optional<bool> inside = contains(scratch, point, monitor);
  answer.distance = {inside == false ? nearest.distance.lower : -nearest.distance.upper,
                     inside == true ? -nearest.distance.lower : nearest.distance.upper};
  answer.reached = nearest.reached &&
                   (inside.has_value() ||
                    near_enough(answer.distance, with_precision(options, scratch.model().surface().size())));
  return answer;
}

std::vector<SignedDistance> signed_distances(const SurfaceBvh& model, std::span<const Point3> points,
                                             const ClosestOptions& options, int threads,
                                             const WorkMonitor& monitor) {
  static_cast<void>(model.solid());
  std::vector<SignedDistance> results(points.size());
  for_each_point(model, points, threads, monitor, [&](SurfaceWorkspace& scratch, std::size_t i) {
    results[i] = signed_distance(scratch, points[i], options, monitor);
  });
  return results;
}

}  // namespace snug
