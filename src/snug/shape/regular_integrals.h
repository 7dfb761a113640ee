#pragma once

#include <array>
#include <span>
#include <vector>

#include <snug/patch/net_kernels.h>
#include <snug/scheme/basis.h>
#include <snug/shape/area_piece.h>
#include <support/point.h>

namespace snug {

/// Integrals over a part of a surface, q being x . (x_u cross x_v): of q, of x q, y q, z q, and of xx q, yy q,
/// zz q, xy q, yz q, zx q. They are 3, 4 and 5 times the moments of the cone from the origin over the part.
struct FluxMoments {
  std::array<double, 10> value{};
  std::array<double, 10> error{};  ///< upper bounds of |value - exact|
};

/// A regular piece by the points that its basis functions weight.
struct RegularPiece {
  RegularBasis basis;
  std::array<kernels::NetPoint, max_basis_count> points;  ///< relative to some origin of the piece's own
  double largest;                                         ///< |coordinate| of these points
  double error;                                           ///< upper bound, a coordinate, of |point - exact|
  Vector3 origin;                                         ///< of the piece, from the origin of moments
  double origin_error;                                    ///< likewise
};

/// The moments of regular pieces, whose integrands are polynomials; adds the polynomials x_u cross x_v to
/// `normals`, in one part or in four each.
///
/// Guarantee: FluxMoments::error and the errors of the parts, rounding included.
/// Requires:  pieces of one basis; a sum for each, of nothing before.
/// Cost:      of eight, 0.5 to 1 microsecond each.
/// Source:    derivations/measures.md, "Moments of a regular piece".
void integrate(std::span<const RegularPiece> pieces, std::span<FluxMoments> sums,
               std::vector<AreaPiece>& normals);

}  // namespace snug
