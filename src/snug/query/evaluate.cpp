#include <snug/query/evaluate.h>

#include <algorithm>

#include <snug/base/rounding.h>
#include <snug/patch/evaluate.h>
#include <snug/surface/unscale.h>

namespace snug {

namespace {

SurfacePosition placed(const LimitPoint& point, const Point3& origin, PowerOfTwo back) {
  const Point3 scaled = origin + point.relative;
  const double error = point.error + unit_roundoff * max_abs(scaled - Point3{});
  return {require_representable(back.apply(scaled)), unscaled_up(enlarged(error), back) + underflow_error};
}

}  // namespace

FaceEvaluator::FaceEvaluator(const Surface& surface, FaceId f)
    : evaluator_(surface.patch(f)), back_(surface.scale().inverse()) {}

SurfacePosition FaceEvaluator::position(TriangleParameter at) {
  const LimitPoint point = evaluator_(at);
  return placed(point, evaluator_.patch().origin, back_);
}

SurfacePoint FaceEvaluator::operator()(TriangleParameter at) const {
  const LimitFrame frame = limit_frame(evaluator_.patch(), at);
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

SurfacePoint evaluate(const Surface& surface, FaceId f, TriangleParameter at) {
  return FaceEvaluator(surface, f)(at);
}

}  // namespace snug
