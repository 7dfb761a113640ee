#pragma once

#include <oracle/twin_mesh.h>

#include <cstdint>
#include <vector>

namespace oracle {

/// A control polygon; a closed one does not repeat its first vertex. Edge i runs from vertex i to the next.
struct TwinPolyline {
  std::vector<Point> points;
  bool closed = false;
  [[nodiscard]] std::uint32_t edge_count() const {
    return static_cast<std::uint32_t>(closed ? points.size() : points.size() - 1);
  }
};

/// A point of the limit curve at parameter t of an edge.
///
/// Guarantee: no coordinate of `position` is further than `error` from the exact limit point, the rounding to
///            double included.
struct CurveSample {
  std::uint32_t edge;
  double t;
  Point position;
  double error;
};

/// By the polynomials of the uniform B-spline's segments in powers of t, in 113-bit floating point; open ends
/// by reflected neighbours. For degree 2 the knots lie in the middles of edges.
///
/// Requires:  degree 2 or 3; an edge of the polyline, which has two points or is closed; 0 <= t <= 1.
/// Errors:    std::invalid_argument.
/// Source:    [DeBoor01, ch. IX].
[[nodiscard]] CurveSample curve_at(const TwinPolyline& polyline, int degree, std::uint32_t edge, double t);

/// By plain subdivision: doubling and averaging `degree` times where the polyline is closed
/// [LaneRiesenfeld80]; corner cutting and the cubic masks, with ends that stay, where it is open. Then the
/// limit stencils. No reflected neighbours, no polynomials: a second way to the same points.
///
/// Guarantee: limit points of the vertices after `levels` steps, but for degree 2 those near an open end that
///            are not evenly spaced in the parameter.
/// Requires:  0 <= levels <= 12.
[[nodiscard]] std::vector<CurveSample> subdivided_curve(const TwinPolyline& polyline, int degree, int levels);

}  // namespace oracle
