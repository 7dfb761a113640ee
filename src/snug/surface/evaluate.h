#pragma once

#include <array>
#include <optional>

#include <snug/geometry/motion.h>
#include <snug/patch/limit_evaluator.h>
#include <snug/surface/curve_set.h>
#include <snug/surface/limit_surface.h>

namespace snug {

/// A limit point in mesh units, with what the surface does there.
struct SurfacePoint : BoundedPoint {
  /// Derivatives along u and v where they exist, else two limit tangents of no particular length.
  std::array<Vector3, 2> tangents;
  bool differentiable;
  std::optional<Vector3> normal;  ///< of length 1; absent where there is none
  /// Upper bound of the length of normal - exact normal, where one is proved.
  std::optional<double> normal_error;
};

/// A place on the surface as people name it. Triangular schemes: (u, v) is (1 - u - v) c0 + u c1 + v c2 of a face. Else it
/// is a place on a quad, from corner 0 with u towards corner 1: of the owner if that is one (of a dual scheme: the faces
/// around the vertex, from topology().leaving() on), else of the quad that its first split makes at `corner`, from there
/// with u along the edge that follows.
struct SurfaceParameter {
  std::uint32_t owner;  ///< face, or vertex of a dual scheme
  std::uint32_t corner = 0;
  double u = 0, v = 0;
};

/// The place of a parameter of a patch.
///
/// Guarantee: u and v are within 2^-51 of the exact ones; patch_at() finds a patch there, for the other half of the quad where
///            rounding crosses its diagonal.
/// Requires:  surface.has_patch(patch); u, v >= 0 and u + v <= 1, up to a rounding.
[[nodiscard]] SurfaceParameter place_of(const LimitSurface& surface, PatchId patch, TriangleParameter at);

/// The patch that a place lies on.
/// Errors:    nothing where there is no such owner, corner or parameter, or no surface.
[[nodiscard]] std::optional<PatchId> patch_at(const LimitSurface& surface, const SurfaceParameter& at);

/// The limit point at a place, with derivatives along its u and v.
///
/// Guarantee: as SurfacePoint says; tangents and normal are in double precision without a bound.
/// Errors:    InputError (value) where patch_at() has nothing, NaN included; (unrepresentable) if a coordinate does not fit a
///            double.
[[nodiscard]] SurfacePoint evaluate(const LimitSurface& surface, const SurfaceParameter& at);

/// A unit normal, and how far it is from the exact one.
struct SurfaceNormal {
  Vector3 direction;
  std::optional<double>
      error;  ///< upper bound of the length of direction - exact normal, where one is proved
};
/// The normal of a surface where a motion places it, at exactly this place; nothing where there is none.
///
/// Requires:  patch_at(surface, at).
/// Errors:    InputError if the limit point does not fit a double.
/// Cost:      that of evaluate(), about a microsecond.
[[nodiscard]] std::optional<SurfaceNormal> normal_at(const LimitSurface& surface, const SurfaceParameter& at,
                                                     const Motion& pose = {});

/// Evaluates many points of one patch with a single set-up. For one thread.
///
/// Errors:    InputError (value) for a patch that is not there and a parameter that is not on it, NaN included;
///            (unrepresentable) if a coordinate does not fit a double.
class PatchEvaluator {
 public:
  PatchEvaluator(const LimitSurface& surface, PatchId p);
  /// The point at a place of its owner that lies on this patch.
  [[nodiscard]] SurfacePoint operator()(const SurfaceParameter& at) const;
  /// The point at a parameter of the patch, with derivatives along its own u and v.
  /// u, v >= 0 and u + v <= 1.
  [[nodiscard]] SurfacePoint operator()(TriangleParameter at) const;
  /// The position alone, in mesh units; keeps the polynomial pieces that it meets.
  /// Cost:      see LimitEvaluator.
  [[nodiscard]] BoundedPoint position(TriangleParameter at);

 private:
  [[nodiscard]] SurfacePoint placed_frame(const LimitFrame& frame) const;

  LimitEvaluator evaluator_;
  PowerOfTwo back_;
  bool triangular_;
};

/// A limit point of a curve in mesh units, and the derivative there along t.
struct CurveSetPoint : BoundedPoint {
  Vector3 tangent;  ///< in double precision without a bound; 0 where the curve has none
};

/// The limit point of an edge at t: 0 at the limit of its first vertex, 1 at that of the second.
///
/// Guarantee: as CurveSetPoint says, for exactly this t.
/// Errors:    InputError (value) unless edge < curves.edge_count() and 0 <= t <= 1; (unrepresentable) if a coordinate does
///            not fit a double.
[[nodiscard]] CurveSetPoint evaluate(const CurveSet& curves, EdgeId edge, double t);

}  // namespace snug
