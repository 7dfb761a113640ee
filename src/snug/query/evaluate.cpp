#include <snug/query/evaluate.h>

#include <algorithm>

#include <snug/base/error.h>
#include <snug/base/rounding.h>
#include <snug/patch/evaluate.h>
#include <snug/patch/quad_parameter.h>
#include <snug/surface/unscale.h>

namespace snug {

namespace {

SurfacePosition placed(const LimitPoint& point, const Point3& origin, PowerOfTwo back) {
  const Point3 scaled = origin + point.relative;
  const double error = point.error + unit_roundoff * max_abs(scaled - Point3{});
  return {require_representable(back.apply(scaled)), unscaled_up(enlarged(error), back) + underflow_error};
}

}  // namespace

PatchEvaluator::PatchEvaluator(const Surface& surface, PatchId p)
    : evaluator_(surface.patch(p)),
      back_(surface.scale().inverse()),
      loop_(surface.options().scheme == Scheme::loop) {}

SurfacePosition PatchEvaluator::position(TriangleParameter at) {
  const LimitPoint point = evaluator_(at);
  return placed(point, evaluator_.patch().origin, back_);
}

SurfacePoint PatchEvaluator::operator()(TriangleParameter at) const {
  return placed_frame(limit_frame(evaluator_.patch(), at));
}

SurfacePoint PatchEvaluator::operator()(const SurfaceParameter& at) const {
  return placed_frame(loop_ ? limit_frame(evaluator_.patch(), TriangleParameter{at.u, at.v})
                            : limit_frame(evaluator_.patch(), QuadParameter{at.u, at.v}));
}

SurfacePoint PatchEvaluator::placed_frame(const LimitFrame& frame) const {
  SurfacePoint result;
  static_cast<SurfacePosition&>(result) = placed(frame.point, evaluator_.patch().origin, back_);
  for (std::size_t t = 0; t < 2; ++t) {
    result.tangents[t] = back_.apply(frame.tangents[t]);
    if (!is_finite(result.tangents[t])) require_representable(INFINITY);
  }
  result.differentiable = frame.differentiable;
  result.normal = frame.normal;
  return result;
}

std::optional<PatchId> patch_at(const Surface& surface, const SurfaceParameter& at) {
  const auto [u, v] = QuadParameter{at.u, at.v};
  if (at.owner >= surface.owner_count() || !(u >= 0 && v >= 0 && u <= 1 && v <= 1)) return {};
  const Surface::PatchRange range = surface.patches_of(at.owner);
  std::size_t patch = range.begin;
  if (surface.options().scheme == Scheme::loop) {
    if (!(u + v <= 1) || at.corner != 0) return {};
  } else {
    patch += 2 * std::size_t{at.corner} + part_of(QuadParameter{u, v});
  }
  if (patch >= range.end || !surface.has_patch(PatchId(patch))) return {};
  return PatchId(patch);
}

SurfacePoint evaluate(const Surface& surface, const SurfaceParameter& at) {
  const std::optional<PatchId> patch = patch_at(surface, at);
  require_value(patch.has_value(),
                "evaluate: there is no limit surface at this place; patch_at() tells where there is one");
  return PatchEvaluator(surface, *patch)(at);
}

}  // namespace snug
