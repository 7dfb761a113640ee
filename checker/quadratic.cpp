#include "quadratic.h"

#include "bezier.h"
#include "rejected.h"

namespace checker {
namespace {

// The Bernstein polynomials of degree 2: their values are the weights of the value there.
SixReals weights_at(const Parameter& t) {
  const std::array<Real, 3> l{Real(1) - t[0] - t[1], t[0], t[1]};
  SixReals weights;
  for (std::size_t k = 0; k < 3; ++k) {
    weights[k] = l[k] * l[k];
    weights[3 + k] = Real(2) * l[k] * l[(k + 1) % 3];
  }
  return weights;
}

}  // namespace

Parameter parameter_of(const Place& place) {
  constexpr double unit = 1.0 / (std::int64_t{1} << place_bits);
  return {Real(static_cast<double>(place[0]) * unit), Real(static_cast<double>(place[1]) * unit)};
}

Parameter raised_parameter(const std::array<Place, 3>& piece, const std::array<unsigned, 3>& exponents) {
  Parameter t;
  const Real degree = exponents[0] + exponents[1] + exponents[2];
  for (std::size_t k = 0; k < 3; ++k) {
    const Parameter corner = parameter_of(piece[k]);
    for (std::size_t x = 0; x < 2; ++x) t[x] += corner[x] * Real(exponents[k]) / degree;
  }
  return t;
}

std::vector<SixReals> raised_quadratic(const std::array<Place, 3>& piece, unsigned degree) {
  const std::vector<Exponents>& lattice = exponents(degree);
  std::vector<SixReals> values, points(lattice.size());
  for (const Exponents& q : lattice) values.push_back(weights_at(raised_parameter(piece, q)));
  for (std::size_t p = 0; p < lattice.size(); ++p) {
    for (std::size_t q = 0; q < lattice.size(); ++q) {
      for (std::size_t k = 0; k < 6; ++k)
        points[p][k].add_product(bezier_from_values(degree)[p][q], values[q][k]);
    }
  }
  return points;
}

// The middle one of an edge's three Bezier points is twice the value there less the mean of the others.
std::array<SixReals, 6> restricted_quadratic(const std::array<Place, 3>& piece) {
  std::array<SixReals, 6> points;
  for (std::size_t k = 0; k < 3; ++k) points[k] = weights_at(parameter_of(piece[k]));
  for (std::size_t k = 0; k < 3; ++k) {
    const std::size_t next = (k + 1) % 3;
    Place middle;
    for (std::size_t x = 0; x < 2; ++x) {
      const std::int64_t sum = piece[k][x] + piece[next][x];
      if (sum % 2 != 0) throw Rejected("too many levels");
      middle[x] = sum / 2;
    }
    const SixReals value = weights_at(parameter_of(middle));
    for (std::size_t i = 0; i < 6; ++i)
      points[3 + k][i] = Real(2) * value[i] - Real(0.5) * (points[k][i] + points[next][i]);
  }
  return points;
}

}  // namespace checker
