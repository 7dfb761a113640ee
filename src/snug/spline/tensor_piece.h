#pragma once

#include <array>
#include <cstddef>
#include <span>

#include <snug/patch/quarters.h>
#include <support/point.h>

namespace snug {

/// A tensor-product polynomial of degree 1 to 3 in u and v, as one span of a B-spline: (degree + 1)^2 control points, u innermost,
/// and the 2 degree knots each way on which the span depends. With uniform knots the points are a lattice, with knots 0 and 1 only
/// they are Bezier points.
struct TensorPiece {
  static constexpr std::size_t max_degree = 3, max_count = (max_degree + 1) * (max_degree + 1);

  std::size_t degree = 0;
  std::array<double, 2 * max_degree> u{}, v{};  ///< knots
  std::array<Vector3, max_count> points{};
  double largest = 0;  ///< |coordinate|
  double error = 0;    ///< upper bound, a coordinate, of |point - exact point|

  [[nodiscard]] std::size_t width() const { return degree + 1; }
  [[nodiscard]] std::size_t count() const { return width() * width(); }
  [[nodiscard]] Vector3& at(std::size_t i, std::size_t j) { return points[i + width() * j]; }
  [[nodiscard]] const Vector3& at(std::size_t i, std::size_t j) const { return points[i + width() * j]; }
};

/// A rectangle of parameters.
struct ParameterBox {
  double u0 = 0, u1 = 1, v0 = 0, v1 = 1;
  friend bool operator==(const ParameterBox&, const ParameterBox&) = default;
};

/// A regular piece on [0, 1]^2.
/// Requires:  a tensor basis of this degree.
[[nodiscard]] TensorPiece tensor_piece(const LatticeNet& net, std::size_t degree);
/// One with the knots of Bezier points, all of which are 0.
[[nodiscard]] TensorPiece bezier_piece(std::size_t degree);

/// Sets `largest` from the points.
void take_largest(TensorPiece& piece);

/// The polynomial's polar form at `degree` arguments each way.
[[nodiscard]] Vector3 blossom(const TensorPiece& piece, std::span<const double> u, std::span<const double> v);
/// The value at a parameter.
[[nodiscard]] Vector3 value(const TensorPiece& piece, double u, double v);
/// Value, derivatives along u and v, and the mixed one.
struct CornerJet {
  Vector3 point, along_u, along_v, twist;
};
/// At a parameter.
[[nodiscard]] CornerJet jet_at(const TensorPiece& piece, double u, double v);
/// Of Bezier points at one of their corners: x, y are 0 or 1.
[[nodiscard]] CornerJet corner_jet(const TensorPiece& bezier, std::size_t x, std::size_t y);

/// The polynomial on a part of its parameters, by Bezier points.
/// Guarantee: `error` covers the rounding of this, too.
/// Requires:  a part of the square between the middle knots; parameters and knots of few digits, whose differences are exact.
[[nodiscard]] TensorPiece bezier_on(const TensorPiece& piece, const ParameterBox& box);
/// The same polynomial with degree 3. Errors likewise.
/// Requires:  Bezier points.
[[nodiscard]] TensorPiece raised(const TensorPiece& bezier);
/// Turned so that side k takes the place of side 0: the result has (0, 0) at corner k, and u along side k.
/// Requires:  knots that are symmetric, as those of lattices and of Bezier points.
[[nodiscard]] TensorPiece turned(const TensorPiece& piece, std::size_t k);

/// Upper bound of a distance whose computed square is this, each coordinate of the difference being off by at most `rounding`.
[[nodiscard]] double distance_up(double largest_sq, double rounding);
/// Upper bound of |a(u, v) - b(u, v)| on [0, 1]^2, errors included.
/// Requires:  Bezier points of the same degree.
[[nodiscard]] double distance_bound(const TensorPiece& a, const TensorPiece& b);

/// Upper bound of the distance of any two points of a net's piece and of a polynomial.
/// Requires:  Bezier points.
[[nodiscard]] double distance_bound(const ControlNet& net, const TensorPiece& bezier);

}  // namespace snug
