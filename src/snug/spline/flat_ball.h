#pragma once

#include <snug/spline/tensor_piece.h>

namespace snug {

/// A ball around an extraordinary vertex in which faces may be flat: the surface is bent into the tangent plane, in a way that depends on its
/// points alone. So faces around the vertex are bent alike.
struct FlatBall {
  /// Share of the radius within which the surface becomes the plane itself.
  static constexpr double inner = 0.15;

  Vector3 center, normal;
  double radius = 0;

  /// Bends the point; derivatives likewise.
  void apply(CornerJet& jet) const;
};

}  // namespace snug
