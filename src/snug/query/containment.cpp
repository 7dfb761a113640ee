#include <snug/query/containment.h>

#include <snug/base/error.h>
#include <snug/base/rounding.h>
#include <snug/patch/evaluate.h>
#include <snug/query/pair_search.h>
#include <snug/query/solid.h>
#include <snug/query/winding.h>
#include <snug/surface/unscale.h>

namespace snug {
namespace {

// Points farther from a surface than this, in sizes of it, are outside without a look.
constexpr double farthest_point = 0x1p40;

// A limit point of a component.
struct Sample {
  Point3 local;
  double error;
};

Sample sample_of(const Surface& surface, PatchId p) {
  const Patch patch = surface.patch(p);
  const LimitPoint corner = corner_point(patch, 0);
  const Point3 local = patch.origin + corner.relative;
  return {local, corner.error + unit_roundoff * max_abs(local - Point3{})};
}

// Is a placed point certainly outside of the ball around a placed model?
bool beyond(const PlacedFrame& frame, const Ball& ball, const Point3& placed, double error) {
  const Point3 centre = frame.apply(ball.centre);
  const double between = distance(placed, centre) * (1 - 8 * unit_roundoff);
  return between >
         enlarged(frame.growth() * ball.radius + spatial_error(error + frame.apply_error(ball.centre)));
}

}  // namespace

Nesting nesting(const PlacedModel& a, const PlacedModel& b, const WorkMonitor& monitor) {
  const std::array<const PlacedModel*, 2> side{&a, &b};
  PairSearch search(a, b);
  Nesting found;
  for (std::size_t s = 0; s < 2; ++s) {
    const PlacedModel& other = *side[1 - s];
    static_cast<void>(other.model.solid());
    const PlacedFrame& frame = search.frame(s);
    for (const PatchId p : side[s]->model.solid().components()) {
      const Sample sample = sample_of(side[s]->model.surface(), p);
      const Point3 placed = frame.apply(sample.local);
      const double error =
          enlarged(frame.growth() * spatial_error(sample.error)) + frame.apply_error(sample.local);
      if (beyond(search.frame(1 - s), other.model.tree().ball(), placed, error)) continue;
      const RelativeFrame& seen = search.seen_from(1 - s);
      std::optional<int> number;
      if (seen.comparable) {
        number = winding_number(other.scratch, seen.apply(sample.local),
                                enlarged(2 * seen.scale * spatial_error(sample.error)) + seen.slack, monitor);
      }
      found.certain = found.certain && number.has_value();
      if (number.value_or(0) == 0) continue;
      found.inner = s;
      found.point = require_representable(search.to_mesh_units().apply(placed));
      found.error = unscaled_up(error, search.to_mesh_units()) + underflow_error;
      return found;
    }
  }
  return found;
}

std::optional<bool> contains(QueryScratch& scratch, const Point3& point, const WorkMonitor& monitor) {
  if (!is_finite(point)) {
    throw InputError(InputProblem::value,
                     "contains: a coordinate of the point is not finite; give three numbers");
  }
  const PowerOfTwo scale = scratch.model().surface().scale();
  static_cast<void>(scratch.model().solid());
  scratch.begin();
  const Point3 scaled = scale.apply(point);
  if (!(max_abs(scaled - Point3{}) <= farthest_point)) return false;
  const bool exact = scale.exact(point.x) && scale.exact(point.y) && scale.exact(point.z);
  const std::optional<int> number =
      winding_number(scratch, scaled, exact ? 0 : spatial_error(2 * underflow_error), monitor);
  if (!number) return std::nullopt;
  return *number != 0;
}

}  // namespace snug
