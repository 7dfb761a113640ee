#include <oracle/limit_kinds.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <set>
#include <stdexcept>

namespace oracle::detail {

namespace {

using Id = std::uint32_t;
using Rows = NetOf<SparseRow>;

/// A face, the faces that touch its corners, and what is sharp there: the same numbers for the same
/// connectivity.
template <class P>
struct Piece {
  NetOf<P> net;         // face 0 is the one meant
  std::size_t own = 0;  // so many vertices of these faces come first; others only end sharp edges
  std::vector<Id> names;
};

/// Faces in the order in which they are met from edge to edge, each with the place in it where it was met.
template <class P>
std::vector<std::pair<Id, std::size_t>> faces_around(const NetOf<P>& net, const Neighbours& near, Id f) {
  std::set<Id> wanted;
  for (const Id v : net.faces[f].vertices)
    wanted.insert(near.vertex_faces[v].begin(), near.vertex_faces[v].end());
  std::vector<std::pair<Id, std::size_t>> order;
  const auto add = [&](Id g, std::size_t at) {
    if (wanted.erase(g) > 0) order.emplace_back(g, at);
  };
  std::size_t done = 0;
  const auto spread = [&] {
    for (; done < order.size(); ++done) {
      const auto [g, start] = order[done];
      const auto& edges = net.faces[g].edges;
      for (std::size_t k = 0; k < edges.size(); ++k) {
        const Id e = edges[(start + k) % edges.size()];
        for (const Id other : near.edge_faces[e]) {
          const auto& there = net.faces[other].edges;
          add(other, static_cast<std::size_t>(std::find(there.begin(), there.end(), e) - there.begin()));
        }
      }
    }
  };
  add(f, 0);
  spread();
  for (const Id v : net.faces[f].vertices)
    for (const Id g : near.vertex_faces[v]) {
      const auto& corners = net.faces[g].vertices;
      add(g, static_cast<std::size_t>(std::find(corners.begin(), corners.end(), v) - corners.begin()));
      spread();
    }
  return order;
}

bool is_finite(const Quad& s) { return s > 0 && s < kInfinitelySharp; }

/// Sharpness is kept where masks look at it: at the face's corners, under chaikin at all vertices of the
/// piece.
template <class P>
class PieceMaker {
 public:
  PieceMaker(const NetOf<P>& net, const Neighbours& near, bool chaikin)
      : net_(net), near_(near), chaikin_(chaikin) {}

  Piece<P> make(Id f) {
    corners_.insert(net_.faces[f].vertices.begin(), net_.faces[f].vertices.end());
    const auto order = faces_around(net_, near_, f);
    for (const auto& [g, start] : order) {
      const auto& from = net_.faces[g];
      const std::size_t n = from.vertices.size();
      NetFace face;
      for (std::size_t k = 0; k < n; ++k) face.vertices.push_back(vertex(from.vertices[(start + k) % n]));
      for (std::size_t k = 0; k < n; ++k)
        face.edges.push_back(edge(from.edges[(start + k) % n], from.vertices[(start + k) % n]));
      piece_.net.faces.push_back(std::move(face));
    }
    piece_.own = piece_.names.size();
    if (chaikin_)
      for (std::size_t i = 0; i < piece_.own; ++i)
        for (const Id e : near_.vertex_edges[piece_.names[i]])
          if (is_finite(net_.edges[e].sharpness)) edge(e, piece_.names[i]);
    return std::move(piece_);
  }

 private:
  Id vertex(Id old) {
    const auto [at, is_new] = vertices_.try_emplace(old, static_cast<Id>(piece_.names.size()));
    if (is_new) {
      piece_.names.push_back(old);
      piece_.net.points.push_back(net_.points[old]);
      piece_.net.sharpness.push_back(corners_.contains(old) ? net_.sharpness[old] : Quad(0));
    }
    return at->second;
  }
  /// Runs from `start` in the piece.
  Id edge(Id old, Id start) {
    const auto [at, is_new] = edges_.try_emplace(old, static_cast<Id>(piece_.net.edges.size()));
    if (is_new) {
      const NetEdge& e = net_.edges[old];
      const bool counts = chaikin_ || corners_.contains(e.a) || corners_.contains(e.b);
      const Id a = vertex(start), b = vertex(e.a == start ? e.b : e.a);
      piece_.net.edges.push_back({a, b, counts ? e.sharpness : Quad(0)});
    }
    return at->second;
  }

