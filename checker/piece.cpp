#include "piece.h"

#include <algorithm>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <utility>

#include "rejected.h"

namespace checker {
namespace {

using Edge = std::pair<std::size_t, std::size_t>;

// For each directed edge of a face the third vertex.
std::map<Edge, std::size_t> third_vertices(const std::vector<Piece::Face>& faces) {
  std::map<Edge, std::size_t> third;
  for (const Piece::Face& f : faces) {
    for (std::size_t i = 0; i < 3; ++i) {
      if (!third.emplace(Edge{f[i], f[(i + 1) % 3]}, f[(i + 2) % 3]).second)
        throw Rejected("a net in which an edge has two faces on one side");
    }
  }
  return third;
}

std::optional<std::size_t> find(const std::map<Edge, std::size_t>& third, std::size_t a, std::size_t b) {
  const auto it = third.find({a, b});
  return it == third.end() ? std::nullopt : std::optional(it->second);
}

Piece::Ring ring_around(const std::map<Edge, std::size_t>& third, std::size_t v, std::size_t start) {
  Piece::Ring ring;
  ring.vertices.push_back(start);
  for (std::size_t w = start;;) {
    const auto next = find(third, v, w);
    if (!next) break;
    if (*next == start) {
      ring.closed = true;
      return ring;
    }
    ring.vertices.push_back(w = *next);
  }
  std::vector<std::size_t> before;
  for (std::optional<std::size_t> w = find(third, start, v); w; w = find(third, *w, v)) before.push_back(*w);
  ring.own = before.size();
  ring.vertices.insert(ring.vertices.begin(), before.rbegin(), before.rend());
  return ring;
}

// A new point in the making.
class Sum {
 public:
  explicit Sum(const Piece& piece) : piece_(piece), row_(piece.rows.front()->size()) {}

  void add(const Real& weight, std::size_t vertex) {
    if (!weight.certainly_at_least(0)) throw Rejected("a mask with a negative weight");
    const Row& source = *piece_.rows[vertex];
    for (std::size_t c = 0; c < row_.size(); ++c) {
      if (!source[c].is_exactly_zero()) row_[c].add_product(weight, source[c]);
    }
  }
  [[nodiscard]] Row take() { return std::move(row_); }

