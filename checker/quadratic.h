#pragma once

#include <array>
#include <vector>

#include "piece.h"
#include "real.h"

namespace checker {

/// Weights of the Bezier points of a quadratic over the root, in the order of SixWeights.
using SixReals = std::array<Real, 6>;

/// Of the Bezier points that it has over a piece, raised to `degree`, in the order of exponents(): from its
/// values at the piece's lattice points.
/// Requires:  degree 2, 4 or 6.
[[nodiscard]] std::vector<SixReals> raised_quadratic(const std::array<Place, 3>& piece, unsigned degree);

/// Of the six that it has over a piece, without any rounding.
/// Requires:  corners that are multiples of 2, in whole numbers of 2^-30.
[[nodiscard]] std::array<SixReals, 6> restricted_quadratic(const std::array<Place, 3>& piece);

/// A place in the root's parameter triangle, as weights of its corners 1 and 2.
using Parameter = std::array<Real, 2>;
[[nodiscard]] Parameter parameter_of(const Place& place);
/// Of a Bezier point of a linear function over a piece, raised to the degree of `exponents`.
[[nodiscard]] Parameter raised_parameter(const std::array<Place, 3>& piece,
                                         const std::array<unsigned, 3>& exponents);

}  // namespace checker