  const NetOf<P>& net_;
  const Neighbours& near_;
  bool chaikin_;
  std::set<Id> corners_;
  std::map<Id, Id> vertices_, edges_;
  Piece<P> piece_;
};

WeightRow rounded(SparseRow row) {
  std::sort(row.terms.begin(), row.terms.end(),
            [](const auto& a, const auto& b) { return a.first < b.first; });
  WeightRow result;
  for (std::size_t i = 0; i < row.terms.size();) {
    const Id source = row.terms[i].first;
    double sum = 0;
    for (; i < row.terms.size() && row.terms[i].first == source; ++i) sum += row.terms[i].second;
    if (sum < -0x1p-48) throw std::logic_error("oracle: a mask is no convex combination");
    if (sum > 0) result.weights.emplace_back(source, sum);
  }
  return result;
}

/// Is the patch one polynomial: four quads, or six triangles, around each corner, and nothing sharp?
bool is_regular(const Rows& net, const Neighbours& near, bool loop) {
  const auto& corners = net.faces[0].vertices;
  if (corners.size() != (loop ? 3U : 4U)) return false;
  return std::all_of(corners.begin(), corners.end(), [&](Id v) {
    const auto& faces = near.vertex_faces[v];
    const auto& edges = near.vertex_edges[v];
    return faces.size() == (loop ? 6U : 4U) && edges.size() == faces.size() && !(net.sharpness[v] > 0) &&
           std::none_of(edges.begin(), edges.end(), [&](Id e) { return net.edges[e].sharpness > 0; }) &&
           std::all_of(faces.begin(), faces.end(),
                       [&](Id f) { return net.faces[f].vertices.size() == corners.size(); });
  });
}

class PrimalKinds final : public PatchKinds {
 public:
  explicit PrimalKinds(const Rules& rules) : rules_(rules) { rules_.clamp_dart_edges = true; }

  std::vector<RootPatch> roots(const TaggedMesh& mesh) override {
    const ControlNet control = control_net(mesh, rules_);
    const Neighbours near(control.net);
    std::vector<RootPatch> result;
    for (Id f = 0; f < control.net.faces.size(); ++f) {
      if (!control.has_surface[f]) continue;
      Piece<QuadPoint> piece = PieceMaker<QuadPoint>(control.net, near, rules_.chaikin).make(f);
      piece.names.resize(piece.own);
      const Id kind = find(piece);
      result.push_back({kind, f, std::move(piece.names)});
    }
    return result;
  }

 private:
  using Key = std::vector<std::uint64_t>;

  template <class P>
  static Key key_of(const Piece<P>& piece) {
    Key key{piece.own, piece.net.faces.size(), piece.net.edges.size()};
    const auto add = [&](const Quad& sharpness) {
      std::uint64_t words[2];
      static_assert(sizeof words == sizeof sharpness);
      std::memcpy(words, &sharpness, sizeof words);
      key.insert(key.end(), words, words + 2);
    };
    for (const NetFace& face : piece.net.faces) {
      key.push_back(face.vertices.size());
      key.insert(key.end(), face.vertices.begin(), face.vertices.end());
      key.insert(key.end(), face.edges.begin(), face.edges.end());
    }
    for (const NetEdge& e : piece.net.edges) {
      key.push_back(std::uint64_t{e.a} << 32U | e.b);
      if (e.sharpness > 0) add(e.sharpness);
    }
    for (Id v = 0; v < piece.own; ++v)
      if (piece.net.sharpness[v] > 0) {
        key.push_back(v);
        add(piece.net.sharpness[v]);
      }
    return key;
  }

  template <class P>
  Id find(const Piece<P>& piece) {
    const auto [at, is_new] = index_.try_emplace(key_of(piece), static_cast<Id>(kinds_.size()));
    if (!is_new) return at->second;
    Rows units;
    units.points.resize(piece.net.points.size());
    for (Id i = 0; i < piece.own; ++i) units.points[i].terms = {{i, 1.0}};
    units.sharpness = piece.net.sharpness;
    units.edges = piece.net.edges;
    units.faces = piece.net.faces;
    PatchKind kind;
    kind.point_count = static_cast<Id>(piece.own);
    const Neighbours near(units);
    for (const Id v : units.faces[0].vertices) {
      const auto limit = limit_in_star(units, near, v, rules_);
      kind.corners.push_back(limit ? std::optional(rounded(*limit)) : std::nullopt);
    }
    const bool loop = rules_.scheme == PrimalScheme::loop;
    if (is_regular(units, near, loop)) kind.polynomial = loop ? Polynomial::quartic : Polynomial::bicubic;
    kinds_.push_back(std::move(kind));
    nets_.push_back(std::move(units));
    return at->second;
  }

