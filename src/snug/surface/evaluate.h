#pragma once

#include <optional>
#include <span>
#include <vector>

#include <snug/evaluate.h>
#include <snug/geometry/motion.h>
#include <snug/patch/limit_evaluator.h>
#include <snug/patch/patch.h>
#include <snug/surface/piece_name.h>

namespace snug {

/// The place of a parameter of a patch.
///
/// Guarantee: u and v are within 2^-51 of the exact ones; patch_at() finds a patch there, for the other half
///            of the quad where rounding crosses its diagonal.
/// Requires:  surface.has_patch(patch); u, v >= 0 and u + v <= 1, up to a rounding.
[[nodiscard]] Place place_of(const LimitSurface& surface, PatchId patch, TriangleParameter at);
/// The same of a parameter of a piece.
[[nodiscard]] inline Place place_of(const LimitSurface& surface, const PieceName& piece,
                                    TriangleParameter at) {
  return place_of(surface, piece.patch, to_face(piece.path, at));
}

/// The patch that a place lies on.
/// Nothing where there is no such owner, corner or parameter, or no surface.
[[nodiscard]] std::optional<PatchId> patch_at(const LimitSurface& surface, const Place& at);

/// The limit point at a place: evaluate() of evaluate.h.
[[nodiscard]] SurfacePoint evaluate(const LimitSurface& surface, const Place& at);

/// normal_at() of evaluate.h.
/// Requires:  patch_at(surface, at).
[[nodiscard]] std::optional<SurfaceNormal> normal_at(const LimitSurface& surface, const Place& at,
                                                     const Motion& pose = {});

/// Evaluates points of a surface. What was refined for a point is kept for those that follow on the same face,
/// or the same quad of its first split: fast where these come together.
///
/// Guarantee: a result does not depend on earlier ones.
/// Requires:  the surface outlives it.
/// Errors:    those of evaluate().
/// Cost:      that of LimitEvaluator, and 200 ns for each face that is turned to.
class SurfaceEvaluator {
 public:
  explicit SurfaceEvaluator(const LimitSurface& surface)
      : surface_(&surface), back_(surface.scale().inverse()) {}
  [[nodiscard]] SurfacePoint operator()(const Place& at);
  /// Positions of points that lie on one face, or quad of its first split.
  /// Requires:  out.size() == at.size().
  void positions(std::span<const Place> at, std::span<BoundedPoint> out);

 private:
  void turn_to(const Place& at);

  const LimitSurface* surface_;
  PowerOfTwo back_;
  std::optional<PatchId> last_;  // of which patch, or the quad that begins with it, the evaluator is
  std::uint32_t owner_ = 0, corner_ = 0;
  Patch patch_;
  LimitEvaluator evaluator_;
};

/// evaluate() of evaluate.h, for many points.
[[nodiscard]] std::vector<SurfacePoint> evaluate(const LimitSurface& surface, std::span<const Place> at,
                                                 int threads);
double evaluate(const LimitSurface& surface, std::span<const Place> at, const FloatPoints& out, int threads);

/// Evaluates points of one patch at its own parameters, with derivatives along its u and v; u, v >= 0 and u + v
/// <= 1. InputError (value) for a patch that is not there and a parameter that is not on it, NaN included.
class PatchEvaluator {
 public:
  PatchEvaluator(const LimitSurface& surface, PatchId p);
  [[nodiscard]] SurfacePoint operator()(TriangleParameter at) const;

 private:
  Patch patch_;
  PowerOfTwo back_;
};

}  // namespace snug
