#include <snug/surface/evaluate.h>

#include <algorithm>

#include <snug/base/error.h>
#include <snug/geometry/direction.h>
#include <snug/geometry/rounding.h>
#include <snug/patch/evaluate.h>
#include <snug/surface/unscale.h>

namespace snug {

PatchEvaluator::PatchEvaluator(const LimitSurface& surface, PatchId p)
    : patch_(surface.patch(p)), back_(surface.scale().inverse()), triangular_(surface.rules().triangular()) {}

SurfacePoint PatchEvaluator::operator()(TriangleParameter at) const {
  return placed_frame(limit_frame(patch_, at));
}

SurfacePoint PatchEvaluator::operator()(const SurfaceParameter& at) const {
  return placed_frame(triangular_ ? limit_frame(patch_, TriangleParameter{at.u, at.v})
                                  : limit_frame(patch_, QuadParameter{at.u, at.v}));
}

SurfacePoint PatchEvaluator::placed_frame(const LimitFrame& frame) const {
  SurfacePoint result{
      unscaled(frame.point.from(patch_.origin), back_), {}, frame.differentiable, frame.normal, {}};
  for (std::size_t t = 0; t < 2; ++t) {
    result.tangents[t] = require_representable(back_.apply(frame.tangents[t]));
  }
  if (frame.normal && frame.tangent_error) {
    result.normal_error = normal_error(frame.tangents, *frame.tangent_error);
  }
  return result;
}

SurfaceParameter place_of(const LimitSurface& surface, PatchId patch, TriangleParameter at) {
  const auto [owner, part] = surface.place(patch);
  if (surface.rules().triangular()) {
    const double u = std::clamp(at.u, 0.0, 1.0);
    return {owner, 0, u, std::clamp(at.v, 0.0, 1 - u)};
  }
  // Half a quad: from (0,0) by (1,0) to (1,1), or from (1,1) by (0,1) to (0,0).
  const double u = part % 2 == 0 ? at.u + at.v : 1 - at.u - at.v, v = part % 2 == 0 ? at.v : 1 - at.v;
  return {owner, part / 2, std::clamp(u, 0.0, 1.0), std::clamp(v, 0.0, 1.0)};
}

std::optional<PatchId> patch_at(const LimitSurface& surface, const SurfaceParameter& at) {
  const auto [u, v] = QuadParameter{at.u, at.v};
  if (at.owner >= surface.owner_count() || !(u >= 0 && v >= 0 && u <= 1 && v <= 1)) return {};
  const LimitSurface::PatchRange range = surface.patches_of(at.owner);
  std::size_t patch = range.begin;
  if (surface.rules().triangular()) {
    if (!(u + v <= 1) || at.corner != 0) return {};
  } else {
    patch += 2 * std::size_t{at.corner} + part_of(QuadParameter{u, v});
  }
  if (patch >= range.end || !surface.has_patch(PatchId(patch))) return {};
  return PatchId(patch);
}

std::optional<SurfaceNormal> normal_at(const LimitSurface& surface, const SurfaceParameter& at,
                                       const Motion& pose) {
  const SurfacePoint point = evaluate(surface, at);
  if (!point.normal) return std::nullopt;
  SurfaceNormal result{normalized(pose.rotate(*point.normal)), {}};
  // derivations/rounding.md, "Normals".
  const double defect = pose.defect();
  if (point.normal_error) {
    result.error = enlarged((1 + 2 * defect) * *point.normal_error + 8 * defect + 32 * unit_roundoff);
  }
  return result;
}

SurfacePoint evaluate(const LimitSurface& surface, const SurfaceParameter& at) {
  const std::optional<PatchId> patch = patch_at(surface, at);
  require_value(patch.has_value(),
                "evaluate: the surface has no such face, corner or parameter; give one that it has");
  return PatchEvaluator(surface, *patch)(at);
}

CurveSetPoint evaluate(const CurveSet& curves, EdgeId edge, double t) {
  const PowerOfTwo back = curves.scale().inverse();
  const CurvePiece piece = curves.piece(edge);
  const CurvePoint point = curve_point(piece, t);
  return {unscaled(point.point.from(piece.origin), back), require_representable(back.apply(point.tangent))};
}

}  // namespace snug
