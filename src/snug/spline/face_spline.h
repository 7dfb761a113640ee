#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include <snug/brep.h>
#include <snug/spline/tensor_piece.h>

namespace snug {

/// A polynomial over a part of a face's parameters.
struct FacePart {
  ParameterBox box;
  TensorPiece piece;  ///< on [0, 1]^2 of the box, relative to the origin
  Point3 origin;
  bool tip;  ///< joins with continuous first derivatives alone
  double
      distance;  ///< of the surface from the polynomial at most, parameter by parameter; beside the polynomial's own error
};

/// The B-spline surface of parts that cover a rectangle from (0, 0) and join smoothly. Knots are where parts end.
/// Requires:  parts of one degree; `natural`: of the scheme, which may be less.
[[nodiscard]] SplineSurface spline_of(std::span<const FacePart> parts, std::size_t natural);
/// Upper bound of the distance of the surface that the parts stand for from a B-spline surface, parameter by parameter, rounding
/// included.
/// Requires:  the spline's parameters cover those of the parts, and its degree is theirs.
[[nodiscard]] double distance_bound(std::span<const FacePart> parts, const SplineSurface& spline);

/// The border of a surface from corner k of its parameters to the next one; parameters rise from 0.
[[nodiscard]] SplineCurve side_of(const SplineSurface& surface, std::size_t k);
/// A part of a curve; parameters rise from 0.
[[nodiscard]] SplineCurve part_of(const SplineCurve& curve, double begin, double end);
[[nodiscard]] SplineCurve reversed(const SplineCurve& curve);
/// Upper bound of their distance over the parameters of `a`, rounding included.
/// Requires:  `b` has them, too; differences of knots are exact.
[[nodiscard]] double distance_bound(const SplineCurve& a, const SplineCurve& b);
/// The distinct knots.
[[nodiscard]] std::vector<double> breaks_of(const std::vector<double>& knots);

/// Point and normal, of length 1, of a surface at its parameters, in double precision; no normal where it vanishes.
struct SplineFrame {
  Point3 point;
  std::optional<Vector3> normal;
};
[[nodiscard]] SplineFrame frame_at(const SplineSurface& surface, double u, double v);

}  // namespace snug
