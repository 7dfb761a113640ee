#pragma once

#include <optional>
#include <vector>

#include <snug/patch/neighbourhood.h>
#include <snug/scheme/stencils.h>

namespace snug {

/// Place of the Bezier point u^i v^j among those of a triangle of some degree; j outermost.
[[nodiscard]] constexpr std::size_t bezier_index(std::size_t degree, std::size_t i, std::size_t j) {
  return i + j * (degree + 1) - j * (j - 1) / 2;
}
[[nodiscard]] constexpr std::size_t bezier_count(std::size_t degree) {
  return (degree + 1) * (degree + 2) / 2;
}
inline constexpr std::size_t max_degree = 6;

/// A patch as one polynomial on its triangle, or as two: of the corners 0, 1 and m, and of m, 1 and 2, m being the middle
/// of the edge 02.
struct PolynomialForm {
  std::size_t degree = 0;  ///< of each
  std::size_t parts = 1;
  Stencils rows;  ///< bezier_count(degree) Bezier points a part, from control points
  /// The rows, each times its multinomial coefficient: of w^k u^i v^j from control points. A part after the other, in it
  /// four control points after the other (zeros where there are none), in these four doubles a row.
  std::vector<double> weights;
};

/// The polynomial form of a kind, if every corner is regular: degree 4 for Loop and Doo-Sabin, 6 for the half of a
/// bicubic Catmull-Clark quad, two quadratic parts for Midedge. Smooth boundaries and sharp corners of the regular sort
/// are completed by ghost points, which reproduce them exactly.
///
/// Guarantee: entries of rows are small fractions, each rounded once; those of weights are these, times a whole number
///            and rounded again.
/// Source:    derivations/loop_bezier.md, tensor_bezier.md, midedge_bezier.md; [Stam98] gives the same basis for Loop.
[[nodiscard]] std::optional<PolynomialForm> polynomial_form(const KindKey& key);

}  // namespace snug
