#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include <snug/geometry/rounding.h>

/// Basis functions of regular patches: B-splines and box splines by the points of a regular lattice.
namespace snug {

/// Which functions a scheme's regular patches are made of, and the order of the lattice's points.
enum class RegularBasis : std::uint8_t {
  linear,      ///< the corners of a triangle
  box_spline,  ///< twelve points, drawn in rings.h: quartics
  bilinear,    ///< of these three place (x, y) stands at x + (d + 1) y
  biquadratic,
  bicubic,
  zwart_powell,  ///< nine points in the order of ring_of_vertex(): quadratics on four triangles
};

[[nodiscard]] constexpr std::size_t basis_count(RegularBasis basis) {
  constexpr std::array<std::size_t, 6> counts{3, 12, 4, 9, 16, 9};
  return counts[static_cast<std::size_t>(basis)];
}
inline constexpr std::size_t max_basis_count = 16;
using BasisValues = std::array<double, max_basis_count>;

/// Bounds for all bases, derivations/rounding.md, "Basis functions".
struct BasisBounds {
  // In sum over the functions: errors of values and of derivatives, in units of unit_roundoff; |derivative|; and
  // by how much values and derivatives change where parameters, or the three coordinates of a triangle in sum,
  // are off by one unit.
  static constexpr std::size_t value_roundings = 24, derivative_roundings = 110;
  static constexpr double derivative_sum = 8, value_change = 4, derivative_change = 24;

  /// Error, a coordinate, of sums of lattice points of at most `largest`, themselves off by `points_error`, at a
  /// parameter that is off by `off` before w = 1 - u - v is rounded: of limit points.
  [[nodiscard]] static constexpr double value_error(double largest, double points_error, double off) {
    return enlarged(
               (gamma_bound(max_basis_count + value_roundings) + value_change * (off + 2 * unit_roundoff)) *
                   largest +
               points_error) +
           0x1p20 * underflow_error;
  }
  /// Of derivatives along u and v.
  [[nodiscard]] static constexpr double derivative_error(double largest, double points_error, double off) {
    return enlarged((gamma_bound(max_basis_count + 2) * derivative_sum + gamma_bound(derivative_roundings) +
                     derivative_change * (off + 2 * unit_roundoff)) *
                        largest +
                    derivative_sum * points_error) +
           0x1p20 * underflow_error;
  }
};

[[nodiscard]] constexpr bool is_tensor(RegularBasis basis) {
  return basis == RegularBasis::bilinear || basis == RegularBasis::biquadratic ||
         basis == RegularBasis::bicubic;
}
/// Requires:  is_tensor(basis).
[[nodiscard]] constexpr std::size_t tensor_degree(RegularBasis basis) {
  return basis == RegularBasis::bilinear ? 1 : basis == RegularBasis::biquadratic ? 2 : 3;
}

#include <snug/scheme/basis_functions-inl.h>

}  // namespace snug
