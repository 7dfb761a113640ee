#include "prove.h"

#include <snug/base/parallel.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <optional>
#include <string>
#include <utility>

#include "rejected.h"

namespace checker {
namespace {

constexpr unsigned depth_limit = 26;
constexpr std::size_t point_count = 15;

// The exponents (i, j, k) of a quartic triangle's Bezier points, i + j + k = 4; corner 1 is u, corner 2 is v.
using Exponents = std::array<unsigned, 3>;  // of corners 0, 1, 2
constexpr std::array<Exponents, point_count> exponents = [] {
  std::array<Exponents, point_count> all{};
  std::size_t count = 0;
  for (unsigned j = 0; j < 5; ++j) {
    for (unsigned i = 0; i + j < 5; ++i) all[count++] = {4 - i - j, i, j};
  }
  return all;
}();

double factorial(unsigned n) { return n < 2 ? 1 : n * factorial(n - 1); }

// Value at the lattice point q/4 of the Bernstein polynomial p; exact in doubles.
double bernstein(const Exponents& p, const Exponents& q) {
  double value = factorial(4) / (factorial(p[0]) * factorial(p[1]) * factorial(p[2]));
  for (std::size_t k = 0; k < 3; ++k) value *= std::pow(q[k] / 4.0, static_cast<double>(p[k]));
  return value;
}

using Square = std::array<std::array<Real, point_count>, point_count>;

// From values at the 15 lattice points to Bezier points: the inverse of the matrix of Bernstein polynomials.
Square invert_bernstein() {
  Square left, right;
  for (std::size_t q = 0; q < point_count; ++q) {
    for (std::size_t p = 0; p < point_count; ++p) left[q][p] = bernstein(exponents[p], exponents[q]);
    right[q][q] = 1;
  }
  for (std::size_t c = 0; c < point_count; ++c) {
    std::size_t pivot = c;
    for (std::size_t r = c; r < point_count; ++r) {
      if (left[r][c].magnitude().approximately() > left[pivot][c].magnitude().approximately()) pivot = r;
    }
    std::swap(left[c], left[pivot]);
    std::swap(right[c], right[pivot]);
    if (!left[c][c].magnitude().certainly_positive()) throw Rejected("the Bernstein matrix was not inverted");
    const Real scale = Real(1) / left[c][c];
    for (std::size_t k = 0; k < point_count; ++k) {
      left[c][k] = left[c][k] * scale;
      right[c][k] = right[c][k] * scale;
    }
    for (std::size_t r = 0; r < point_count; ++r) {
      if (r == c) continue;
      const Real factor = left[r][c];
      for (std::size_t k = 0; k < point_count; ++k) {
        left[r][k] = left[r][k] - factor * left[c][k];
        right[r][k] = right[r][k] - factor * right[c][k];
      }
    }
  }
  return right;
}

// The quartic's Bezier points, from its limits at the 15 points of a lattice of step 1/4.
std::array<Row, point_count> bezier_rows(const Piece& piece) {
  static const Square from_values = invert_bernstein();
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
  std::array<const Row*, point_count> values{};
  for (std::size_t q = 0; q < point_count; ++q) {
    Place place{0, 0};
    for (std::size_t k = 0; k < 3; ++k) {
      for (std::size_t x = 0; x < 2; ++x) place[x] += exponents[q][k] * (piece.places[k][x] / 4);
    }
    values[q] = &limits.at(place);
  }
  std::array<Row, point_count> rows;
  for (std::size_t p = 0; p < point_count; ++p) {
    rows[p].resize(values[0]->size());
    for (std::size_t q = 0; q < point_count; ++q) {
      for (std::size_t c = 0; c < rows[p].size(); ++c)
        rows[p][c].add_product(from_values[p][q], (*values[q])[c]);
    }
  }
  return rows;
}

// Finds the stored row that an exact row is.
class StoredRows {
 public:
  explicit StoredRows(const StoredKind& kind) : kind_(kind) {
    for (std::size_t r = 0; r < kind.rows; ++r) {
      double sum = 0;
      for (std::size_t c = 0; c < kind.controls; ++c) sum += probe(c) * kind.weight(r, c);
      by_probe_.emplace(sum, r);
    }
  }

