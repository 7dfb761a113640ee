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
  bool tip;  ///< joins with continuous first derivatives only
  double
      distance;  ///< upper bound of that to the surface, parameter by parameter, beside the error of `piece`
};

/// The B-spline surface that consists of these parts, with knots where they end.
/// Requires:  parts that join smoothly and cover a rectangle from (0, 0), all of one degree; `natural` is that of the scheme, which
///            may be less.
[[nodiscard]] SplineSurface spline_of(std::span<const FacePart> parts, std::size_t natural);
/// Upper bound of the distance between a B-spline surface and the limit surface that the parts describe, parameter by parameter,
/// rounding included.
/// Requires:  the same degree; parameters of the parts are parameters of `spline`.
[[nodiscard]] double distance_bound(std::span<const FacePart> parts, const SplineSurface& spline);

/// The border of a surface from corner k of its parameters to the next one; parameters rise from 0.
[[nodiscard]] SplineCurve side_of(const SplineSurface& surface, std::size_t k);
/// A part of a curve; parameters rise from 0.
[[nodiscard]] SplineCurve part_of(const SplineCurve& curve, double begin, double end);
[[nodiscard]] SplineCurve reversed(const SplineCurve& curve);
/// Upper bound of their distance over the parameters of `a`, rounding included.
/// Requires:  `b` has them, too; differences of knots are exact.
[[nodiscard]] double distance_bound(const SplineCurve& a, const SplineCurve& b);

/// The diagonal of a surface over a unit square, from (0, 0) to (1, 1), as a curve of the surface's degree, if it is one.
/// Requires:  degree 1 or 3, the same knots in u and v, of degree 3 twice each.
[[nodiscard]] SplineCurve diagonal_of(const SplineSurface& surface);
/// Upper bound of the distance between a curve and the diagonal of such a surface, at equal parameters, rounding included.
/// Requires:  the same degree, and parameters from 0 to 1; knots may differ.
[[nodiscard]] double distance_from_diagonal(const SplineSurface& surface, const SplineCurve& curve);
/// The distinct knots.
[[nodiscard]] std::vector<double> breaks_of(const std::vector<double>& knots);

/// Point and normal, of length 1, of a surface at its parameters, in double precision; no normal where it vanishes.
struct SplineFrame {
  Point3 point;
  std::optional<Vector3> normal;
};
[[nodiscard]] SplineFrame frame_at(const SplineSurface& surface, double u, double v);

}  // namespace snug