  void make_children(Id kind) override {
    const Rows fine = refine(nets_[kind], rules_);
    const Neighbours near(fine);
    const Id corners = static_cast<Id>(nets_[kind].faces[0].vertices.size());
    const bool polygon = corners != (rules_.scheme == PrimalScheme::loop ? 3U : 4U);
    std::vector<PatchKind::Child> children;
    for (Id k = 0; k < (polygon ? corners : 4U); ++k) {
      const Piece<SparseRow> piece = PieceMaker<SparseRow>(fine, near, rules_.chaikin).make(k);
      PatchKind::Child child;
      for (std::size_t i = 0; i < piece.own; ++i) child.rows.push_back(rounded(piece.net.points[i]));
      if (k < corners) child.corner_of_parent = k, child.corner = polygon ? 0 : k;
      child.kind = find(piece);
      children.push_back(std::move(child));
    }
    kinds_[kind].children = std::move(children);
    nets_[kind] = {};
  }

  Rules rules_;
  std::map<Key, Id> index_;
  std::vector<Rows> nets_;  // until it is split
};

/// Faces around a vertex, in turn. Control points: the vertex, the ends of the edges between the faces (the
/// first before face 0), then the other vertices of each face.
class DualKinds final : public PatchKinds {
 public:
  explicit DualKinds(DualScheme scheme) : scheme_(scheme) {}

  std::vector<RootPatch> roots(const TaggedMesh& mesh) override {
    std::vector<RootPatch> result;
    for (Id v = 0; v < mesh.points.size(); ++v) {
      const std::vector<Polygon> fan = fan_around(mesh, v);
      if (fan.empty()) continue;
      RootPatch root{0, v, {v}};
      Sizes sizes;
      for (const Polygon& face : fan) {
        sizes.push_back(static_cast<Id>(face.size()));
        root.vertices.push_back(face[1]);
      }
      for (const Polygon& face : fan)
        root.vertices.insert(root.vertices.end(), face.begin() + 2, face.end() - 1);
      root.kind = find(sizes);
      result.push_back(std::move(root));
    }
    return result;
  }

 private:
  using Polygon = std::vector<Id>;
  using Sizes = std::vector<Id>;

  /// The faces around a vertex inside the mesh, each from that vertex on; none at a boundary.
  /// Requires:  an oriented manifold.
  static std::vector<Polygon> fan_around(const TaggedMesh& mesh, Id v) {
    std::map<Id, Polygon> by_first;
    std::size_t first_face = mesh.polygons.size();
    Id first = 0;
    for (std::size_t f = 0; f < mesh.polygons.size(); ++f) {
      Polygon face = mesh.polygons[f];
      const auto at = std::find(face.begin(), face.end(), v);
      if (at == face.end()) continue;
      std::rotate(face.begin(), at, face.end());
      if (f < first_face) first_face = f, first = face[1];
      by_first[face[1]] = std::move(face);
    }
    std::vector<Polygon> fan;
    Id next = first;
    while (fan.size() < by_first.size()) {
      const auto at = by_first.find(next);
      if (at == by_first.end()) return {};
      fan.push_back(at->second);
      next = at->second.back();
    }
    return fan.size() >= 3 && next == first ? fan : std::vector<Polygon>{};
  }

  /// Numbers of the vertices of face i, from the vertex itself on.
  static std::vector<Polygon> faces_of(const Sizes& sizes) {
    const Id n = static_cast<Id>(sizes.size());
    Id next = n + 1;
    std::vector<Polygon> faces;
    for (Id i = 0; i < n; ++i) {
      Polygon face{0, 1 + i};
      for (Id k = 3; k < sizes[i]; ++k) face.push_back(next++);
      face.push_back(1 + (i + 1) % n);
      faces.push_back(std::move(face));
    }
    return faces;
  }

  Id find(const Sizes& sizes) {
    const auto [at, is_new] = index_.try_emplace(sizes, static_cast<Id>(kinds_.size()));
    if (!is_new) return at->second;
    PatchKind kind;
    kind.point_count = 1 + static_cast<Id>(sizes.size());
    for (const Id size : sizes) kind.point_count += size - 3;
    for (const Polygon& face : faces_of(sizes)) {
      WeightRow row;
      for (const Id v : face) row.weights.emplace_back(v, 1.0 / static_cast<double>(face.size()));
      kind.corners.emplace_back(std::move(row));
    }
    if (scheme_ == DualScheme::doo_sabin && sizes == Sizes{4, 4, 4, 4})
      kind.polynomial = Polynomial::biquadratic;
    kinds_.push_back(std::move(kind));
    sizes_.push_back(sizes);
    return at->second;
  }

