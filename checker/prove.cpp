#include "prove.h"

#include <snug/base/parallel.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <optional>
#include <string>
#include <utility>

#include "bezier.h"
#include "half_quad.h"
#include "rejected.h"

namespace checker {
namespace {

constexpr unsigned depth_limit = 26;
// The quartic's Bezier points, from its limits at the 15 points of a lattice of step 1/4.
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

  // Is some stored row certainly within entry_error of this one, in the sum of absolute values? Only rows
  // whose image of one functional is close are looked at: one more overlooked is a match not found, no false
  // one.
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

  // A Piece of Loop, or a HalfQuad.
  template <class AnyPiece>
  void prove(const AnyPiece& piece) {
    const bool proved = piece.polynomial() ? prove_polynomial(piece) : prove_net(piece);
    if (proved) {
      ++proof_.pieces;
      proof_.depth = std::max(proof_.depth, piece.depth);
      return;
    }
    if (piece.depth >= depth_limit) throw Rejected("a piece is in no hull of stored rows at any level");
    for (const AnyPiece& child : split(piece)) prove(child);
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
  template <class AnyPiece>
  bool prove_net(const AnyPiece& piece) {
    const bool all = std::all_of(piece.rows.begin(), piece.rows.end(),
                                 [&](const auto& row) { return stored_.match(*row); });
    if (!all) return false;
    for (const auto& row : piece.rows) keep(*row);
    return true;
  }

  // The inner points must be stored, and all where there are none. Those on edges may else be covered, which
  // is decided in the end.
  template <class AnyPiece>
  bool prove_polynomial(const AnyPiece& piece) {
    const std::vector<BezierTriangle> triangles = bezier_triangles(piece);
    std::vector<std::vector<bool>> found;
    for (const BezierTriangle& triangle : triangles) {
      const std::vector<Exponents>& all = exponents(triangle.degree);
      found.emplace_back();
      for (std::size_t p = 0; p < all.size(); ++p) {
        found.back().push_back(stored_.match(triangle.points[p]));
        const bool inner = all[p][0] > 0 && all[p][1] > 0 && all[p][2] > 0;
        if ((inner || triangle.degree < 3) && !found.back().back()) return false;
      }
    }
    for (std::size_t t = 0; t < triangles.size(); ++t) keep_polynomial(triangles[t], found[t]);
    return true;
  }

  void keep_polynomial(const BezierTriangle& triangle, const std::vector<bool>& found) {
    const std::vector<Exponents>& all = exponents(triangle.degree);
    const auto edge = [&](std::size_t k) {  // that faces corner k
      return Segment{triangle.places[(k + 1) % 3], triangle.places[(k + 2) % 3]};
    };
    for (std::size_t k = 0; k < 3; ++k) {
      bool whole = true;
      for (std::size_t p = 0; p < all.size(); ++p) whole = whole && (all[p][k] > 0 || found[p]);
      if (whole) whole_edges_.push_back(edge(k));
    }
    for (std::size_t p = 0; p < all.size(); ++p) {
      if (found[p]) {
        keep(triangle.points[p]);
        continue;
      }
      missing_.emplace_back();
      for (std::size_t k = 0; k < 3; ++k) {
        if (all[p][k] == 0) missing_.back().push_back(edge(k));
      }
    }
  }

  void keep(const Row& row) {
    Real sum;
    for (const Real& weight : row) sum += weight;
    if (!sum.may_be(1)) throw Rejected("a row that does not sum to 1");
    proof_.hull.push_back(row);
  }

  StoredRows stored_;
  RowsProof proof_;
  std::vector<Segment> whole_edges_;           // all Bezier points along them stored
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
  RowsProver prover(kind);
  const auto prove = [&](const auto& root) {
    if (root.rows.size() != kind.controls)
      throw Rejected("another number of control points than the key gives");
    prove_sums(kind);
    prover.prove(root);
  };
  Shapes shapes;
  if (kind.scheme == Scheme::loop) {
    prove(root_piece(kind.key));
  } else {
    prove(root_half(shapes, kind.scheme, kind.key));
  }
  return prover.take();
}

void prove_table(const StoredTable& table, Scheme scheme, const RowsProof& rows) {
  const std::size_t first = first_bounded(scheme);
  const std::vector<std::array<double, 2>> corners{{0, 0}, {1, 0}, {0, 1}};
  if (!std::equal(corners.begin(), corners.begin() + static_cast<std::ptrdiff_t>(first),
                  table.layout.begin()))
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
    for (std::size_t c = first; c < row.size(); ++c) {
      const Real value = row[c] * area;
      if (!plane(table.upper[c - first]).certainly_at_least(value) ||
          !value.certainly_at_least(plane(table.lower[c - first])))
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
  const auto prove = [&](const KeptByThread&, std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const StoredKind& kind = file.kinds[i];
      try {
        outcomes[i].rows = prove_rows(kind);
        for (const StoredTable& table : kind.tables) prove_table(table, kind.scheme, outcomes[i].rows);
        outcomes[i].rows.hull.clear();
      } catch (const Rejected& rejected) {
        outcomes[i].failure =
            "kind " + std::to_string(i) + ", " + to_text(kind.scheme, kind.key) + ": " + rejected.what();
      }
    }
  };
  snug::parallel_for_with(
      file.kinds.size(), 0, [] { return KeptByThread(); }, prove);
  FileProof proof;
  for (std::size_t i = 0; i < file.kinds.size(); ++i) {
    const Outcome& outcome = outcomes[i];
    if (outcome.failure) throw Rejected(*outcome.failure);
    for (std::size_t k = 0; k < i; ++k) {
      if (file.kinds[k].scheme == file.kinds[i].scheme && file.kinds[k].key == file.kinds[i].key)
        throw Rejected("a key that comes twice: " + to_text(file.kinds[i].scheme, file.kinds[i].key));
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
