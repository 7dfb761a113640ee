#pragma once

#include <cstddef>

#include <snug/geometry/bernstein.h>

/// Integrals of polynomial parts of surfaces, a part a lane. Every lane does the same operations in the same order on every
/// instruction set, none of them fused.
namespace snug::kernels {

inline constexpr std::size_t moment_lanes = 8;
/// Bound of all underflow in the computations on a part; sizes are between 1e-30 and 4.
inline constexpr double moment_underflow = 0x1p-900;

/// Up to eight parts: what is known of them, and what comes out.
struct MomentParts {
  using Lanes = double[moment_lanes];
  alignas(64) Lanes points[3][16];  ///< Bezier points by axis, from an origin of each part's own
  Lanes origin[3];                  ///< that, from the origin of moments
  Lanes point_error;                ///< upper bounds, a coordinate, of |point - exact|
  Lanes origin_error;               ///< likewise
  /// x_u cross x_v by axis, scaled as Bernstein is; an upper bound of the errors of its Bezier coefficients, and of these.
  Lanes normal[3][36];
  Lanes normal_error, largest_normal;
  /// Moments, and upper bounds of |value - exact| but for roundings of the value itself.
  Lanes value[10], error[10];
};
/// Of parts that are polynomials of a degree on a domain.
/// Requires:  degree 1, 2 or 4 on the triangle; 1, 2 or 3 in u and in v on the square. 1 to 8 parts, in the first lanes; others
///            are overwritten.
/// Source:    derivations/measures.md, "Moments of a regular piece".
void integrate(Domain domain, std::size_t degree, std::size_t count, MomentParts& parts);

}  // namespace snug::kernels
