#include <snug/surface/evaluate_curve.h>

#include <snug/geometry/rounding.h>
#include <snug/surface/unscale.h>

namespace snug {

CurveSetPoint evaluate(const CurveSet& curves, EdgeId edge, double t) {
  const PowerOfTwo back = curves.scale().inverse();
  const CurvePiece piece = curves.piece(edge);
  const CurvePoint point = curve_point(piece, t);
  const Point3 scaled = piece.origin + point.point.relative;
  const double error = point.point.error + unit_roundoff * max_abs(scaled - Point3{});
  CurveSetPoint result;
  result.position = require_representable(back.apply(scaled));
  result.error = require_representable(unscaled_up(enlarged(error), back) + underflow_error);
  result.tangent = back.apply(point.tangent);
  if (!is_finite(result.tangent)) require_representable(INFINITY);
  return result;
}

}  // namespace snug