  /// The child of corner k of a face.
  [[nodiscard]] WeightRow child_point(const Polygon& face, std::size_t k) {
    const auto [mask, is_new] = masks_.try_emplace(face.size());
    if (is_new) mask->second = dual_mask(scheme_, face.size());
    WeightRow row;
    for (std::size_t i = 0; i < face.size(); ++i)
      if (const Quad w = mask->second[i]; w > 0)
        row.weights.emplace_back(face[(k + i) % face.size()], static_cast<double>(w));
    return row;
  }

  void make_children(Id kind) override {
    const Sizes sizes = sizes_[kind];
    const std::vector<Polygon> faces = faces_of(sizes);
    const Id n = static_cast<Id>(sizes.size());
    std::vector<PatchKind::Child> children;
    for (Id k = 0; k < n; ++k) {
      const Id next = (k + 1) % n, before = (k + n - 1) % n, size = sizes[k];
      const auto own = [&](Id face) { return child_point(faces[face], 0); };
      PatchKind::Child child;
      // Around it: the face's own face, that of the edge after, that of the vertex, that of the edge before.
      child.kind = find({size, 4, n, 4});
      child.rows = {own(k), child_point(faces[k], 1), child_point(faces[k], size - 1), own(next),
                    own(before)};
      for (Id i = 2; i + 1 < size; ++i) child.rows.push_back(child_point(faces[k], i));
      child.rows.push_back(child_point(faces[next], 1));
      for (Id i = 2; i + 1 < n; ++i) child.rows.push_back(own((k + i) % n));
      child.rows.push_back(child_point(faces[before], sizes[before] - 1));
      child.corner_of_parent = k;
      child.corner = 0;
      if (n == 4) turn(child, k);
      children.push_back(std::move(child));
    }
    kinds_[kind].children = std::move(children);
  }

  /// So that the corner in common has number k in the child, too.
  void turn(PatchKind::Child& child, Id k) {
    const Sizes sizes = sizes_[child.kind];
    const std::vector<Polygon> faces = faces_of(sizes);
    Sizes turned;
    std::vector<WeightRow> rows{child.rows[0]};
    for (Id i = 0; i < 4; ++i) {
      turned.push_back(sizes[(i + 4 - k) % 4]);
      rows.push_back(child.rows[faces[(i + 4 - k) % 4][1]]);
    }
    for (Id i = 0; i < 4; ++i) {
      const Polygon& face = faces[(i + 4 - k) % 4];
      for (std::size_t j = 2; j + 1 < face.size(); ++j) rows.push_back(child.rows[face[j]]);
    }
    child.rows = std::move(rows);
    child.kind = find(turned);
    child.corner = k;
  }

