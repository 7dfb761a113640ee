#include <snug/patch/curve_piece.h>

#include <algorithm>

#include <snug/geometry/rounding.h>
#include <support/error.h>

namespace snug {
namespace {

double largest_of(std::span<const Vector3> points) {
  double largest = 0;
  for (const Vector3& p : points) largest = std::max(largest, max_abs(p));
  return largest;
}

}  // namespace

CurvePiece make_curve_piece(CurveDegree degree, const std::optional<Point3>& before, const Point3& b,
                            const Point3& c, const std::optional<Point3>& after) {
  CurvePiece piece;
  piece.window = degree == CurveDegree::cubic ? CurveWindow::cubic_edge : CurveWindow::quadratic_edge;
  piece.origin = b;
  // With b in the origin both ghosts, -(c - b) and 2 (c - b), are exact functions of the stored difference.
  const Vector3 edge = c - b;
  piece.points = {before ? *before - b : -edge, Vector3{}, edge, after ? *after - b : 2 * edge};
  piece.ghost = {!before, !after};
  piece.largest = largest_of(piece.controls());
  piece.error = enlarged(unit_roundoff * piece.largest + 4 * underflow_error);
  return piece;
}

CurvePiece split(const CurvePiece& piece, unsigned child) {
  const Stencils& rows = child_rows(piece.window, child);
  CurvePiece half;
  half.window = child_window(piece.window);
  half.path = piece.path.child(child);
  half.origin = piece.origin;
  for (std::size_t r = 0; r < rows.row_count(); ++r)
    half.points[r] = rows.apply<Vector3>(r, piece.controls());
  half.ghost = {child == 0 && piece.ghost[0], child == 1 && piece.ghost[1]};
  half.largest = largest_of(half.controls());
  half.error = rows.result_error(piece.largest, piece.error);
  return half;
}

CurveBezier bezier_points(const CurvePiece& piece) {
  const Stencils& rows = bezier_rows(piece.window);
  CurveBezier bezier{{}, rows.row_count(), rows.result_error(piece.largest, piece.error), 0};
  for (std::size_t r = 0; r < bezier.count; ++r) bezier.points[r] = rows.apply<Vector3>(r, piece.controls());
  bezier.largest = largest_of({bezier.points.data(), bezier.count});
  return bezier;
}

std::array<RelativePoint, 2> limit_ends(const CurvePiece& piece) {
  if (piece.window == CurveWindow::quadratic_edge) {
    return {limit_ends(split(piece, 0))[0], limit_ends(split(piece, 1))[1]};
  }
  const CurveBezier bezier = bezier_points(piece);
  return {RelativePoint{bezier.points[0], bezier.error},
          RelativePoint{bezier.points[bezier.count - 1], bezier.error}};
}

CurvePiecePoint curve_point(const CurvePiece& piece, double t) {
  require_value(t >= 0 && t <= 1, "a parameter is outside its edge: t must be from 0 to 1");
  if (piece.window == CurveWindow::quadratic_edge) {
    const unsigned child = t > 0.5 ? 1 : 0;
    CurvePiecePoint result = curve_point(split(piece, child), 2 * t - child);  // exact
    result.tangent = 2 * result.tangent;
    return result;
  }
  CurveBezier b = bezier_points(piece);
  const double degree = static_cast<double>(b.count - 1), w = 1 - t;
  for (std::size_t left = b.count; left > 2; --left) {
    for (std::size_t i = 0; i + 1 < left; ++i) b.points[i] = w * b.points[i] + t * b.points[i + 1];
  }
  const Vector3 p = w * b.points[0] + t * b.points[1];
  // Three levels of two products and a sum each, with a weight that is off by one rounding.
  const double error = gamma_bound(32) * b.largest + b.error + 64 * underflow_error;
  return {{p, enlarged(error)}, degree * (b.points[1] - b.points[0])};
}

}  // namespace snug
