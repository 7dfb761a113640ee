#include <snug/query/signed_distance.h>

#include <snug/query/containment.h>
#include <snug/search/point_batch.h>
#include <snug/search/solid.h>

namespace snug {

SignedDistance signed_distance(SurfaceWorkspace& scratch, const Point3& point, const ClosestOptions& options,
                               const WorkMonitor& monitor) {
  static_cast<void>(scratch.model().solid());
  SignedDistance answer;
  answer.nearest = closest_point(scratch, point, options, monitor);
  const ClosestPoint& nearest = answer.nearest;
  const std::optional<bool> inside = contains(scratch, point, monitor);
  answer.lower = inside == false ? nearest.lower : -nearest.upper;
  answer.upper = inside == true ? -nearest.lower : nearest.upper;
  answer.reached = nearest.reached && near_enough(answer.lower, answer.upper, options);
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
