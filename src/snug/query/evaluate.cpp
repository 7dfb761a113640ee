#include <snug/query/evaluate.h>

#include <algorithm>

#include <snug/base/rounding.h>
#include <snug/patch/evaluate.h>
#include <snug/surface/unscale.h>

namespace snug {

FaceEvaluator::FaceEvaluator(const Surface& surface, FaceId f)
    : patch_(surface.patch(f)), back_(surface.scale().inverse()) {}

SurfacePoint FaceEvaluator::operator()(TriangleParameter at) const {
  const LimitFrame frame = limit_frame(patch_, at);
  const Point3 scaled = patch_.origin + frame.point.relative;
  SurfacePoint result;
  result.position = require_representable(back_.apply(scaled));
  const double placed = frame.point.error + unit_roundoff * max_abs(scaled - Point3{});
  result.error = unscaled_up(enlarged(placed), back_) + underflow_error;
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