  // Is some stored row certainly within entry_error of this one, in the sum of absolute values? Only rows whose
  // image of one functional is close are looked at: one more overlooked is a match not found, no false one.
  [[nodiscard]] bool match(const Row& row) const {
    double sum = 0;
    for (std::size_t c = 0; c < row.size(); ++c) sum += probe(c) * row[c].approximately();
    const double reach = 2 * kind_.entry_error + 1e-12;
    for (auto it = by_probe_.lower_bound(sum - reach); it != by_probe_.end() && it->first <= sum + reach;
         ++it) {
      Real distance;
      for (std::size_t c = 0; c < row.size(); ++c)
        distance += (row[c] - kind_.weight(it->second, c)).magnitude();
      if (Real(kind_.entry_error).certainly_at_least(distance)) return true;
    }
    return false;
  }

 private:
  // Any numbers in [-1, 1] that keep different rows apart.
  static double probe(std::size_t control) { return std::sin(1.0 + 2.0 * static_cast<double>(control)); }

  const StoredKind& kind_;
  std::multimap<double, std::size_t> by_probe_;
};

using Segment = std::array<Place, 2>;

bool on(const Place& p, const Segment& s) {
  const std::int64_t dx = s[1][0] - s[0][0], dy = s[1][1] - s[0][1];
  if (dx * (p[1] - s[0][1]) != dy * (p[0] - s[0][0])) return false;
  for (std::size_t x = 0; x < 2; ++x) {
    if (p[x] < std::min(s[0][x], s[1][x]) || p[x] > std::max(s[0][x], s[1][x])) return false;
  }
  return true;
}

class RowsProver {
 public:
  explicit RowsProver(const StoredKind& kind) : stored_(kind) {}

  void prove(const Piece& piece) {
    const bool proved = piece.polynomial() ? prove_polynomial(piece) : prove_net(piece);
    if (proved) {
      ++proof_.pieces;
      proof_.depth = std::max(proof_.depth, piece.depth);
      return;
    }
    if (piece.depth >= depth_limit) throw Rejected("a piece is in no hull of stored rows at any level");
    for (const Piece& child : split(piece)) prove(child);
  }

  // After all pieces: what is missing on edges must be covered.
  [[nodiscard]] RowsProof take() {
    for (const std::vector<Segment>& edges : missing_) {
      const bool covered = std::any_of(edges.begin(), edges.end(), [&](const Segment& edge) {
        return std::any_of(whole_edges_.begin(), whole_edges_.end(),
                           [&](const Segment& whole) { return on(edge[0], whole) && on(edge[1], whole); });
      });
      if (!covered) throw Rejected("a Bezier point is neither stored nor on an edge whose points are");
    }
    proof_.covered = missing_.size();
    return std::move(proof_);
  }

 private:
  bool prove_net(const Piece& piece) {
    const bool all = std::all_of(piece.rows.begin(), piece.rows.end(),
                                 [&](const auto& row) { return stored_.match(*row); });
    if (!all) return false;
    for (const auto& row : piece.rows) keep(*row);
    return true;
  }

  // The inner points must be stored; those on edges may be covered, which is decided in the end.
  bool prove_polynomial(const Piece& piece) {
    const std::array<Row, point_count> rows = bezier_rows(piece);
    std::array<bool, point_count> found{};
    for (std::size_t p = 0; p < point_count; ++p) found[p] = stored_.match(rows[p]);
    std::array<bool, 3> whole{true, true, true};  // edges, by the corner they face
    for (std::size_t p = 0; p < point_count; ++p) {
      if (found[p]) continue;
      if (exponents[p][0] > 0 && exponents[p][1] > 0 && exponents[p][2] > 0) return false;
      for (std::size_t k = 0; k < 3; ++k) whole[k] = whole[k] && exponents[p][k] > 0;
    }
    const auto edge = [&](std::size_t k) {
      return Segment{piece.places[(k + 1) % 3], piece.places[(k + 2) % 3]};
    };
    for (std::size_t k = 0; k < 3; ++k) {
      if (whole[k]) whole_edges_.push_back(edge(k));
    }
    for (std::size_t p = 0; p < point_count; ++p) {
      if (found[p]) {
        keep(rows[p]);
        continue;
      }
      missing_.emplace_back();
      for (std::size_t k = 0; k < 3; ++k) {
        if (exponents[p][k] == 0) missing_.back().push_back(edge(k));
      }
    }
    return true;
  }

  void keep(const Row& row) {
    Real sum;
    for (const Real& weight : row) sum += weight;
    if (!sum.may_be(1)) throw Rejected("a row that does not sum to 1");
    proof_.hull.push_back(row);
  }

