#include <oracle/kernel_twin.h>

#include <algorithm>
#include <array>
#include <map>
#include <numeric>
#include <set>
#include <stdexcept>

#include <gmpxx.h>

namespace oracle {
namespace {

// Integers modulo a prime below 2^61.
class Field {
 public:
  using Element = std::uint64_t;

  // With a root of unity of each order that divides `order`.
  explicit Field(std::uint64_t order) : order_(order) {
    const mpz_class step = static_cast<unsigned long>(order);  // 32 bits on Windows, as in get_ui()
    mpz_class p = ((mpz_class(1) << 60) / step) * step + 1;
    while (mpz_probab_prime_p(p.get_mpz_t(), 40) == 0) p += step;  // no composite below 2^64 passes
    prime_ = std::uint64_t{mpz_class(p >> 32).get_ui()} << 32 | (p.get_ui() & 0xffffffffu);
    for (Element g = 2;; ++g) {
      root_ = power(g, (prime_ - 1) / order);
      bool generates = true;
      for (std::uint64_t d = 1; d < order; ++d) {
        generates = generates && (order % d != 0 || power(root_, d) != 1);
      }
      if (generates) return;
    }
  }
  [[nodiscard]] Element add(Element a, Element b) const { return a + b >= prime_ ? a + b - prime_ : a + b; }
  [[nodiscard]] Element negative(Element a) const { return a == 0 ? 0 : prime_ - a; }
  [[nodiscard]] Element times(Element a, Element b) const {
    __extension__ using Wide = unsigned __int128;
    return static_cast<Element>(Wide{a} * b % prime_);
  }
  [[nodiscard]] Element power(Element a, std::uint64_t n) const {
    Element result = 1;
    for (; n > 0; n /= 2, a = times(a, a)) {
      if (n % 2 == 1) result = times(result, a);
    }
    return result;
  }
  [[nodiscard]] Element inverse(Element a) const { return power(a, prime_ - 2); }
  [[nodiscard]] Element ratio(std::int64_t p, std::int64_t q) const {
    const Element a = times(static_cast<Element>(p < 0 ? -p : p), inverse(static_cast<Element>(q)));
    return p < 0 ? negative(a) : a;
  }
  // cos(2 pi i / n)
  [[nodiscard]] Element cosine(std::uint64_t i, std::uint64_t n) const {
    const Element z = power(root_, order_ / n * (i % n));
    return times(add(z, inverse(z)), ratio(1, 2));
  }

 private:
  std::uint64_t order_;
  Element prime_ = 0, root_ = 0;
};

using Row = std::vector<Field::Element>;  // of control vertices

struct Net {
  KernelMesh mesh;
  std::vector<Row> rows;  // of its vertices
};

KernelMesh::Edge edge_of(std::uint32_t a, std::uint32_t b) { return std::minmax(a, b); }

// Who is next to whom.
struct Neighbours {
  struct Side {
    std::size_t face, corner;
  };
  std::map<KernelMesh::Edge, std::vector<Side>> edges;
  std::map<KernelMesh::Edge, std::uint32_t> number;              // of edges
  std::map<std::pair<std::uint32_t, std::uint32_t>, Side> from;  // by direction
  std::vector<std::set<std::uint32_t>> ends;                     // of edges at a vertex
  std::vector<std::vector<std::size_t>> faces;                   // at a vertex

  explicit Neighbours(const KernelMesh& mesh) : ends(mesh.vertices), faces(mesh.vertices) {
    for (std::size_t f = 0; f < mesh.faces.size(); ++f) {
      const auto& face = mesh.faces[f];
      for (std::size_t i = 0; i < face.size(); ++i) {
        const std::uint32_t a = face[i], b = face[(i + 1) % face.size()];
        edges[edge_of(a, b)].push_back({f, i});
        if (!from.insert({{a, b}, {f, i}}).second) throw std::invalid_argument("not an oriented manifold");
        ends[a].insert(b);
        ends[b].insert(a);
        faces[a].push_back(f);
      }
    }
    std::uint32_t n = 0;
    for (const auto& [edge, sides] : edges) number[edge] = n++;
  }
};

enum class Rule { smooth, crease, corner };

class Step {
 public:
  Step(const Field& field, const Net& net, KernelScheme scheme)
      : f_(field), net_(net), mesh_(net.mesh), near_(net.mesh), scheme_(scheme) {}

