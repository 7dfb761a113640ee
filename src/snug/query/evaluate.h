#pragma once

#include <array>
#include <optional>

#include <snug/patch/limit_evaluator.h>
#include <snug/surface/surface.h>

namespace snug {

/// A limit point in mesh units.
struct SurfacePosition {
  Point3 position;
  double error;  ///< upper bound, a coordinate, of |position - exact|, rounding of the coordinates included
};

/// A limit point with what the surface does there.
struct SurfacePoint : SurfacePosition {
  /// Derivatives along u and v where they exist, else two limit tangents of no particular length.
  std::array<Vector3, 2> tangents;
  bool differentiable;
  std::optional<Vector3> normal;  ///< of length 1; absent where there is none
};

/// The limit point of face f at (u, v):  (1 - u - v) c0 + u c1 + v c2 in the control triangle's parameters.
///
/// Guarantee: as SurfacePoint says; tangents and normal are in double precision without a bound.
/// Requires:  surface.has_patch(f); u, v >= 0 and u + v <= 1.
/// Errors:    InputError if a coordinate does not fit a double.
[[nodiscard]] SurfacePoint evaluate(const Surface& surface, FaceId f, TriangleParameter at);

/// Evaluates many points of one face with a single set-up. For one thread.
///
/// Errors:    InputError if a coordinate does not fit a double.
class FaceEvaluator {
 public:
  /// Requires:  surface.has_patch(f).
  FaceEvaluator(const Surface& surface, FaceId f);
  /// As evaluate().
  [[nodiscard]] SurfacePoint operator()(TriangleParameter at) const;
  /// The position alone; keeps the polynomial pieces that it meets.
  /// Cost:      see LimitEvaluator.
  [[nodiscard]] SurfacePosition position(TriangleParameter at);

 private:
  LimitEvaluator evaluator_;
  PowerOfTwo back_;
};

}  // namespace snug
