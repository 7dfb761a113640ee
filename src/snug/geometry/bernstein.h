#pragma once

#include <array>
#include <cstddef>

/// Polynomials on a triangle or a square, and their products and means.
namespace snug {

/// Where a polynomial is integrated: u, v >= 0 with u + v <= 1, or 0 <= u, v <= 1.
enum class Domain { triangle, square };

/// Area of the domain.
[[nodiscard]] constexpr double area_of(Domain domain) { return domain == Domain::triangle ? 0.5 : 1; }

/// A polynomial by its scaled Bernstein coefficients: Bezier coefficients times binomials, so that a product is
/// a plain convolution. The coefficient (i, j) is that of u^i v^j w^(A - i - j) on the triangle, whose degree is
/// A = B, and of u^i (1 - u)^(A - i) v^j (1 - v)^(B - j) on the square; i is innermost.
template <Domain domain, std::size_t A, std::size_t B = A>
struct Bernstein {
  static_assert(domain == Domain::square || A == B);
  static constexpr bool triangle = domain == Domain::triangle;
  static constexpr std::size_t count = triangle ? (A + 1) * (A + 2) / 2 : (A + 1) * (B + 1), rows = B + 1;

  std::array<double, count> scaled{};

  [[nodiscard]] static constexpr std::size_t width(std::size_t j) { return triangle ? A + 1 - j : A + 1; }
  [[nodiscard]] static constexpr std::size_t place(std::size_t i, std::size_t j) {
    return triangle ? i + j * (A + 1) - (j * j - j) / 2 : i + j * (A + 1);
  }
  /// Calls visit(i, j) in the order of coefficients.
  template <class Visit>
  static constexpr void for_each(const Visit& visit) {
    for (std::size_t j = 0; j <= B; ++j) {
      for (std::size_t i = 0; i < width(j); ++i) visit(i, j);
    }
  }
};

constexpr double binomial(std::size_t n, std::size_t k) {
  double b = 1;
  // A whole number after each step.
  for (std::size_t i = 1; i <= k; ++i) b = b * static_cast<double>(n + 1 - i) / static_cast<double>(i);
  return b;
}

namespace detail {

template <class P>
struct Binomials;
template <Domain domain, std::size_t A, std::size_t B>
struct Binomials<Bernstein<domain, A, B>> {
  using P = Bernstein<domain, A, B>;
  static constexpr std::array<double, P::count> all() {
    std::array<double, P::count> result{};
    P::for_each([&](std::size_t i, std::size_t j) {
      result[P::place(i, j)] =
          P::triangle ? binomial(A, j) * binomial(A - j, i) : binomial(A, i) * binomial(B, j);
    });
    return result;
  }
  static constexpr std::array<double, P::count> means() {
    std::array<double, P::count> result = all();
    for (double& x : result) x = 1 / (static_cast<double>(P::count) * x);
    return result;
  }
};

}  // namespace detail

/// Scaled coefficients over Bezier coefficients.
template <class P>
inline constexpr std::array<double, P::count> binomials = detail::Binomials<P>::all();
/// Means over the domain of the basis functions of scaled coefficients.
template <class P>
inline constexpr std::array<double, P::count> means = detail::Binomials<P>::means();
/// The polynomial 1.
template <class P>
inline constexpr P one{binomials<P>};

/// Mean over the domain.
template <class P>
[[nodiscard]] double mean_of(const P& p) {
  double sum = 0;
  for (std::size_t k = 0; k < P::count; ++k) sum += means<P>[k] * p.scaled[k];
  return sum;
}

/// The domain and degrees of a product.
template <class P, class Q>
struct BernsteinProduct;
template <Domain domain, std::size_t A, std::size_t B, std::size_t C, std::size_t D>
struct BernsteinProduct<Bernstein<domain, A, B>, Bernstein<domain, C, D>> {
  using Type = Bernstein<domain, A + C, B + D>;
};
template <class P, class Q>
using ProductOf = typename BernsteinProduct<P, Q>::Type;

/// Adds factor * p * q to `out`.
///
/// Guarantee: a Bezier coefficient of the product errs by at most gamma_bound(Q::count + 4) times the largest
///            ones of the factors: all terms of a convolution are weighted averages of these.
template <class P, class Q>
void add_product(const P& p, const Q& q, double factor, ProductOf<P, Q>& out) {
  using Out = ProductOf<P, Q>;
  P::for_each([&](std::size_t i, std::size_t j) {
    const double a = factor * p.scaled[P::place(i, j)];
    const double* from = q.scaled.data();
    for (std::size_t l = 0; from < q.scaled.data() + Q::count; from += Q::width(l), ++l) {
      double* const to = out.scaled.data() + Out::place(i, j + l);
      for (std::size_t k = 0; k < Q::width(l); ++k) to[k] += a * from[k];
    }
  });
}
template <class P, class Q>
[[nodiscard]] ProductOf<P, Q> product(const P& p, const Q& q) {
  ProductOf<P, Q> out;
  add_product(p, q, 1, out);
  return out;
}

}  // namespace snug
