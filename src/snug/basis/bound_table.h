#pragma once

#include <array>
#include <cstdint>
#include <vector>

namespace snug {

/// Where the control points of a patch lie in the plane over which its basis functions are bounded.
enum class TableLayout : std::uint8_t {
  ngon,            ///< the dissertation's: spokes of equal length and angle
  characteristic,  ///< the control net of the characteristic map
};

/// The dissertation's table of a kind: planes below and above every basis function over a triangle that holds
/// the domain, in a layout of its control points.
///
/// Guarantee: with N_i the basis functions and u = sum N_i layout_i the domain point of a parameter, u lies in
///            `triangle`, and  lower_i(u) <= N_i <= upper_i(u)  for control points i = 3, 4, ...
/// Source:    [Wu05, sec. 4.3 to 4.5].
struct BoundTable {
  /// Affine coordinates: weights of corners 1 and 2 of the patch; corner 0 has the rest.
  using Planar = std::array<double, 2>;
  /// A plane, by its values at the three corners of `triangle`.
  using CornerValues = std::array<double, 3>;

  std::vector<Planar> layout;  ///< of all control points; the first three are (0,0), (1,0), (0,1)
  std::array<Planar, 3> triangle;
  std::vector<CornerValues> lower, upper;  ///< of control points 3, 4, ...
};

}  // namespace snug