  StoredRows stored_;
  RowsProof proof_;
  std::vector<Segment> whole_edges_;           // all five Bezier points stored
  std::vector<std::vector<Segment>> missing_;  // for each point not stored, the edges it lies on
};

// What is promised of the stored numbers alone.
void prove_sums(const StoredKind& kind) {
  for (std::size_t r = 0; r < kind.rows; ++r) {
    Real sum, magnitude;
    for (std::size_t c = 0; c < kind.controls; ++c) {
      sum += Real(kind.weight(r, c));
      magnitude += Real(kind.weight(r, c)).magnitude();
    }
    if (!Real(kind.entry_error).certainly_at_least((sum - 1).magnitude()))
      throw Rejected("stored row " + std::to_string(r) + " does not sum to 1 within entry_error");
    if (!Real(kind.abs_sum).certainly_at_least(magnitude))
      throw Rejected("stored row " + std::to_string(r) + " has a larger sum of absolute values than abs_sum");
  }
}

using Planar = std::array<Real, 2>;

Real cross(const Planar& origin, const Planar& a, const Planar& b) {
  return (a[0] - origin[0]) * (b[1] - origin[1]) - (a[1] - origin[1]) * (b[0] - origin[0]);
}

}  // namespace

RowsProof prove_rows(const StoredKind& kind) {
  if (kind.scheme != 0) throw Rejected("a scheme that is not Loop's");
  const Piece root = root_piece(kind.key);
  if (root.rows.size() != kind.controls)
    throw Rejected("another number of control points than the key gives");
  prove_sums(kind);
  RowsProver prover(kind);
  prover.prove(root);
  return prover.take();
}

void prove_table(const StoredTable& table, const RowsProof& rows) {
  const std::vector<std::array<double, 2>> corners{{0, 0}, {1, 0}, {0, 1}};
  if (!std::equal(corners.begin(), corners.end(), table.layout.begin()))
    throw Rejected("a layout whose corners are not (0,0), (1,0), (0,1)");
  std::array<Planar, 3> triangle;
  for (std::size_t k = 0; k < 3; ++k) triangle[k] = {table.triangle[k][0], table.triangle[k][1]};
  const Real area = cross(triangle[0], triangle[1], triangle[2]);
  if (!area.certainly_positive()) throw Rejected("a triangle that is not counter-clockwise");
  for (const Row& row : rows.hull) {
    Planar u;
    for (std::size_t c = 0; c < row.size(); ++c) {
      for (std::size_t x = 0; x < 2; ++x) u[x].add_product(row[c], table.layout[c][x]);
    }
    std::array<Real, 3> part;  // of the area: barycentric coordinates of u
    for (std::size_t k = 0; k < 3; ++k) {
      part[k] = cross(u, triangle[(k + 1) % 3], triangle[(k + 2) % 3]);
      if (!part[k].certainly_at_least(0)) throw Rejected("a domain point outside the triangle");
    }
    const auto plane = [&](const StoredTable::Plane& values) {
      return part[0] * Real(values[0]) + part[1] * Real(values[1]) + part[2] * Real(values[2]);
    };
    for (std::size_t c = 3; c < row.size(); ++c) {
      const Real value = row[c] * area;
      if (!plane(table.upper[c - 3]).certainly_at_least(value) ||
          !value.certainly_at_least(plane(table.lower[c - 3])))
        throw Rejected("a plane of control point " + std::to_string(c) + " that cuts its function's hull");
    }
  }
}

FileProof prove_file(std::span<const std::byte> bytes) {
  const BoundsFile file = parse(bytes);
  struct Outcome {
    RowsProof rows;
    std::optional<std::string> failure;
  };
  std::vector<Outcome> outcomes(file.kinds.size());
  snug::parallel_for(file.kinds.size(), 0, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const StoredKind& kind = file.kinds[i];
      try {
        outcomes[i].rows = prove_rows(kind);
        for (const StoredTable& table : kind.tables) prove_table(table, outcomes[i].rows);
        outcomes[i].rows.hull.clear();
      } catch (const Rejected& rejected) {
        outcomes[i].failure = "kind " + std::to_string(i) + " " + to_text(kind.key) + ": " + rejected.what();
      }
    }
  });
  FileProof proof;
  for (std::size_t i = 0; i < file.kinds.size(); ++i) {
    const Outcome& outcome = outcomes[i];
    if (outcome.failure) throw Rejected(*outcome.failure);
    for (std::size_t k = 0; k < i; ++k) {
      if (file.kinds[k].key == file.kinds[i].key)
        throw Rejected("a key that comes twice: " + to_text(file.kinds[i].key));
    }
    ++proof.kinds;
    proof.tables += file.kinds[i].tables.size();
    proof.stored_rows += file.kinds[i].rows;
    proof.pieces += outcome.rows.pieces;
    proof.covered += outcome.rows.covered;
    proof.depth = std::max(proof.depth, outcome.rows.depth);
  }
  return proof;
}

}  // namespace checker
