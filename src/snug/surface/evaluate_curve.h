#pragma once

#include <snug/surface/curve_set.h>
#include <snug/surface/evaluate.h>

namespace snug {

/// A limit point of a curve in mesh units, and the derivative there along t.
struct CurveSetPoint : SurfacePosition {
  Vector3 tangent;  ///< in double precision without a bound; 0 where the curve has none
};

/// The limit point of an edge at t: 0 at the limit of its first vertex, 1 at that of the second.
///
/// Guarantee: |position - exact| <= error a coordinate, for exactly this t.
/// Errors:    InputError (value) unless edge < curves.edge_count() and 0 <= t <= 1; (unrepresentable) if a coordinate does
///            not fit a double.
[[nodiscard]] CurveSetPoint evaluate(const CurveSet& curves, EdgeId edge, double t);

}  // namespace snug
