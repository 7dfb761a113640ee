#pragma once

#include <array>
#include <optional>

#include <snug/evaluate.h>
#include <snug/geometry/motion.h>
#include <snug/patch/patch.h>
#include <snug/surface/curve_set.h>
#include <snug/surface/limit_surface.h>

namespace snug {

/// The place of a parameter of a patch.
///
/// Guarantee: u and v are within 2^-51 of the exact ones; patch_at() finds a patch there, for the other half
///            of the quad where rounding crosses its diagonal.
/// Requires:  surface.has_patch(patch); u, v >= 0 and u + v <= 1, up to a rounding.
[[nodiscard]] SurfaceParameter place_of(const LimitSurface& surface, PatchId patch, TriangleParameter at);

/// The patch that a place lies on.
/// Nothing where there is no such owner, corner or parameter, or no surface.
[[nodiscard]] std::optional<PatchId> patch_at(const LimitSurface& surface, const SurfaceParameter& at);

/// The limit point at a place: evaluate() of evaluate.h.
[[nodiscard]] SurfacePoint evaluate(const LimitSurface& surface, const SurfaceParameter& at);

/// normal_at() of evaluate.h.
/// Requires:  patch_at(surface, at).
[[nodiscard]] std::optional<SurfaceNormal> normal_at(const LimitSurface& surface, const SurfaceParameter& at,
                                                     const Motion& pose = {});

/// Evaluates many points of one patch with a single set-up. InputError (value) for a patch that is not there
/// and a parameter that is not on it, NaN included.
class PatchEvaluator {
 public:
  PatchEvaluator(const LimitSurface& surface, PatchId p);
  /// The point at a place of its owner that lies on this patch.
  [[nodiscard]] SurfacePoint operator()(const SurfaceParameter& at) const;
  /// The point at a parameter of the patch, with derivatives along its own u and v; u, v >= 0 and u + v <= 1.
  [[nodiscard]] SurfacePoint operator()(TriangleParameter at) const;

 private:
  [[nodiscard]] SurfacePoint placed_frame(const LimitFrame& frame) const;

  Patch patch_;
  PowerOfTwo back_;
  bool triangular_;
};

/// A limit point of a curve in mesh units, and the derivative there along t.
struct CurveSetPoint : BoundedPoint {
  Vector3 tangent;  ///< in double precision without a bound; 0 where the curve has none
};

/// The limit point of an edge at exactly this t: 0 at the limit of its first vertex, 1 at that of the second.
/// InputError (value) unless edge < curves.edge_count() and 0 <= t <= 1.
[[nodiscard]] CurveSetPoint evaluate(const CurveSet& curves, EdgeId edge, double t);

}  // namespace snug
