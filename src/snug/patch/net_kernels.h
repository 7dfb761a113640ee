#pragma once

#include <array>
#include <cstdint>
#include <span>

#include <snug/scheme/basis.h>
#include <snug/scheme/stencils.h>
#include <support/point.h>

/// Inner loops of evaluation, in vectors of Highway.
namespace snug::kernels {

/// A point of a net with a fourth number, which is 0.
using NetPoint = std::array<double, 4>;

/// All rows of `stencils`, applied to points.
/// Requires:  room for as many points as rows.
/// Returns:   the largest |coordinate| of the new points.
double refine_net(const Stencils& stencils, const NetPoint* points, NetPoint* out);

/// A parameter on a regular piece, and the numbers of its lattice's points, basis_count() of them.
struct LatticePlace {
  double w, u, v;  ///< of the kind; w = 1 - u - v matters to triangles only
  const std::uint32_t* lattice;
};

/// The sum of lattice points weighted by basis functions.
/// Guarantee: off by at most basis_count() roundings and what BasisBounds counts.
void sum_values(RegularBasis basis, const NetPoint* points, const LatticePlace& at, NetPoint& out);

/// The same with sums weighted by derivatives along u and v.
struct BasisSums {
  NetPoint value, along_u, along_v;
};
void sum_derivatives(RegularBasis basis, const NetPoint* points, const LatticePlace& at, BasisSums& out);

/// A regular piece, for many of its points.
struct LatticePoints {
  RegularBasis basis;
  std::uint8_t first;  ///< corner of the piece that its kind calls 0
  const NetPoint* points;
  const std::uint32_t* lattice;  ///< as in LatticePlace
  Point3 origin;                 ///< of the points
  double error;                  ///< of their sums
};
/// Parameters on a piece, and numbers of their answers.
struct LatticeParameters {
  const double *u, *v;
  const std::uint32_t* numbers;
  std::size_t count;
};
/// Limit points, written where the numbers say.
/// Guarantee: sum_values() added to the origin, to the bit, with its error and that of the addition.
void points_on_lattice(const LatticePoints& piece, const LatticeParameters& at, BoundedPoint* out);

/// Positions in single precision, three floats each, the k-th from out[3 numbers[k]] on.
/// Returns:   an upper bound of the errors of all coordinates, rounding to float included; infinite if one does not fit a float.
double round_points(std::span<const BoundedPoint> points, const std::size_t* numbers, float* out);

}  // namespace snug::kernels
