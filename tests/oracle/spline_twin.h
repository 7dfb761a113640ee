#pragma once

#include <array>
#include <cstddef>
#include <vector>

/// B-splines by the recursion of their basis functions, in extended precision or in rational numbers.
namespace oracle {

/// All basis functions of a degree at a parameter. At the last knot the last one is 1.
template <class Number = long double>
[[nodiscard]] std::vector<Number> spline_basis(const std::vector<double>& knots, std::size_t degree,
                                               const Number& t) {
  std::vector<Number> basis(knots.size() - 1, Number(0));
  std::size_t span = 0;
  for (std::size_t k = 0; k + 1 < knots.size(); ++k) {
    if (knots[k] < knots[k + 1] && knots[k] <= t) span = k;
  }
  basis[span] = 1;
  for (std::size_t d = 1; d <= degree; ++d) {
    for (std::size_t k = 0; k + d + 1 < knots.size(); ++k) {
      Number sum(0);
      if (knots[k + d] > knots[k]) sum += (t - knots[k]) / (Number(knots[k + d]) - knots[k]) * basis[k];
      if (knots[k + d + 1] > knots[k + 1])
        sum += (knots[k + d + 1] - t) / (Number(knots[k + d + 1]) - knots[k + 1]) * basis[k + 1];
      basis[k] = sum;
    }
  }
  basis.resize(knots.size() - degree - 1);
  return basis;
}

/// A point of a tensor-product surface whose points have x, y, z; u innermost.
template <class Points>
[[nodiscard]] std::array<long double, 3> spline_point(std::size_t degree, const std::vector<double>& u_knots,
                                                      const std::vector<double>& v_knots,
                                                      const Points& points, long double u, long double v) {
  const std::vector<long double> a = spline_basis(u_knots, degree, u), b = spline_basis(v_knots, degree, v);
  std::array<long double, 3> sum{};
  for (std::size_t j = 0; j < b.size(); ++j) {
    for (std::size_t i = 0; i < a.size(); ++i) {
      const auto& p = points[i + a.size() * j];
      sum[0] += a[i] * b[j] * p.x;
      sum[1] += a[i] * b[j] * p.y;
      sum[2] += a[i] * b[j] * p.z;
    }
  }
  return sum;
}

}  // namespace oracle
