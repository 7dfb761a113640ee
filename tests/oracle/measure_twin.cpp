#include <oracle/measure_twin.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <stdexcept>
#include <utility>

namespace oracle {
namespace {

using Long = long double;
using Place = std::array<Long, 3>;

Place minus(const Place& a, const Place& b) { return {a[0] - b[0], a[1] - b[1], a[2] - b[2]}; }
Place cross(const Place& a, const Place& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

constexpr std::array<std::array<std::size_t, 2>, 6> kPairs{{{0, 0}, {1, 1}, {2, 2}, {0, 1}, {1, 2}, {2, 0}}};

// Volume, integrals of x, y, z and of xx, yy, zz, xy, yz, zx over a solid.
template <class Number>
using Moments = std::array<Number, 10>;

// Volume, centroid and inertia about it.
template <class Number>
std::array<Number, 10> about_centroid(const Moments<Number>& m) {
  std::array<Number, 10> result;
  result[0] = m[0];
  for (std::size_t a = 0; a < 3; ++a) result[1 + a] = m[1 + a] / m[0];
  std::array<Number, 6> central;
  for (std::size_t k = 0; k < 6; ++k) {
    central[k] = m[4 + k] - m[1 + kPairs[k][0]] * m[1 + kPairs[k][1]] / m[0];
  }
  for (std::size_t a = 0; a < 3; ++a) {
    result[4 + a] = central[(a + 1) % 3] + central[(a + 2) % 3];
    result[7 + a] = -central[3 + a];
  }
  return result;
}

// Tetrahedra of a point and the triangles.
class PolyhedronSum {
 public:
  explicit PolyhedronSum(const Place& origin) : origin_(origin) {}
  void add(const Place& p, const Place& q, const Place& r) {
    const Place a = minus(p, origin_), b = minus(q, origin_), c = minus(r, origin_);
    const Place n = cross(minus(b, a), minus(c, a));
    area_ += std::sqrt(n[0] * n[0] + n[1] * n[1] + n[2] * n[2]) / 2;
    const Long six = a[0] * n[0] + a[1] * n[1] + a[2] * n[2];
    moments_[0] += six / 6;
    for (std::size_t x = 0; x < 3; ++x) moments_[1 + x] += six * (a[x] + b[x] + c[x]) / 24;
    for (std::size_t k = 0; k < 6; ++k) {
      const auto [x, y] = kPairs[k];
      const Long sum = (a[x] + b[x] + c[x]) * (a[y] + b[y] + c[y]);
      moments_[4 + k] += six * (a[x] * a[y] + b[x] * b[y] + c[x] * c[y] + sum) / 120;
    }
  }
  [[nodiscard]] MeasureValues result() const {
    MeasureValues values;
    values[0] = area_;
    const Moments<Long> about = about_centroid(moments_);
    std::copy(about.begin(), about.end(), values.begin() + 1);
    for (std::size_t x = 0; x < 3; ++x) values[2 + x] += origin_[x];
    return values;
  }

 private:
  Place origin_;
  Long area_ = 0;
  Moments<Long> moments_{};
};

Place place(const Point& p) { return {p[0], p[1], p[2]}; }

// Polynomials in u and v by their powers.
using Polynomial = std::map<std::pair<unsigned, unsigned>, mpq_class>;

Polynomial operator*(const Polynomial& p, const Polynomial& q) {
  Polynomial result;
  for (const auto& [i, a] : p) {
    for (const auto& [j, b] : q) result[{i.first + j.first, i.second + j.second}] += a * b;
  }
  return result;
}
void add(Polynomial& sum, const mpq_class& factor, const Polynomial& p) {
  for (const auto& [powers, a] : p) sum[powers] += factor * a;
}
Polynomial power(const Polynomial& p, unsigned n) {
  Polynomial result{{{0, 0}, 1}};
  for (unsigned i = 0; i < n; ++i) result = result * p;
  return result;
}
Polynomial derivative(const Polynomial& p, bool by_v) {
  Polynomial result;
  for (const auto& [powers, a] : p) {
    const unsigned n = by_v ? powers.second : powers.first;
    if (n == 0) continue;
    auto lower = powers;
    --(by_v ? lower.second : lower.first);
    result[lower] += n * a;
  }
  return result;
}
mpz_class factorial(unsigned n) { return n == 0 ? mpz_class(1) : mpz_class(n * factorial(n - 1)); }
mpq_class integral(const Polynomial& p, bool triangle) {
  mpq_class sum = 0;
  for (const auto& [powers, a] : p) {
    const auto [i, j] = powers;
    mpq_class monomial(1, (i + 1) * (j + 1));
    if (triangle) monomial = mpq_class(factorial(i) * factorial(j), factorial(i + j + 2));
    monomial.canonicalize();
    sum += a * monomial;
  }
  return sum;
}

// A basis function and the place of its point, from that of the patch.
struct Function {
  Polynomial value;
  int i, j;
};

std::vector<Function> tensor_functions(unsigned degree) {
  const Polynomial t{{{1, 0}, 1}}, rest{{{0, 0}, 1}, {{1, 0}, -1}};
  std::vector<Polynomial> along;
  if (degree == 1) along = {rest, t};
  if (degree == 2) {
    along = {power(rest, 2), {{{0, 0}, 1}, {{1, 0}, 2}, {{2, 0}, -2}}, power(t, 2)};
    for (Polynomial& p : along) p = p * Polynomial{{{0, 0}, mpq_class(1, 2)}};
  }
  if (degree == 3) {
    along = {power(rest, 3),
             {{{0, 0}, 4}, {{2, 0}, -6}, {{3, 0}, 3}},
             {{{0, 0}, 1}, {{1, 0}, 3}, {{2, 0}, 3}, {{3, 0}, -3}},
             power(t, 3)};
    for (Polynomial& p : along) p = p * Polynomial{{{0, 0}, mpq_class(1, 6)}};
  }
  std::vector<Function> functions;
  for (std::size_t j = 0; j <= degree; ++j) {
    Polynomial by_v;
    for (const auto& [powers, a] : along[j]) by_v[{powers.second, powers.first}] = a;
    for (std::size_t i = 0; i <= degree; ++i) {
      functions.push_back({along[i] * by_v, static_cast<int>(i), static_cast<int>(j)});
    }
  }
  return functions;
}

// On the triangle A = 0, B = e, C = f of lattice directions, b = u, c = v.
std::vector<Function> box_spline_functions(std::array<int, 2> e, std::array<int, 2> f) {
  const Polynomial a{{{0, 0}, 1}, {{1, 0}, -1}, {{0, 1}, -1}}, b{{{1, 0}, 1}}, c{{{0, 1}, 1}};
  std::vector<Function> functions;
  const auto push = [&](const Polynomial& p, int along_e, int along_f) {
    functions.push_back({p * Polynomial{{{0, 0}, mpq_class(1, 12)}}, along_e * e[0] + along_f * f[0],
                         along_e * e[1] + along_f * f[1]});
  };
  struct Term {
    int factor;
    unsigned u, v, w;
  };
  const auto sum = [](const std::vector<Term>& terms, const Polynomial& u, const Polynomial& v,
                      const Polynomial& w) {
    Polynomial result;
    for (const Term& t : terms) add(result, t.factor, power(u, t.u) * power(v, t.v) * power(w, t.w));
    return result;
  };
  const std::vector<Term> corner{{6, 4, 0, 0},  {24, 3, 0, 1}, {24, 2, 0, 2}, {8, 1, 0, 3}, {1, 0, 0, 4},
                                 {24, 3, 1, 0}, {60, 2, 1, 1}, {36, 1, 1, 2}, {6, 0, 1, 3}, {24, 2, 2, 0},
                                 {36, 1, 2, 1}, {12, 0, 2, 2}, {8, 1, 3, 0},  {6, 0, 3, 1}, {1, 0, 4, 0}},
      across{{1, 4, 0, 0}, {2, 3, 0, 1}, {6, 3, 1, 0}, {6, 2, 1, 1}, {12, 2, 2, 0},
             {6, 1, 2, 1}, {6, 1, 3, 0}, {2, 0, 3, 1}, {1, 0, 4, 0}},
      beyond{{1, 4, 0, 0}, {2, 3, 1, 0}};
  push(sum(corner, a, b, c), 0, 0);
  push(sum(corner, b, c, a), 1, 0);
  push(sum(corner, c, a, b), 0, 1);
  push(sum(across, a, b, c), 1, -1);
  push(sum(across, b, c, a), 1, 1);
  push(sum(across, c, a, b), -1, 1);
  push(sum(beyond, a, b, c), 0, -1);
  push(sum(beyond, a, c, b), -1, 0);
  push(sum(beyond, b, c, a), 2, 0);
  push(sum(beyond, b, a, c), 2, -1);
  push(sum(beyond, c, a, b), -1, 2);
  push(sum(beyond, c, b, a), 0, 2);
  return functions;
}

void add_patch(const std::array<Polynomial, 3>& x, bool triangle, Moments<mpq_class>& sum) {
  std::array<Polynomial, 3> u, v;
  for (std::size_t a = 0; a < 3; ++a) {
    u[a] = derivative(x[a], false);
    v[a] = derivative(x[a], true);
  }
  Polynomial flux;
  for (std::size_t a = 0; a < 3; ++a) {
    const std::size_t b = (a + 1) % 3, c = (a + 2) % 3;
    add(flux, 1, x[a] * (u[b] * v[c]));
    add(flux, -1, x[a] * (u[c] * v[b]));
  }
  sum[0] += integral(flux, triangle) / 3;
  for (std::size_t a = 0; a < 3; ++a) sum[1 + a] += integral(x[a] * flux, triangle) / 4;
  for (std::size_t k = 0; k < 6; ++k) {
    sum[4 + k] += integral(x[kPairs[k][0]] * (x[kPairs[k][1]] * flux), triangle) / 5;
  }
}

}  // namespace

MeasureValues polyhedron_measures(const TaggedMesh& mesh) {
  if (mesh.points.empty()) throw std::invalid_argument("no points");
  PolyhedronSum sum(place(mesh.points[0]));
  for (const auto& polygon : mesh.polygons) {
    const std::size_t n = polygon.size();
    const auto at = [&](std::size_t k) { return place(mesh.points[polygon[k % n]]); };
    if (n == 3) {
      sum.add(at(0), at(1), at(2));
      continue;
    }
    Place middle{};
    for (std::size_t k = 0; k < n; ++k) {
      for (std::size_t x = 0; x < 3; ++x) middle[x] += at(k)[x] / static_cast<Long>(n);
    }
    for (std::size_t k = 0; k < n; ++k) sum.add(at(k), at(k + 1), middle);
  }
  return sum.result();
}

AreaEstimate limit_area(const TaggedMesh& mesh, const Rules& rules, int levels) {
  std::array<Long, 3> at;
  for (int k = 0; k < 3; ++k) {
    TaggedMesh fine = refine(mesh, rules, levels - 2 + k), with_surface = fine;
    with_surface.polygons.clear();
    std::sort(fine.holes.begin(), fine.holes.end());
    for (std::uint32_t f = 0; f < fine.polygons.size(); ++f) {
      const bool hole = std::binary_search(fine.holes.begin(), fine.holes.end(), f);
      if (!hole) with_surface.polygons.push_back(fine.polygons[f]);
    }
    at[static_cast<std::size_t>(k)] =
        with_surface.polygons.empty() ? 0 : polyhedron_measures(with_surface)[0];
  }
  const Long before = at[1] + (at[1] - at[0]) / 3, last = at[2] - at[1], value = at[2] + last / 3;
  return {value, 3 * std::fabs(value - before) + std::fabs(last) / 5 + 1e-12L * value};
}

MeasureEstimate limit_measures(const TaggedMesh& mesh, const WindingScheme& scheme, int levels) {
  std::array<MeasureValues, 3> at;
  for (int k = 0; k < 3; ++k) {
    at[static_cast<std::size_t>(k)] = polyhedron_measures(WindingTwin(mesh, scheme, levels - 2 + k).mesh());
  }
  MeasureEstimate estimate;
  for (std::size_t m = 0; m < kMeasures; ++m) {
    const Long before = at[1][m] + (at[1][m] - at[0][m]) / 3, last = at[2][m] - at[1][m];
    estimate.value[m] = at[2][m] + last / 3;
    estimate.error[m] = 3 * std::fabs(estimate.value[m] - before) + std::fabs(last) / 20 +
                        1e-12L * std::fabs(estimate.value[m]) + 1e-15L;
  }
  return estimate;
}

std::array<mpq_class, kMeasures - 1> exact_measures(PeriodicBasis basis, std::uint32_t m, std::uint32_t n,
                                                    const std::vector<Point>& points) {
  if (points.size() != std::size_t{m} * n) throw std::invalid_argument("not so many points");
  const bool triangle = basis == PeriodicBasis::box_spline;
  std::vector<std::vector<Function>> patches;
  if (triangle) {
    patches = {box_spline_functions({1, 0}, {1, 1}), box_spline_functions({1, 1}, {0, 1})};
  } else {
    patches = {tensor_functions(basis == PeriodicBasis::bilinear      ? 1
                                : basis == PeriodicBasis::biquadratic ? 2
                                                                      : 3)};
  }
  Moments<mpq_class> sum;
  for (std::uint32_t i = 0; i < m; ++i) {
    for (std::uint32_t j = 0; j < n; ++j) {
      for (const std::vector<Function>& functions : patches) {
        std::array<Polynomial, 3> x;
        for (const Function& f : functions) {
          const auto row = static_cast<std::size_t>((static_cast<int>(i + m) + f.i) % static_cast<int>(m)),
                     column = static_cast<std::size_t>((static_cast<int>(j + n) + f.j) % static_cast<int>(n));
          const Point& p = points[row * n + column];
          for (std::size_t a = 0; a < 3; ++a) add(x[a], mpq_class(p[a]), f.value);
        }
        add_patch(x, triangle, sum);
      }
    }
  }
  return about_centroid(sum);
}

}  // namespace oracle