  [[nodiscard]] Net refined() const {
    return scheme_ == KernelScheme::loop || scheme_ == KernelScheme::catmark ? refined_primal()
                                                                             : refined_dual();
  }
  // Is a part of it on the surface? With dual schemes, where a corner of it is inside.
  [[nodiscard]] bool has_surface(std::size_t f) const {
    const auto& face = mesh_.faces[f];
    return scheme_ == KernelScheme::loop || scheme_ == KernelScheme::catmark ||
           std::any_of(face.begin(), face.end(), [&](std::uint32_t v) { return inside(v); });
  }
  // Of vertices, or of faces.
  [[nodiscard]] std::vector<Row> limits() const {
    std::vector<Row> rows;
    if (scheme_ == KernelScheme::doo_sabin || scheme_ == KernelScheme::midedge) {
      for (std::size_t f = 0; f < mesh_.faces.size(); ++f) {
        if (has_surface(f)) rows.push_back(mean(f));
      }
      return rows;
    }
    for (std::uint32_t v = 0; v < mesh_.vertices; ++v) add_limit(v, rows);
    return rows;
  }

 private:
  [[nodiscard]] Row zero() const { return Row(net_.rows.front().size(), 0); }
  void add(Row& sum, Field::Element weight, const Row& row) const {
    for (std::size_t i = 0; i < sum.size(); ++i) sum[i] = f_.add(sum[i], f_.times(weight, row[i]));
  }
  void add(Row& sum, Field::Element weight, std::uint32_t v) const { add(sum, weight, net_.rows[v]); }
  [[nodiscard]] Row mean(std::size_t face) const {
    Row sum = zero();
    const auto n = static_cast<std::int64_t>(mesh_.faces[face].size());
    for (const std::uint32_t v : mesh_.faces[face]) add(sum, f_.ratio(1, n), v);
    return sum;
  }

  [[nodiscard]] int sharpness(std::uint32_t a, std::uint32_t b) const {
    const auto edge = edge_of(a, b);
    if (near_.edges.at(edge).size() == 1) return KernelMesh::infinite;
    const auto tag = mesh_.creases.find(edge);
    return tag == mesh_.creases.end() ? 0 : tag->second;
  }
  [[nodiscard]] int sharpness(std::uint32_t v) const {
    if (mesh_.boundary_corners && near_.faces[v].size() == 1 && near_.ends[v].size() == 2) {
      return KernelMesh::infinite;
    }
    const auto tag = mesh_.corners.find(v);
    return tag == mesh_.corners.end() ? 0 : tag->second;
  }
  static int decayed(int s) { return s >= KernelMesh::infinite ? s : std::max(0, s - 4); }
  // Before the step, or by what it leaves.
  [[nodiscard]] Rule rule(std::uint32_t v, bool after) const {
    const auto now = [&](int s) { return after ? decayed(s) : s; };
    int sharp = 0;
    for (const std::uint32_t w : near_.ends[v]) sharp += now(sharpness(v, w)) > 0 ? 1 : 0;
    if (now(sharpness(v)) > 0 || sharp > 2) return Rule::corner;
    return sharp == 2 ? Rule::crease : Rule::smooth;
  }

