#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

#include <snug/geometry/rounding.h>
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

/// degree! / (i! j! k!) of the Bezier point at a place, k = degree - i - j.
[[nodiscard]] double multinomial(std::size_t degree, std::size_t place);

/// A patch as one polynomial on its triangle, or as two: of the corners 0, 1 and m, and of m, 1 and 2, m
/// being the middle of the edge 02.
struct BezierRows {
  std::size_t degree = 0;  ///< of each
  std::size_t parts = 1;
  Stencils rows;  ///< bezier_count(degree) Bezier points a part, from control points
};

/// A point of a lattice as an integer combination of control points.
using Combination = std::vector<int>;
[[nodiscard]] Combination unit_combination(std::size_t i, std::size_t count);

/// Adds the row numerators / divisor; each weight is rounded once, or not at all where `roundoff` is 0.
template <class Number>
void add_fractions(const std::vector<Number>& numerators, double divisor, Stencils& out,
                   double roundoff = unit_roundoff) {
  for (std::size_t c = 0; c < numerators.size(); ++c) {
    if (numerators[c] == 0) continue;
    const double weight = static_cast<double>(numerators[c]) / divisor;
    out.add(static_cast<std::uint32_t>(c), weight, std::fabs(weight) * roundoff);
  }
  out.end_row();
}

/// The points of a regular patch (basis.h). Of a B-spline patch of degree d in both directions place (x, y)
/// stands at x + (d + 1) y; its corner 0 is at (0, 0), its corner 1 at (1, 0) of the parameters.
using Lattice = std::vector<Combination>;

/// Bezier points on the triangle (0,0), (1,0), (1,1) of a tensor product of uniform B-splines of degree d, 1
/// to 3.
/// Guarantee: weights are small fractions, each rounded once.
/// Source:    derivations/tensor_bezier.md.
[[nodiscard]] BezierRows tensor_bezier(std::size_t d, const Lattice& lattice);

}  // namespace snug
