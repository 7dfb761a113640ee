#include <snug/scheme/bezier.h>

#include <array>

namespace snug {
namespace {

std::int64_t factorial(std::size_t n) { return n < 2 ? 1 : static_cast<std::int64_t>(n) * factorial(n - 1); }
std::int64_t binomial(std::size_t n, std::size_t k) {
  return factorial(n) / (factorial(k) * factorial(n - k));
}

// Bezier points of a segment of a B-spline from its control points, times `scale`.
struct Segment {
  double scale;  // squared: of both directions
  int weights[4][4];
};
constexpr Segment segments[4]{{},
                              {1, {{1, 0}, {0, 1}}},
                              {4, {{1, 1, 0}, {0, 2, 0}, {0, 1, 1}}},
                              {36, {{1, 4, 1, 0}, {0, 4, 2, 0}, {0, 2, 4, 0}, {0, 1, 4, 1}}}};

}  // namespace

double multinomial(std::size_t degree, std::size_t place) {
  static const auto all = [] {
    std::array<std::array<double, bezier_count(max_degree)>, max_degree + 1> result{};
    for (std::size_t d = 0; d <= max_degree; ++d) {
      for (std::size_t j = 0; j <= d; ++j) {
        for (std::size_t i = 0; i + j <= d; ++i) {
          result[d][bezier_index(d, i, j)] = static_cast<double>(binomial(d, j) * binomial(d - j, i));
        }
      }
    }
    return result;
  }();
  return all[degree][place];
}

Combination unit_combination(std::size_t i, std::size_t count) {
  Combination c(count, 0);
  c[i] = 1;
  return c;
}

// With x = u + v and y = v the product B_i(x) B_j(y) is C(d,i) (u+v)^i w^(d-i) C(d,j) v^j (w+u)^(d-j), of
// degree 2 d.
BezierRows tensor_bezier(std::size_t d, const Lattice& lattice) {
  const auto& [scale, segment] = segments[d];
  const std::size_t controls = lattice[0].size();
  // Coefficients of the monomials w^(2d-i-j) u^i v^j, a control point each.
  std::vector<std::vector<std::int64_t>> sums(bezier_count(2 * d), std::vector<std::int64_t>(controls, 0));
  for (std::size_t i = 0; i <= d; ++i) {
    for (std::size_t j = 0; j <= d; ++j) {
      std::vector<std::int64_t> point(controls, 0);
      for (std::size_t x = 0; x <= d; ++x) {
        for (std::size_t y = 0; y <= d; ++y) {
          const std::int64_t factor = std::int64_t{segment[i][x]} * segment[j][y];
          for (std::size_t c = 0; c < controls; ++c) point[c] += factor * lattice[x + (d + 1) * y][c];
        }
      }
      for (std::size_t p = 0; p <= i; ++p) {
        for (std::size_t q = 0; q <= d - j; ++q) {
          const std::int64_t factor = binomial(d, i) * binomial(d, j) * binomial(i, p) * binomial(d - j, q);
          auto& sum = sums[bezier_index(2 * d, p + q, i - p + j)];
          for (std::size_t c = 0; c < controls; ++c) sum[c] += factor * point[c];
        }
      }
    }
  }
  BezierRows out{2 * d, 1, {}};
  for (std::size_t place = 0; place < sums.size(); ++place) {
    add_fractions(sums[place], scale * multinomial(2 * d, place), out.rows);
  }
  return out;
}

}  // namespace snug