 private:
  const Piece& piece_;
  Row row_;
};

// [Loop87]: the new place of a vertex of valence n is (1 - a) v + a (mean of its ring), a as here.
Real ring_share(std::size_t n) {
  const Real f = Real(3) + Real(2) * Real::cos_of_turn(static_cast<unsigned>(n));
  return Real(5) / Real(8) - f * f / Real(64);
}

// centre * v + each * (every vertex of the ring).
Row ring_sum(const Piece& piece, std::size_t v, const Piece::Ring& ring, const Real& centre,
             const Real& each) {
  Sum sum(piece);
  sum.add(centre, v);
  for (const std::size_t w : ring.vertices) sum.add(each, w);
  return sum.take();
}

// centre * v + each * (the two neighbours on the boundary).
Row curve_sum(const Piece& piece, std::size_t v, const Piece::Ring& ring, const Real& centre,
              const Real& each) {
  Sum sum(piece);
  sum.add(centre, v);
  sum.add(each, ring.vertices.front());
  sum.add(each, ring.vertices.back());
  return sum.take();
}

Row new_corner(const Piece& piece, std::size_t k) {
  const std::size_t v = piece.corners[k];
  if (piece.sharp[k]) return *piece.rows[v];
  const Piece::Ring ring = piece.ring(k);
  if (!ring.closed) return curve_sum(piece, v, ring, Real(3) / Real(4), Real(1) / Real(8));
  const std::size_t n = ring.vertices.size();
  const Real a = ring_share(n);
  return ring_sum(piece, v, ring, Real(1) - a, a / Real(static_cast<double>(n)));
}

Row new_edge_point(const Piece& piece, const std::map<Edge, std::size_t>& third, Edge edge) {
  const auto [a, b] = edge;
  const auto left = find(third, a, b), right = find(third, b, a);
  Sum sum(piece);
  const bool boundary = !left || !right;
  sum.add(boundary ? Real(0.5) : Real(0.375), a);
  sum.add(boundary ? Real(0.5) : Real(0.375), b);
  if (!boundary) {
    sum.add(0.125, *left);
    sum.add(0.125, *right);
  }
  return sum.take();
}

Place middle(const Place& a, const Place& b) { return {(a[0] + b[0]) / 2, (a[1] + b[1]) / 2}; }

// Across which vertex each edge 01, 12, 20 looks; nothing at a boundary. A corner of valence 3 makes its two
// the same.
std::array<std::optional<std::size_t>, 3> across_edges(const Key& key) {
  std::array<std::optional<std::size_t>, 3> across;
  std::size_t next = 3;
  for (std::size_t i = 0; i < 3; ++i) {
    if (!key[i].closed && key[i].before == 0) continue;
    const auto three = [&](std::size_t k) { return key[k].closed && key[k].faces() == 3; };
    if (i > 0 && three(i)) {
      across[i] = across[i - 1];
    } else if (i == 2 && three(0)) {
      across[i] = across[0];
    } else {
      across[i] = next++;
    }
  }
  return across;
}

void require_sensible(const Key& key) {
  if (key[3] != no_corner) throw Rejected("a triangle with four corners");
  bool any_sharp = false, any_smooth_lone = false;
  for (std::size_t i = 0; i < 3; ++i) {
    const Fan &here = key[i], &there = key[(i + 1) % 3];
    const bool lone = !here.closed && here.faces() == 1;
    if (here.closed && (here.before != 0 || here.faces() < 3)) throw Rejected("a closed fan that cannot be");
    if (here.sharp && !lone) throw Rejected("a sharp corner that has more than one face");
    if ((!here.closed && here.before == 0) != (!there.closed && there.after == 0))
      throw Rejected("corners that do not agree whether their edge is a boundary");
    if (here.faces() > 64) throw Rejected("a corner with more than 64 faces");  // rows are dense
    any_sharp = any_sharp || here.sharp;
    any_smooth_lone = any_smooth_lone || (lone && !here.sharp);
  }
  if (any_sharp && any_smooth_lone) throw Rejected("lone corners of which some are sharp and some are not");
}

Piece::Face turned_to_least_first(Piece::Face f) {
  std::rotate(f.begin(), std::min_element(f.begin(), f.end()), f.end());
  return f;
}

}  // namespace

Fan Piece::Ring::fan(bool is_sharp) const {
  Fan fan;
  fan.closed = closed;
  fan.sharp = is_sharp;
  const std::size_t count = closed ? vertices.size() : vertices.size() - 1;
  fan.before = static_cast<std::uint16_t>(own);
  fan.after = static_cast<std::uint16_t>(count - 1 - own);
  return fan;
}

Piece::Ring Piece::ring(std::size_t k) const {
  return ring_around(third_vertices(faces), corners[k], corners[(k + 1) % 3]);
}

bool Piece::polynomial() const {
  for (std::size_t k = 0; k < 3; ++k) {
    if (!ring(k).fan(sharp[k]).regular(Scheme::loop)) return false;
  }
  return true;
}

Piece root_piece(const Key& key) {
  require_sensible(key);
  const auto across = across_edges(key);
  Piece piece;
  piece.corners = {0, 1, 2};
  constexpr std::int64_t one = std::int64_t{1} << place_bits;
  piece.places = {Place{0, 0}, Place{one, 0}, Place{0, one}};
  std::size_t count = 3;
  for (const auto& vertex : across) {
    if (vertex) count = std::max(count, *vertex + 1);
  }
  std::set<Piece::Face> faces;
  for (std::size_t i = 0; i < 3; ++i) {
    const Fan& fan = key[i];
    piece.sharp[i] = fan.sharp;
    const auto first_edge = across[i], last_edge = across[(i + 2) % 3];
    std::vector<std::size_t> ring{(i + 1) % 3, (i + 2) % 3};
    if (fan.closed) {
      ring.push_back(*last_edge);
      for (unsigned k = 4; k < fan.faces(); ++k) ring.push_back(count++);
      if (fan.faces() > 3) ring.push_back(*first_edge);
      ring.push_back(ring.front());
    } else {
      if (fan.after > 0) ring.push_back(*last_edge);
      for (unsigned k = 1; k < fan.after; ++k) ring.push_back(count++);
      std::vector<std::size_t> clockwise;
      if (fan.before > 0) clockwise.push_back(*first_edge);
      for (unsigned k = 1; k < fan.before; ++k) clockwise.push_back(count++);
      ring.insert(ring.begin(), clockwise.rbegin(), clockwise.rend());
    }
    for (std::size_t k = 0; k + 1 < ring.size(); ++k)
      faces.insert(turned_to_least_first({i, ring[k], ring[k + 1]}));
  }
  piece.faces.assign(faces.begin(), faces.end());
  for (std::size_t v = 0; v < count; ++v) {
    Row unit(count);
    unit[v] = 1;
    piece.rows.push_back(std::make_shared<const Row>(std::move(unit)));
  }
  for (std::size_t i = 0; i < 3; ++i) {
    if (!(piece.ring(i).fan(key[i].sharp) == key[i])) throw Rejected("a key that gives no net");
  }
  return piece;
}

std::array<Piece, 4> split(const Piece& piece) {
  if (piece.depth >= place_bits - 2) throw Rejected("too many levels");
  const auto third = third_vertices(piece.faces);
  // New vertices: those at corners, and on edges with an end at a corner. No child's fan needs another.
  std::vector<std::shared_ptr<const Row>> rows;
  const auto keep = [&](Row row) {
    rows.push_back(std::make_shared<const Row>(std::move(row)));
    return rows.size() - 1;
  };
  std::map<std::size_t, std::size_t> kept;  // old corner -> new vertex
  for (std::size_t k = 0; k < 3; ++k) kept[piece.corners[k]] = keep(new_corner(piece, k));
  std::map<Edge, std::size_t> middles;
  for (const auto& [directed, unused] : third) {
    const Edge edge = std::minmax(directed.first, directed.second);
    if ((kept.contains(edge.first) || kept.contains(edge.second)) && !middles.contains(edge))
      middles[edge] = keep(new_edge_point(piece, third, edge));
  }
  std::vector<Piece::Face> faces;
  for (const Piece::Face& f : piece.faces) {
    std::array<std::optional<std::size_t>, 3> old, mid;  // mid[i] on the edge from f[i] to f[i + 1]
    for (std::size_t i = 0; i < 3; ++i) {
      if (const auto it = kept.find(f[i]); it != kept.end()) old[i] = it->second;
      if (const auto it = middles.find(std::minmax(f[i], f[(i + 1) % 3])); it != middles.end())
        mid[i] = it->second;
    }
    for (std::size_t i = 0; i < 3; ++i) {
      if (old[i] && mid[i] && mid[(i + 2) % 3]) faces.push_back({*old[i], *mid[i], *mid[(i + 2) % 3]});
    }
    if (mid[0] && mid[1] && mid[2]) faces.push_back({*mid[0], *mid[1], *mid[2]});
  }

  std::array<std::size_t, 3> corner, side;  // side[k] faces corner k
  std::array<Place, 3> side_place;
  for (std::size_t k = 0; k < 3; ++k) {
    const std::size_t a = (k + 1) % 3, b = (k + 2) % 3;
    corner[k] = kept[piece.corners[k]];
    side[k] = middles.at(std::minmax(piece.corners[a], piece.corners[b]));
    side_place[k] = middle(piece.places[a], piece.places[b]);
  }
  std::array<Piece, 4> children;
  for (std::size_t c = 0; c < 4; ++c) {
    Piece& child = children[c];
    child.depth = piece.depth + 1;
    std::array<std::size_t, 3> names;
    for (std::size_t k = 0; k < 3; ++k) {
      names[k] = c == k ? corner[k] : side[c == 3 ? k : 3 - c - k];
      child.places[k] = c == k ? piece.places[k] : side_place[c == 3 ? k : 3 - c - k];
      child.sharp[k] = c == k && piece.sharp[k];
    }
    std::map<std::size_t, std::size_t> renamed;
    const auto rename = [&](std::size_t v) {
      const auto [it, fresh] = renamed.emplace(v, child.rows.size());
      if (fresh) child.rows.push_back(rows[v]);
      return it->second;
    };
    for (std::size_t k = 0; k < 3; ++k) child.corners[k] = rename(names[k]);
    for (const Piece::Face& f : faces) {
      const bool touches = std::any_of(names.begin(), names.end(), [&](std::size_t v) {
        return std::find(f.begin(), f.end(), v) != f.end();
      });
      if (touches) child.faces.push_back({rename(f[0]), rename(f[1]), rename(f[2])});
    }
    for (std::size_t k = 0; k < 3; ++k) {
      const Fan fan = child.ring(k).fan(child.sharp[k]);
      if (c == k) {
        if (!(fan == piece.ring(k).fan(piece.sharp[k]))) throw Rejected("a corner whose fan changed");
      } else if (!fan.regular(Scheme::loop)) {
        throw Rejected("a new vertex that is not regular");
      }
    }
  }
  return children;
}

Row limit(const Piece& piece, std::size_t k) {
  const std::size_t v = piece.corners[k];
  if (piece.sharp[k]) return *piece.rows[v];
  const Piece::Ring ring = piece.ring(k);
  if (!ring.closed) return curve_sum(piece, v, ring, Real(2) / Real(3), Real(1) / Real(6));
  const std::size_t n = ring.vertices.size();
  const Real w = Real(1) / (Real(1) + Real(8) * ring_share(n) / Real(3));
  return ring_sum(piece, v, ring, w, (Real(1) - w) / Real(static_cast<double>(n)));
}

std::vector<const Row*> net_of(const Piece& piece, const Key& key, std::size_t first) {
  for (std::size_t k = 0; k < 3; ++k) {
    const std::size_t own = (k + first) % 3;
    if (piece.ring(own).fan(piece.sharp[own]) != key[k]) return {};
  }
  // Walks the net of the kind and that of the piece side by side.
  const Piece root = root_piece(key);
  const auto third = third_vertices(piece.faces);
  std::vector<std::optional<std::size_t>> image(root.rows.size());
  for (std::size_t k = 0; k < 3; ++k) image[root.corners[k]] = piece.corners[(k + first) % 3];
  std::vector<bool> done(root.faces.size(), false);
  for (std::size_t left = done.size(), before = left + 1; left > 0;) {
    if (left == before) throw Rejected("a net in several parts");
    before = left;
    for (std::size_t f = 0; f < done.size(); ++f) {
      for (std::size_t i = 0; i < 3 && !done[f]; ++i) {
        const auto a = image[root.faces[f][i]], b = image[root.faces[f][(i + 1) % 3]];
        if (!a || !b) continue;
        const auto there = find(third, *a, *b);
        auto& seen = image[root.faces[f][(i + 2) % 3]];
        if (!there || seen.value_or(*there) != *there)
          throw Rejected("a net whose faces hang together in another way");
        seen = there;
        done[f] = true;
        --left;
      }
    }
  }
  std::vector<const Row*> rows;
  for (const auto& v : image) rows.push_back(piece.rows[v.value()].get());
  return rows;
}

}  // namespace checker
