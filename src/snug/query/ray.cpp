#include <snug/query/ray.h>
#include <snug/search/workspace.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>

#include <snug/certificate/certify.h>
#include <snug/geometry/rounding.h>
#include <snug/search/precision.h>
#include <snug/search/ray_scale.h>
#include <snug/search/ray_walk.h>
#include <snug/surface/evaluate.h>
#include <snug/surface/unscale.h>
#include <support/direction.h>
#include <support/error.h>
#include <support/run.h>

namespace snug {
namespace {

// A rounding more or less on a number of some roundings.
double lowered(double x) {
  return std::isfinite(x) ? x - (16 * unit_roundoff * std::fabs(x) + underflow_error) : x;
}
double raised(double x) { return -lowered(-x); }

}  // namespace

void require_ray(const Ray& ray) {
  require_value(is_finite(ray.origin), "ray: a coordinate of the origin is not finite; give three numbers");
  require_value(is_finite(ray.direction) && !(ray.direction == Vector3{}),
                "ray: the direction must be three finite numbers, not all 0");
  require_value(ray.from <= ray.to && std::isfinite(ray.from),
                "ray: 'from' must be finite and not above 'to'");
}

namespace {

class RaySearch {
 public:
  RaySearch(const LimitSurface& surface, const RayOptions& options, const Run& run)
      : surface_(surface),
        options_(options),
        monitor_(monitor_of(run)),
        max_splits_(run.max_splits.value_or(default_splits::ray)) {
    const double precision = options.absolute.value_or(share_of_size(1e-6, surface.size()));
    require_length(precision, "the precision of rays");
    precision_ = surface.scale().apply(precision);
  }

  // Answers some rays, at most rays_at_once; `found` keeps its memory from one call to the next.
  void ask(PieceCache& workspace, SurfaceEvaluator& evaluator, std::span<const Ray> rays,
           std::array<FoundHits, rays_at_once>& found, std::span<RayHits> answers) const {
    std::vector<RayTask> tasks;
    tasks.reserve(rays.size());
    for (const Ray& ray : rays) tasks.push_back(task_of(ray));
    walk_rays(workspace, tasks, monitor_, std::span(found).first(rays.size()));
    for (std::size_t i = 0; i < rays.size(); ++i)
      answers[i] = finished(found[i], tasks[i], rays[i], evaluator);
  }

 private:
  [[nodiscard]] RayTask task_of(const Ray& ray) const {
    require_ray(ray);
    const RayScale lengths(ray.direction, surface_.scale());
    const Point3 origin = surface_.scale().apply(ray.origin);
    require_value(max_abs(origin - Point3{}) <= 0x1p40,
                  "ray: an origin is more than 10^12 sizes of the surface away; give one that is closer");
    const double from = lengths.to_scaled(ray.from), to = lengths.to_scaled(ray.to);
    return {origin,
            lengths.unit(ray.direction),
            {ray.from == 0 ? 0 : lowered(from), raised(to)},
            {ray.from == 0 ? 0 : raised(from), lowered(to)},
            options_.query,
            precision_,
            max_splits_};
  }

  [[nodiscard]] RayHits finished(const FoundHits& found, const RayTask& task, const Ray& ray,
                                 SurfaceEvaluator& evaluator) const {
    RayHits answer;
    bool narrow = true;
    for (const FoundHit& hit : found.hits) narrow = narrow && (hit.reached || !hit.certified);
    answer.outcome =
        outcome_of(found.complete && (narrow || options_.query == RayQuery::any), !found.complete);
    if (found.hits.empty()) return answer;
    const RayScale lengths(ray.direction, surface_.scale());
    answer.hits.reserve(found.hits.size());
    for (const FoundHit& hit : found.hits) answer.hits.push_back(finished(hit, task, lengths, evaluator));
    return answer;
  }

  [[nodiscard]] RayHit finished(const FoundHit& found, const RayTask& ray, const RayScale& lengths,
                                SurfaceEvaluator& evaluator) const {
    RayHit hit;
    hit.t = {require_representable(lowered(lengths.to_parameter(found.along.lower))),
             require_representable(raised(lengths.to_parameter(found.along.upper)))};
    hit.certified = found.certified;
    hit.side = found.side;
    const double half = (found.along.upper - found.along.lower) / 2, middle = found.along.lower + half;
    const double rounding = 16 * unit_roundoff * (max_abs(ray.origin - Point3{}) + std::fabs(middle) + half);
    const BoundedPoint point = unscaled(
        BoundedPoint{ray.origin + middle * ray.along, enlarged(half) + rounding}, surface_.scale().inverse());
    hit.point = require_representable(point.position);
    hit.error = require_representable(point.error);
    hit.at = place_of(surface_, found.piece, found.at);
    hit.normal = evaluator(*hit.at).normal;
    return hit;
  }

  const LimitSurface& surface_;
  const RayOptions& options_;
  const WorkMonitor& monitor_;
  std::uint64_t max_splits_;
  double precision_;
};

}  // namespace

RayHits ray(const Surface& surface, const Ray& ray, const RayOptions& options, const Run& run) {
  PieceCache& workspace = workspace_of(run).pieces().of(surface);
  SurfaceEvaluator evaluator(workspace.model().surface());
  std::array<FoundHits, rays_at_once> found;
  RayHits answer;
  RaySearch(workspace.model().surface(), options, run)
      .ask(workspace, evaluator, {&ray, 1}, found, {&answer, 1});
  certify(run, surface, {&ray, 1}, options.query, {&answer, 1});
  return answer;
}

std::vector<RayHits> ray(const Surface& surface, std::span<const Ray> rays, const RayOptions& options,
                         const Run& run) {
  const LimitSurface& limit = surface.data()->bvh().surface();
  const RaySearch search(limit, options, run);
  std::vector<RayHits> answers(rays.size());
  // Groups begin with the same rays however many threads there are.
  const std::size_t groups = (rays.size() + rays_at_once - 1) / rays_at_once;
  std::atomic<std::size_t> done{0};
  workers_of(run).for_each_range(groups, [&](Workspace& state, std::size_t begin, std::size_t end) {
    PieceCache& workspace = state.pieces().of(surface);
    SurfaceEvaluator evaluator(limit);
    std::array<FoundHits, rays_at_once> found;
    for (std::size_t i = begin; i < end; ++i) {
      const std::size_t first = i * rays_at_once, count = std::min(rays_at_once, rays.size() - first);
      search.ask(workspace, evaluator, rays.subspan(first, count), found,
                 std::span(answers).subspan(first, count));
    }
    monitor_of(run).report(static_cast<double>(done += end - begin) / static_cast<double>(groups));
  });
  certify(run, surface, rays, options.query, answers);
  return answers;
}

}  // namespace snug
