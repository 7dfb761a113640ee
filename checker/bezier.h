#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "piece.h"
#include "real.h"

namespace checker {

/// The exponents of a Bernstein polynomial in the weights of corners 0, 1 and 2; they sum to the degree. Over
/// the degree they are a lattice point of the triangle.
using Exponents = std::array<unsigned, 3>;
[[nodiscard]] const std::vector<Exponents>& exponents(unsigned degree);

/// A polynomial on a triangle, by rows of its Bezier points in the order of exponents().
struct BezierTriangle {
  unsigned degree = 0;
  std::array<Place, 3> places{};
  std::vector<Row> points;
};

/// The quartic that a piece of Loop's is, from its limits at the 15 points of a lattice of step 1/4.
/// Requires:  piece.polynomial().
[[nodiscard]] std::vector<BezierTriangle> bezier_triangles(const Piece& piece);

/// Bezier points from values at the lattice points: weights [Bezier point][lattice point].
/// Requires:  degree 2, 4 or 6.
/// Errors:    Rejected if the matrix of Bernstein polynomials could not be inverted.
[[nodiscard]] const std::vector<Row>& bezier_from_values(unsigned degree);

/// The Bernstein polynomial where the corners have these weights.
[[nodiscard]] Real bernstein(const Exponents& p, const std::array<Real, 3>& weights);

}  // namespace checker