  // Loop's weight of a ring.
  [[nodiscard]] Field::Element ring_share(std::size_t n) const {
    const Field::Element base = f_.add(3, f_.times(2, f_.cosine(1, n)));
    return f_.add(f_.ratio(5, 8), f_.negative(f_.times(f_.times(base, base), f_.ratio(1, 64))));
  }
  void add_by(Row& sum, std::uint32_t v, Rule rule, bool after, Field::Element share) const {
    const auto n = static_cast<std::int64_t>(near_.ends[v].size());
    if (rule == Rule::corner) return add(sum, share, v);
    if (rule == Rule::crease) {
      add(sum, f_.times(share, f_.ratio(3, 4)), v);
      for (const std::uint32_t w : near_.ends[v]) {
        const int s = sharpness(v, w);
        if ((after ? decayed(s) : s) > 0) add(sum, f_.times(share, f_.ratio(1, 8)), w);
      }
      return;
    }
    if (scheme_ == KernelScheme::loop) {
      const Field::Element a = ring_share(near_.ends[v].size());
      add(sum, f_.times(share, f_.add(1, f_.negative(a))), v);
      for (const std::uint32_t w : near_.ends[v]) add(sum, f_.times(share, f_.times(a, f_.ratio(1, n))), w);
      return;
    }
    add(sum, f_.times(share, f_.ratio(n - 2, n)), v);
    for (const std::uint32_t w : near_.ends[v]) add(sum, f_.times(share, f_.ratio(1, n * n)), w);
    for (const std::size_t f : near_.faces[v]) add(sum, f_.times(share, f_.ratio(1, n * n)), mean(f));
  }
  [[nodiscard]] Row vertex_point(std::uint32_t v) const {
    Row sum = zero();
    const Rule now = rule(v, false), then = rule(v, true);
    std::int64_t total = 0, ending = 0;
    const auto count = [&](int s) {
      if (s > 0 && decayed(s) == 0) total += s, ++ending;
    };
    for (const std::uint32_t w : near_.ends[v]) count(sharpness(v, w));
    count(sharpness(v));
    const Field::Element share = now == then || ending == 0 ? 1 : f_.ratio(total, 4 * ending);
    add_by(sum, v, now, false, share);
    add_by(sum, v, then, true, f_.add(1, f_.negative(share)));
    return sum;
  }
  [[nodiscard]] Row edge_point(const KernelMesh::Edge& edge) const {
    const auto [a, b] = edge;
    const int s = std::min(4, sharpness(a, b));
    Row sum = zero();
    for (const std::uint32_t end : {a, b}) add(sum, f_.ratio(s, 8), end);
    if (s == 4) return sum;
    const Field::Element share = f_.ratio(4 - s, 4);
    const auto& sides = near_.edges.at(edge);
    Field::Element faces = 0;
    for (const auto& side : sides) {
      const auto& face = mesh_.faces[side.face];
      if (scheme_ == KernelScheme::loop) {
        add(sum, f_.times(share, f_.ratio(1, 8)), face[(side.corner + 2) % 3]);
      } else {
        const bool smooth = mesh_.smooth_triangles && face.size() == 3;
        faces = f_.add(faces, f_.times(f_.ratio(1, 2), smooth ? f_.ratio(47, 100) : f_.ratio(1, 4)));
      }
    }
    Field::Element each = f_.ratio(3, 8);
    if (scheme_ == KernelScheme::catmark) {
      each = f_.times(f_.ratio(1, 2), f_.add(1, f_.negative(f_.times(2, faces))));
      for (const auto& side : sides) add(sum, f_.times(share, faces), mean(side.face));
    }
    for (const std::uint32_t end : {a, b}) add(sum, f_.times(share, each), end);
    return sum;
  }

  [[nodiscard]] Net refined_primal() const {
    Net result;
    const bool loop = scheme_ == KernelScheme::loop;
    result.mesh.boundary_corners = mesh_.boundary_corners;
    for (std::uint32_t v = 0; v < mesh_.vertices; ++v) {
      result.rows.push_back(near_.faces[v].empty() ? net_.rows[v] : vertex_point(v));
      if (decayed(sharpness(v)) > 0) result.mesh.corners[v] = decayed(sharpness(v));
    }
    const std::uint32_t edges = mesh_.vertices,
                        faces = edges + static_cast<std::uint32_t>(near_.edges.size());
    for (const auto& [edge, number] : near_.number) {
      result.rows.push_back(edge_point(edge));
      const int s = decayed(sharpness(edge.first, edge.second));
      if (s == 0) continue;
      result.mesh.creases[edge_of(edge.first, edges + number)] = s;
      result.mesh.creases[edge_of(edge.second, edges + number)] = s;
    }
    for (std::size_t f = 0; f < mesh_.faces.size(); ++f) {
      const auto& face = mesh_.faces[f];
      const std::size_t n = face.size();
      const auto middle = [&](std::size_t i) {
        return edges + near_.number.at(edge_of(face[i % n], face[(i + 1) % n]));
      };
      const auto centre = faces + static_cast<std::uint32_t>(f);
      for (std::size_t i = 0; i < n; ++i) {
        if (loop) {
          result.mesh.faces.push_back({face[i], middle(i), middle(i + n - 1)});
        } else {
          result.mesh.faces.push_back({face[i], middle(i), centre, middle(i + n - 1)});
        }
      }
      if (loop) {
        result.mesh.faces.push_back({middle(0), middle(1), middle(2)});
      } else {
        result.rows.push_back(mean(f));
      }
    }
    result.mesh.vertices = static_cast<std::uint32_t>(result.rows.size());
    return result;
  }

