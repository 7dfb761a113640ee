#pragma once

#include <array>
#include <cstdint>
#include <span>

#include <snug/scheme/basis.h>
#include <snug/scheme/stencils.h>

/// Inner loops of evaluation, in vectors of Highway.
namespace snug::kernels {

/// A point of a net with a fourth number, which is 0.
using NetPoint = std::array<double, 4>;

/// All rows of `stencils`, applied to points.
/// Requires:  room for as many points as rows.
/// Returns:   the largest |coordinate| of the new points.
double refine_net(const Stencils& stencils, const NetPoint* points, NetPoint* out);

/// A parameter on a regular piece, and where its lattice is.
struct LatticePlace {
  double w, u, v;  ///< of the kind; w = 1 - u - v matters to triangles only
  std::uint32_t net;
  const std::uint32_t* lattice;  ///< places after `net`, basis_count() of them
};

/// Sums of lattice points weighted by basis functions.
/// Guarantee: each is off by at most basis_count() roundings and what BasisBounds counts.
void sum_values(RegularBasis basis, const NetPoint* points, std::span<const LatticePlace> at, NetPoint* out);

/// The same with sums weighted by derivatives along u and v.
struct BasisSums {
  NetPoint value, along_u, along_v;
};
void sum_derivatives(RegularBasis basis, const NetPoint* points, std::span<const LatticePlace> at,
                     BasisSums* out);

}  // namespace snug::kernels
