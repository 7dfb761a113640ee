#include <snug/query/signed_distance.h>

#include <atomic>

#include <snug/base/parallel.h>
#include <snug/query/containment.h>
#include <snug/query/solid.h>
#include <snug/query/spatial_order.h>

namespace snug {

SignedDistance signed_distance(QueryScratch& scratch, const Point3& point, const ClosestOptions& options,
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

std::vector<SignedDistance> signed_distances(const QueryModel& model, std::span<const Point3> points,
                                             const ClosestOptions& options, int threads,
                                             const WorkMonitor& monitor) {
  static_cast<void>(model.solid());
  std::vector<SignedDistance> results(points.size());
  std::atomic<std::size_t> done{0};
  const std::vector<std::uint32_t> order = spatial_order(points);
  parallel_for_with(
      points.size(), threads, [&] { return QueryScratch(model); },
      [&](QueryScratch& scratch, std::size_t begin, std::size_t end) {
        for (const std::uint32_t i : std::span(order).subspan(begin, end - begin)) {
          results[i] = signed_distance(scratch, points[i], options, monitor);
          const std::size_t count = ++done;
          if (count % (1 + points.size() / 1000) == 0) {
            monitor.report(static_cast<double>(count) / static_cast<double>(points.size()));
          }
        }
      });
  return results;
}

}  // namespace snug
