#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <string>
#include <utility>

#include "bezier.h"
#include "half_quad.h"
#include "prove.h"
#include "quadratic.h"
#include "rejected.h"

namespace checker {
namespace {

constexpr unsigned depth_limit = 26;
// Sixteen roundoffs: how much the weights of a quadratic's Bezier point may be off, in the sum of absolute
// values.
constexpr double weights_error = 0x1p-49;

bool any_row(std::size_t) { return true; }

// Finds the stored row that an exact row is.
class RowFinder {
 public:
  explicit RowFinder(const StoredRows& stored) : stored_(stored) {
    for (std::size_t r = 0; r < stored.rows; ++r) {
      double sum = 0;
      for (std::size_t c = 0; c < stored.controls; ++c) sum += probe(c) * stored.weight(r, c);
      by_probe_.emplace(sum, r);
    }
  }

  // Is stored row r certainly within entry_error of this one, in the sum of absolute values?
  [[nodiscard]] bool is(const Row& row, std::size_t r) const {
    Real distance;
    for (std::size_t c = 0; c < row.size(); ++c) distance += (row[c] - stored_.weight(r, c)).magnitude();
    return Real(stored_.entry_error).certainly_at_least(distance);
  }

  // Is some stored row this one and suits? Only rows whose image of one functional is close are looked at: one
  // more overlooked is a match not found, no false one.
  template <class Suits>
  [[nodiscard]] bool match(const Row& row, const Suits& suits) const {
    double sum = 0;
    for (std::size_t c = 0; c < row.size(); ++c) sum += probe(c) * row[c].approximately();
    const double reach = 2 * stored_.entry_error + 1e-12;
    for (auto it = by_probe_.lower_bound(sum - reach); it != by_probe_.end() && it->first <= sum + reach;
         ++it) {
      if (suits(it->second) && is(row, it->second)) return true;
    }
    return false;
  }

 private:
  // Any numbers in [-1, 1] that keep different rows apart.
  static double probe(std::size_t control) { return std::sin(1.0 + 2.0 * static_cast<double>(control)); }

  const StoredRows& stored_;
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

// Proves that stored rows are bounding rows; those of a comparison also that they are so together with the points
// of any quadratic, but for the pieces that it has nets of.
class RowsProver {
 public:
  explicit RowsProver(const StoredRows& stored, const StoredComparison* comparison = nullptr)
      : stored_(stored), finder_(stored), comparison_(comparison) {}

  // A Piece of Loop, or a HalfQuad.
  template <class AnyPiece>
  void prove(const AnyPiece& piece) {
    const bool proved = piece.polynomial() ? prove_polynomial(piece)
                        : comparison_      ? is_stored_net(piece)
                                           : prove_net(piece);
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
                                 [&](const auto& row) { return finder_.match(*row, any_row); });
    if (!all) return false;
    for (const auto& row : piece.rows) keep(*row);
    return true;
  }

  // Stored in the order of the net's kind, with what restricts a quadratic to the piece.
  template <class AnyPiece>
  bool is_stored_net(const AnyPiece& piece) {
    return std::any_of(comparison_->nets.begin(), comparison_->nets.end(), [&](const StoredNet& net) {
      for (std::size_t first = 0; first < 3; ++first) {
        const std::vector<const Row*> rows = net_of(piece, net.key, first);
        const std::size_t end = stored_.rows;
        if (rows.empty() || net.first > end || rows.size() > end - net.first) continue;
        bool is = restricts(
            net, {piece.places[first], piece.places[(first + 1) % 3], piece.places[(first + 2) % 3]});
        for (std::size_t i = 0; i < rows.size() && is; ++i) is = finder_.is(*rows[i], net.first + i);
        if (is) return true;
      }
      return false;
    });
  }

  static bool restricts(const StoredNet& net, const std::array<Place, 3>& places) {
    const std::array<SixReals, 6> exact = restricted_quadratic(places);
    for (std::size_t k = 0; k < 6; ++k) {
      for (std::size_t i = 0; i < 6; ++i) {
        if (!(exact[k][i] - Real(net.restriction[k][i])).is_exactly_zero()) return false;
      }
    }
    return true;
  }

  // Which Bezier points of a triangle are stored, those of any quadratic with them.
  [[nodiscard]] std::vector<bool> found_of(const BezierTriangle& triangle) const {
    std::vector<bool> found;
    if (!comparison_) {
      for (const Row& point : triangle.points) found.push_back(finder_.match(point, any_row));
      return found;
    }
    const std::vector<SixReals> exact = raised_quadratic(triangle.places, triangle.degree);
    for (std::size_t p = 0; p < exact.size(); ++p) {
      found.push_back(finder_.match(triangle.points[p], [&](std::size_t r) {
        if (r >= comparison_->quadratic.size()) return false;
        Real distance;
        for (std::size_t k = 0; k < 6; ++k)
          distance += (exact[p][k] - Real(comparison_->quadratic[r][k])).magnitude();
        return Real(weights_error).certainly_at_least(distance);
      }));
    }
    return found;
  }

  // The inner points must be stored, and all where there are none. Those on edges may else be covered, which
  // is decided in the end.
  template <class AnyPiece>
  bool prove_polynomial(const AnyPiece& piece) {
    const std::vector<BezierTriangle> triangles = bezier_triangles(piece);
    std::vector<std::vector<bool>> found;
    for (const BezierTriangle& triangle : triangles) {
      const std::vector<Exponents>& all = exponents(triangle.degree);
      found.push_back(found_of(triangle));
      for (std::size_t p = 0; p < all.size(); ++p) {
        const bool inner = all[p][0] > 0 && all[p][1] > 0 && all[p][2] > 0;
        if ((inner || triangle.degree < 3) && !found.back()[p]) return false;
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

  const StoredRows& stored_;
  RowFinder finder_;
  const StoredComparison* comparison_;
  RowsProof proof_;
  std::vector<Segment> whole_edges_;           // all Bezier points along them stored
  std::vector<std::vector<Segment>> missing_;  // for each point not stored, the edges it lies on
};

// Guarantees of the stored numbers alone.
void prove_sums(const StoredRows& stored) {
  for (std::size_t r = 0; r < stored.rows; ++r) {
    Real sum, magnitude;
    for (std::size_t c = 0; c < stored.controls; ++c) {
      sum += Real(stored.weight(r, c));
      magnitude += Real(stored.weight(r, c)).magnitude();
    }
    if (!Real(stored.entry_error).certainly_at_least((sum - 1).magnitude()))
      throw Rejected("stored row " + std::to_string(r) + " does not sum to 1 within entry_error");
    if (!Real(stored.abs_sum).certainly_at_least(magnitude))
      throw Rejected("stored row " + std::to_string(r) + " has a larger sum of absolute values than abs_sum");
  }
}

RowsProof prove(RowsProver prover, const StoredRows& stored, Scheme scheme, const Key& key) {
  const auto prove_root = [&](const auto& root) {
    if (root.rows.size() != stored.controls)
      throw Rejected("another number of control points than the key gives");
    prove_sums(stored);
    prover.prove(root);
  };
  Shapes shapes;
  if (scheme == Scheme::loop) {
    prove_root(root_piece(key));
  } else {
    prove_root(root_half(shapes, scheme, key));
  }
  return prover.take();
}

}  // namespace

RowsProof prove_rows(const StoredKind& kind) { return prove(RowsProver(kind), kind, kind.scheme, kind.key); }

void prove_comparison(const StoredComparison& comparison, Scheme scheme, const Key& key) {
  static_cast<void>(prove(RowsProver(comparison, &comparison), comparison, scheme, key));
}

}  // namespace checker
