#pragma once

#include <array>
#include <cstddef>

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

// degree! / (i! j! k!).
template <std::size_t degree>
constexpr std::array<double, bezier_count(degree)> make_multinomials() {
  constexpr auto factorial = [](std::size_t n) {
    double product = 1;
    for (std::size_t i = 2; i <= n; ++i) product *= static_cast<double>(i);
    return product;
  };
  std::array<double, bezier_count(degree)> result{};
  for (std::size_t j = 0; j <= degree; ++j) {
    for (std::size_t i = 0; i + j <= degree; ++i) {
      result[bezier_index(degree, i, j)] =
          factorial(degree) / (factorial(i) * factorial(j) * factorial(degree - i - j));
    }
  }
  return result;
}
template <std::size_t degree>
constexpr std::array<double, bezier_count(degree)> multinomials = make_multinomials<degree>();

inline double multinomial(std::size_t degree, std::size_t place) {
  return degree == 2 ? multinomials<2>[place] : degree == 4 ? multinomials<4>[place] : multinomials<6>[place];
}

}  // namespace snug