  DualScheme scheme_;
  std::map<Sizes, Id> index_;
  std::vector<Sizes> sizes_;
  std::map<std::size_t, std::vector<Quad>> masks_;
};

/// Bernstein polynomials of a patch at a parameter; `whole` times their values at the nodes of a B-spline or
/// box spline are whole numbers.
struct Bernstein {
  bool triangle;
  int degree;
  double whole;
  [[nodiscard]] std::vector<double> at(double u, double v) const {
    const double factorial[] = {1, 1, 2, 6, 24};
    std::vector<double> values;
    for (int q = 0; q <= degree; ++q)
      for (int p = 0; p <= (triangle ? degree - q : degree); ++p) {
        const auto term = [&](double x, int k) {
          return factorial[degree] / (factorial[k] * factorial[degree - k]) * std::pow(x, k) *
                 std::pow(1 - x, degree - k);
        };
        values.push_back(triangle
                             ? factorial[degree] / (factorial[p] * factorial[q] * factorial[degree - p - q]) *
                                   std::pow(u, p) * std::pow(v, q) * std::pow(1 - u - v, degree - p - q)
                             : term(u, p) * term(v, q));
      }
    return values;
  }
};

Bernstein bernstein(Polynomial polynomial) {
  return polynomial == Polynomial::quartic   ? Bernstein{true, 4, 24}
         : polynomial == Polynomial::bicubic ? Bernstein{false, 3, 36}
                                             : Bernstein{false, 2, 4};
}

/// Solves for the rows of the unknowns, which are written after those of the matrix; more equations than
/// unknowns must agree.
void eliminate(std::vector<std::vector<double>>& table, std::size_t unknowns) {
  for (std::size_t k = 0; k < unknowns; ++k) {
    const auto pivot =
        std::max_element(table.begin() + static_cast<std::ptrdiff_t>(k), table.end(),
                         [&](const auto& a, const auto& b) { return std::abs(a[k]) < std::abs(b[k]); });
    std::swap(table[k], *pivot);
    for (std::size_t r = 0; r < table.size(); ++r) {
      if (r == k) continue;
      const double factor = table[r][k] / table[k][k];
      for (std::size_t c = k; c < table[r].size(); ++c) table[r][c] -= factor * table[k][c];
    }
  }
  for (std::size_t r = unknowns; r < table.size(); ++r)
    for (const double x : table[r])
      if (std::abs(x) > 1e-9) throw std::logic_error("oracle: the patch is no polynomial");
}

}  // namespace

const std::vector<WeightRow>& PatchKinds::hull(std::uint32_t kind) {
  if (kinds_[kind].polynomial == Polynomial::none || !kinds_[kind].hull.empty()) return kinds_[kind].hull;
  // Limits at the corners of patches two levels down, and what Bernstein polynomials are there.
  const Bernstein basis = bernstein(kinds_[kind].polynomial);
  const std::size_t columns = kinds_[kind].point_count, unknowns = basis.at(0, 0).size();
  std::vector<std::vector<double>> table;
  using Dense = std::vector<std::vector<double>>;
  const auto compose = [&](const std::vector<WeightRow>& rows, const Dense& with) {
    Dense result(rows.size(), std::vector<double>(columns));
    for (std::size_t r = 0; r < rows.size(); ++r)
      for (const auto& [i, w] : rows[r].weights)
        for (std::size_t c = 0; c < columns; ++c) result[r][c] += w * with[i][c];
    return result;
  };
  using Place = std::array<double, 2>;
  const auto descend = [&](const auto& self, std::uint32_t at, const Dense& points,
                           const std::vector<Place>& corners, int levels) -> void {
    if (levels == 0) {
      for (std::size_t k = 0; k < corners.size(); ++k) {
        table.push_back(basis.at(corners[k][0], corners[k][1]));
        const Dense limit = compose({*kinds_[at].corners[k]}, points);
        table.back().insert(table.back().end(), limit[0].begin(), limit[0].end());
      }
      return;
    }
    const auto halve = [](const Place& a, const Place& b) {
      return Place{(a[0] + b[0]) / 2, (a[1] + b[1]) / 2};
    };
    const std::size_t n = corners.size();
    (void)split(at);
    for (std::size_t k = 0; k < 4; ++k) {
      std::vector<Place> fine = corners;
      if (k == n) {  // the triangle in the middle
        fine = {halve(corners[1], corners[2]), halve(corners[2], corners[0]), halve(corners[0], corners[1])};
      } else {
        for (std::size_t i = 0; i < n; ++i) fine[i] = halve(corners[k], corners[i]);
      }
      const PatchKind::Child& child = kinds_[at].children[k];
      self(self, child.kind, compose(child.rows, points), fine, levels - 1);
    }
  };
  Dense units(columns, std::vector<double>(columns));
  for (std::size_t c = 0; c < columns; ++c) units[c][c] = 1;
  const std::vector<Place> whole = basis.triangle ? std::vector<Place>{{0, 0}, {1, 0}, {0, 1}}
                                                  : std::vector<Place>{{0, 0}, {1, 0}, {1, 1}, {0, 1}};
  descend(descend, kind, units, whole, 2);
  eliminate(table, unknowns);
  std::vector<WeightRow> rows(unknowns);
  for (std::size_t k = 0; k < unknowns; ++k)
    for (std::uint32_t c = 0; c < columns; ++c) {
      const double weight = basis.whole * table[k][unknowns + c] / table[k][k], nearest = std::round(weight);
      if (std::abs(weight - nearest) > 1e-6) throw std::logic_error("oracle: no whole number");
      if (nearest != 0) rows[k].weights.emplace_back(c, nearest / basis.whole);
    }
  kinds_[kind].hull = std::move(rows);
  return kinds_[kind].hull;
}

std::unique_ptr<PatchKinds> primal_kinds(const Rules& rules) { return std::make_unique<PrimalKinds>(rules); }
std::unique_ptr<PatchKinds> dual_kinds(DualScheme scheme) { return std::make_unique<DualKinds>(scheme); }

}  // namespace oracle::detail