  [[nodiscard]] std::vector<Field::Element> dual_mask(std::size_t size) const {
    const auto n = static_cast<std::int64_t>(size);
    std::vector<Field::Element> mask(size, 0);
    if (scheme_ == KernelScheme::midedge) {
      mask[0] = f_.ratio(1, 2);
      mask[1] = mask[size - 1] = f_.ratio(1, 4);
      return mask;
    }
    for (std::size_t i = 0; i < size; ++i) {
      mask[i] = f_.times(f_.add(3, f_.times(2, f_.cosine(i, size))), f_.ratio(1, 4 * n));
    }
    mask[0] = f_.add(f_.ratio(1, 4), f_.ratio(5, 4 * n));
    return mask;
  }
  // Has it faces all around?
  [[nodiscard]] bool inside(std::uint32_t v) const {
    const auto& ends = near_.ends[v];
    return !ends.empty() && std::all_of(ends.begin(), ends.end(), [&](std::uint32_t w) {
      return near_.edges.at(edge_of(v, w)).size() == 2;
    });
  }
  [[nodiscard]] Net refined_dual() const {
    Net result;
    std::vector<std::uint32_t> begins;
    for (const auto& face : mesh_.faces) {
      begins.push_back(static_cast<std::uint32_t>(result.rows.size()));
      const auto mask = dual_mask(face.size());
      std::vector<std::uint32_t> own;
      for (std::size_t i = 0; i < face.size(); ++i) {
        own.push_back(static_cast<std::uint32_t>(result.rows.size()));
        Row sum = zero();
        for (std::size_t k = 0; k < face.size(); ++k) add(sum, mask[k], face[(i + k) % face.size()]);
        result.rows.push_back(std::move(sum));
      }
      result.mesh.faces.push_back(std::move(own));
    }
    const auto corner = [&](const Neighbours::Side& side, std::size_t further) {
      const std::size_t n = mesh_.faces[side.face].size();
      return begins[side.face] + static_cast<std::uint32_t>((side.corner + further) % n);
    };
    for (const auto& [edge, sides] : near_.edges) {
      if (sides.size() != 2) continue;
      const auto one = near_.from.at(edge), other = near_.from.at({edge.second, edge.first});
      result.mesh.faces.push_back({corner(one, 1), corner(one, 0), corner(other, 1), corner(other, 0)});
    }
    for (std::uint32_t v = 0; v < mesh_.vertices; ++v) {
      if (!inside(v)) continue;
      std::vector<std::uint32_t> around;
      const std::uint32_t first = *near_.ends[v].begin();
      std::uint32_t end = first;
      do {  // to the edge before, in the face of this one
        const auto side = near_.from.at({v, end});
        around.push_back(corner(side, 0));
        const auto& face = mesh_.faces[side.face];
        end = face[(side.corner + face.size() - 1) % face.size()];
      } while (end != first);
      result.mesh.faces.push_back(std::move(around));
    }
    result.mesh.vertices = static_cast<std::uint32_t>(result.rows.size());
    return result;
  }

