#pragma once

#include <array>
#include <optional>

#include <snug/patch/piece_path.h>
#include <snug/surface/surface.h>

namespace snug {

/// A limit point in mesh units.
struct SurfacePoint {
  Point3 position;
  double error;  ///< upper bound, a coordinate, of |position - exact|, rounding of the coordinates included
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

/// Evaluates many points of one face with a single set-up.
class FaceEvaluator {
 public:
  FaceEvaluator(const Surface& surface, FaceId f);
  [[nodiscard]] SurfacePoint operator()(TriangleParameter at) const;

 private:
  Patch patch_;
  PowerOfTwo back_;
};

}  // namespace snug
