#pragma once

#include <array>
#include <cstddef>
#include <type_traits>

#include <snug/patch/polynomial.h>

/// Monomials of barycentric coordinates, in the order of bezier_index(). For the files of patch/ alone.
namespace snug {

// w^k u^i v^j, k = degree - i - j. At most degree - 1 roundings each.
template <std::size_t degree>
void monomials(double w, double u, double v, double* out) {
  std::array<double, degree + 1> us{1}, vs{1}, ws{1};
  for (std::size_t k = 1; k <= degree; ++k)
    us[k] = us[k - 1] * u, vs[k] = vs[k - 1] * v, ws[k] = ws[k - 1] * w;
  for (std::size_t j = 0; j <= degree; ++j) {
    for (std::size_t i = 0; i + j <= degree; ++i) *out++ = ws[degree - i - j] * us[i] * vs[j];
  }
}

// visit(degree) with one of the degrees that patches have as a constant.
template <class Visit>
auto with_degree(std::size_t degree, const Visit& visit) {
  switch (degree) {
    case 1:
      return visit(std::integral_constant<std::size_t, 1>{});
    case 2:
      return visit(std::integral_constant<std::size_t, 2>{});
    case 4:
      return visit(std::integral_constant<std::size_t, 4>{});
    default:
      return visit(std::integral_constant<std::size_t, 6>{});
  }
}

}  // namespace snug
