#include "bezier.h"

#include <map>
#include <utility>

#include "rejected.h"

namespace checker {
namespace {

double factorial(unsigned n) { return n < 2 ? 1 : n * factorial(n - 1); }

std::vector<Exponents> all_exponents(unsigned degree) {
  std::vector<Exponents> all;
  for (unsigned j = 0; j <= degree; ++j) {
    for (unsigned i = 0; i + j <= degree; ++i) all.push_back({degree - i - j, i, j});
  }
  return all;
}

// The inverse of the matrix of Bernstein polynomials at the lattice points, by elimination.
std::vector<Row> invert_bernstein(unsigned degree) {
  const std::vector<Exponents>& points = exponents(degree);
  const std::size_t count = points.size();
  std::vector<Row> left(count, Row(count)), right(count, Row(count));
  for (std::size_t q = 0; q < count; ++q) {
    std::array<Real, 3> weights;
    for (std::size_t k = 0; k < 3; ++k) weights[k] = Real(points[q][k]) / Real(degree);
    for (std::size_t p = 0; p < count; ++p) left[q][p] = bernstein(points[p], weights);
    right[q][q] = 1;
  }
  for (std::size_t c = 0; c < count; ++c) {
    std::size_t pivot = c;
    for (std::size_t r = c; r < count; ++r) {
      if (left[r][c].magnitude().approximately() > left[pivot][c].magnitude().approximately()) pivot = r;
    }
    std::swap(left[c], left[pivot]);
    std::swap(right[c], right[pivot]);
    if (!left[c][c].magnitude().certainly_positive()) throw Rejected("the Bernstein matrix was not inverted");
    const Real scale = Real(1) / left[c][c];
    for (std::size_t k = 0; k < count; ++k) {
      left[c][k] = left[c][k] * scale;
      right[c][k] = right[c][k] * scale;
    }
    for (std::size_t r = 0; r < count; ++r) {
      if (r == c || left[r][c].is_exactly_zero()) continue;
      const Real factor = left[r][c];
      for (std::size_t k = 0; k < count; ++k) {
        left[r][k] = left[r][k] - factor * left[c][k];
        right[r][k] = right[r][k] - factor * right[c][k];
      }
    }
  }
  return right;
}

}  // namespace

const std::vector<Exponents>& exponents(unsigned degree) {
  static const std::array<std::vector<Exponents>, 3> all{all_exponents(2), all_exponents(4),
                                                         all_exponents(6)};
  if (degree != 2 && degree != 4 && degree != 6) throw Rejected("a degree that no scheme has");
  return all[degree / 2 - 1];
}

const std::vector<Row>& bezier_from_values(unsigned degree) {
  static const std::array<std::vector<Row>, 3> all{invert_bernstein(2), invert_bernstein(4),
                                                   invert_bernstein(6)};
  if (degree != 2 && degree != 4 && degree != 6) throw Rejected("a degree that no scheme has");
  return all[degree / 2 - 1];
}

Real bernstein(const Exponents& p, const std::array<Real, 3>& weights) {
  Real value = factorial(p[0] + p[1] + p[2]) / (factorial(p[0]) * factorial(p[1]) * factorial(p[2]));
  for (std::size_t k = 0; k < 3; ++k) {
    for (unsigned i = 0; i < p[k]; ++i) value = value * weights[k];
  }
  return value;
}

std::vector<BezierTriangle> bezier_triangles(const Piece& piece) {
  constexpr unsigned degree = 4;
  std::map<Place, Row> limits;
  const auto add = [&](const Piece& p) {
    for (std::size_t k = 0; k < 3; ++k) {
      if (!limits.contains(p.places[k])) limits.emplace(p.places[k], limit(p, k));
    }
  };
  add(piece);
  for (const Piece& half : split(piece)) {
    add(half);
    for (const Piece& quarter : split(half)) add(quarter);
  }
  const std::vector<Exponents>& lattice = exponents(degree);
  std::vector<const Row*> values;
  for (const Exponents& q : lattice) {
    Place place{0, 0};
    for (std::size_t k = 0; k < 3; ++k) {
      for (std::size_t x = 0; x < 2; ++x) place[x] += q[k] * (piece.places[k][x] / 4);
    }
    values.push_back(&limits.at(place));
  }
  BezierTriangle triangle{degree, piece.places, std::vector<Row>(lattice.size())};
  for (std::size_t p = 0; p < lattice.size(); ++p) {
    triangle.points[p].resize(values[0]->size());
    for (std::size_t q = 0; q < lattice.size(); ++q) {
      for (std::size_t c = 0; c < triangle.points[p].size(); ++c)
        triangle.points[p][c].add_product(bezier_from_values(degree)[p][q], (*values[q])[c]);
    }
  }
  return {std::move(triangle)};
}

}  // namespace checker