  void add_limit(std::uint32_t v, std::vector<Row>& rows) const {
    if (near_.faces[v].empty()) return;
    int sharp = 0;
    bool at_rest = sharpness(v) == decayed(sharpness(v));
    for (const std::uint32_t w : near_.ends[v]) {
      sharp += sharpness(v, w) > 0 ? 1 : 0;
      at_rest = at_rest && sharpness(v, w) == decayed(sharpness(v, w));
    }
    const Rule own = rule(v, false);
    if (!at_rest || (own == Rule::smooth && sharp > 0)) return;
    Row sum = zero();
    const auto n = static_cast<std::int64_t>(near_.ends[v].size());
    if (own == Rule::corner) {
      add(sum, 1, v);
    } else if (own == Rule::crease) {
      add(sum, f_.ratio(2, 3), v);
      for (const std::uint32_t w : near_.ends[v]) {
        if (sharpness(v, w) > 0) add(sum, f_.ratio(1, 6), w);
      }
    } else if (scheme_ == KernelScheme::loop) {
      const Field::Element w =
          f_.inverse(f_.add(1, f_.times(f_.ratio(8, 3), ring_share(near_.ends[v].size()))));
      add(sum, w, v);
      const Field::Element each = f_.times(f_.add(1, f_.negative(w)), f_.ratio(1, n));
      for (const std::uint32_t end : near_.ends[v]) add(sum, each, end);
    } else {
      add(sum, f_.ratio(n, n + 5), v);
      for (const std::uint32_t end : near_.ends[v]) add(sum, f_.ratio(4, n * (n + 5)), end);
      for (const std::size_t f : near_.faces[v]) {
        const auto& face = mesh_.faces[f];
        const auto at = std::find(face.begin(), face.end(), v) - face.begin();
        add(sum, f_.ratio(1, n * (n + 5)), face[(static_cast<std::size_t>(at) + 2) % 4]);
      }
    }
    rows.push_back(std::move(sum));
  }

  const Field& f_;
  const Net& net_;
  const KernelMesh& mesh_;
  Neighbours near_;
  KernelScheme scheme_;
};

// With cosines for all faces and vertices of the mesh, and of quads.
Field field_of(const KernelMesh& mesh) {
  std::uint64_t order = 12;
  std::map<std::uint32_t, std::uint64_t> valence;
  for (const auto& face : mesh.faces) {
    order = std::lcm(order, face.size());
    for (const std::uint32_t v : face) ++valence[v];
  }
  for (const auto& [v, n] : valence) order = std::lcm(order, n);
  if (order > (std::uint64_t{1} << 40)) throw std::invalid_argument("too many different valences");
  return Field(order);
}

std::size_t rank_of(const Field& field, std::vector<Row> rows) {
  if (rows.empty()) return 0;
  std::size_t rank = 0;
  for (std::size_t column = 0; column < rows.front().size(); ++column) {
    std::size_t pivot = rank;
    while (pivot < rows.size() && rows[pivot][column] == 0) ++pivot;
    if (pivot == rows.size()) continue;
    std::swap(rows[rank], rows[pivot]);
    const auto inverse = field.inverse(rows[rank][column]);
    for (std::size_t r = rank + 1; r < rows.size(); ++r) {
      if (rows[r][column] == 0) continue;
      const auto factor = field.negative(field.times(rows[r][column], inverse));
      for (std::size_t c = column; c < rows[r].size(); ++c) {
        rows[r][c] = field.add(rows[r][c], field.times(factor, rows[rank][c]));
      }
    }
    ++rank;
  }
  return rank;
}

}  // namespace

std::size_t nullity_of_limits(const KernelMesh& mesh, KernelScheme scheme, int steps) {
  const Field field = field_of(mesh);
  Net net{mesh, std::vector<Row>(mesh.vertices, Row(mesh.vertices, 0))};
  for (std::uint32_t v = 0; v < mesh.vertices; ++v) net.rows[v][v] = 1;
  for (int s = 0; s < steps; ++s) net = Step(field, net, scheme).refined();
  return mesh.vertices - rank_of(field, Step(field, net, scheme).limits());
}

bool vanishes(const KernelMesh& mesh, KernelScheme scheme, const std::vector<std::int8_t>& values) {
  const Field field = field_of(mesh);
  Net net{mesh, {}};
  for (const std::int8_t x : values) net.rows.push_back({field.ratio(x, 1)});
  const Net refined = Step(field, net, scheme).refined();
  const Step next(field, refined, scheme);
  // Only vertices that support the surface: neither isolated ones nor faces at the boundary of a dual scheme's.
  for (std::size_t f = 0; f < refined.mesh.faces.size(); ++f) {
    if (!next.has_surface(f)) continue;
    for (const std::uint32_t v : refined.mesh.faces[f]) {
      if (refined.rows[v][0] != 0) return false;
    }
  }
  return true;
}

}  // namespace oracle
