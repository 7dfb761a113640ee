#pragma once

#include <array>
#include <optional>
#include <span>

#include <snug/patch/evaluate.h>
#include <snug/patch/piece_path.h>
#include <snug/scheme/curve_masks.h>

namespace snug {

/// A piece of a limit curve by its own control points, and the error they carry. Path digits are 0 and 1, the
/// halves. At an open end the neighbour that is not there is a ghost, g = 2 p0 - p1: refinement keeps this
/// relation.
struct CurvePiece {
  CurveWindow window{};
  PiecePath path;
  Point3 origin;
  std::array<Vector3, 4> points;  ///< relative to origin; control_count(window) of them
  std::array<bool, 2> ghost{};    ///< is the first, is the last of them a ghost?
  double error = 0;               ///< upper bound, a coordinate, of |points - exact control points|
  double largest = 0;             ///< largest |coordinate| of `points`

  [[nodiscard]] std::span<const Vector3> controls() const { return {points.data(), control_count(window)}; }
};

/// The piece of the edge from b to c; `before` and `after` are absent at open ends.
/// Requires:  finite points of at most about 2 (support/scaling.h).
[[nodiscard]] CurvePiece make_curve_piece(CurveDegree degree, const std::optional<Point3>& before,
                                          const Point3& b, const Point3& c,
                                          const std::optional<Point3>& after);

/// The first (child 0) or the second half.
/// Guarantee: `error` of the result covers the parent's and the rounding of this step.
[[nodiscard]] CurvePiece split(const CurvePiece& piece, unsigned child);

/// The Bezier points of a piece that is one polynomial, relative to its origin.
struct CurveBezier {
  std::array<Vector3, 4> points;
  std::size_t count;  ///< degree + 1
  double error;       ///< upper bound, a coordinate, of |points - exact Bezier points|
  double largest;     ///< largest |coordinate|
};
/// Requires:  piece.window != CurveWindow::quadratic_edge.
[[nodiscard]] CurveBezier bezier_points(const CurvePiece& piece);

/// Limit points at both ends of a piece.
[[nodiscard]] std::array<RelativePoint, 2> limit_ends(const CurvePiece& piece);

/// A limit point and the derivative there along the piece's parameter.
struct CurvePiecePoint {
  RelativePoint point;
  Vector3 tangent;  ///< in double precision without a bound; may be 0
};
/// Guarantee: |relative - exact| <= error a coordinate, for exactly this parameter.
/// Errors:    InputError (value) unless 0 <= t <= 1.
/// Source:    derivations/curves.md.
[[nodiscard]] CurvePiecePoint curve_point(const CurvePiece& piece, double t);

}  // namespace snug
