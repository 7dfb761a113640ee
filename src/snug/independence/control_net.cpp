#include <snug/independence/control_net.h>

#include <algorithm>
#include <numeric>

#include <support/contract.h>

namespace snug {
namespace {

using Edge = std::pair<std::uint32_t, std::uint32_t>;

// Where a face has an edge in this direction: (face, corner at its begin).
using DirectedEdges = std::map<Edge, std::pair<std::uint32_t, std::uint32_t>>;

DirectedEdges directed_edges(const NetPart& net) {
  DirectedEdges edges;
  for (std::uint32_t f = 0; f < net.faces.size(); ++f) {
    const auto& face = net.faces[f];
    for (std::uint32_t i = 0; i < face.size(); ++i) {
      edges[{face[i], face[(i + 1) % face.size()]}] = {f, i};
    }
  }
  return edges;
}

Edge undirected(std::uint32_t a, std::uint32_t b) { return {std::min(a, b), std::max(a, b)}; }

Weight scaled(const Weight& w, const mpq_class& factor) {
  Weight result{w.rational * factor, w.cosines};
  for (auto& [index, value] : result.cosines) value *= factor;
  return result;
}

Weight sum(const Weight& a, const Weight& b) {
  Weight result = a;
  result.rational += b.rational;
  result.cosines.insert(result.cosines.end(), b.cosines.begin(), b.cosines.end());
  return result;
}

// Weights of one point add up in its row.
class WeightedRow {
 public:
  void add(std::uint32_t point, const Weight& w) {
    const auto at =
        std::find_if(row_.begin(), row_.end(), [&](const auto& entry) { return entry.first == point; });
    if (at == row_.end()) {
      row_.emplace_back(point, w);
    } else {
      at->second = sum(at->second, w);
    }
  }
  void add(std::uint32_t point, const mpq_class& w) { add(point, Weight{w, {}}); }
  [[nodiscard]] WeightRow take() { return std::move(row_); }

 private:
  WeightRow row_;
};

class NetRefinement {
 public:
  NetRefinement(const NetPart& net, const ExactScheme& scheme, std::uint32_t order)
      : net_(net), scheme_(scheme), order_(order), edges_(directed_edges(net)), out_(net.points) {
    for (const auto& [edge, at] : edges_) out_[edge.first].push_back(edge.second);
    result_.of_vertex.resize(net.points);
    result_.of_face.resize(net.faces.size());
  }

  RefinedNet run() {
    if (scheme_.dual()) {
      add_dual();
    } else {
      add_primal();
    }
    result_.net.points = static_cast<std::uint32_t>(result_.rows.size());
    return std::move(result_);
  }

 private:
  std::uint32_t add_point(WeightRow row) {
    result_.rows.push_back(std::move(row));
    return static_cast<std::uint32_t>(result_.rows.size() - 1);
  }
  // Neighbours of a vertex that faces surround, counterclockwise; nothing at a boundary.
  [[nodiscard]] std::vector<std::uint32_t> around(std::uint32_t v) const {
    std::vector<std::uint32_t> ring;
    if (out_[v].empty()) return ring;
    std::uint32_t w = out_[v].front();
    do {
      ring.push_back(w);
      // The face left of v -> w ends with an edge into v; it begins at the next neighbour.
      const auto [f, i] = edges_.at({v, w});
      const auto& face = net_.faces[f];
      w = face[(i + face.size() - 1) % face.size()];
      if (!edges_.contains({v, w})) return {};
    } while (w != ring.front());
    return ring;
  }

  [[nodiscard]] std::vector<std::uint32_t> along_boundary(std::uint32_t v) const {
    std::vector<std::uint32_t> ends;
    for (const auto& [a, b] : net_.boundary) {
      if (a == v || b == v) ends.push_back(a == v ? b : a);
    }
    return ends;
  }

  void add_primal() {
    const bool loop = scheme_.scheme == Scheme::loop;
    for (std::uint32_t f = 0; f < net_.faces.size() && !loop; ++f) {
      WeightedRow row;
      for (const std::uint32_t v : net_.faces[f])
        row.add(v, fraction(1, static_cast<long>(net_.faces[f].size())));
      result_.of_face[f] = add_point(row.take());
    }
    for (const auto& [edge, at] : edges_) {
      if (edge.first > edge.second || !edges_.contains({edge.second, edge.first})) continue;
      result_.of_edge[edge] = add_point(loop ? loop_edge(edge) : catmark_edge(edge));
    }
    for (const Edge& edge : net_.boundary) {
      result_.of_edge[edge] =
          add_point({{edge.first, {fraction(1, 2), {}}}, {edge.second, {fraction(1, 2), {}}}});
    }
    for (std::uint32_t v = 0; v < net_.points; ++v) {
      if (const std::vector<std::uint32_t> ring = around(v); !ring.empty()) {
        result_.of_vertex[v] = add_point(loop ? loop_vertex(v, ring) : catmark_vertex(v, ring));
      } else if (const std::vector<std::uint32_t> ends = along_boundary(v); ends.size() == 2) {
        result_.of_vertex[v] = add_point(boundary_vertex(v, ends));
      }
    }
    for (std::uint32_t f = 0; f < net_.faces.size(); ++f) add_children(f, loop);
    add_boundary();
  }
  [[nodiscard]] WeightRow boundary_vertex(std::uint32_t v, const std::vector<std::uint32_t>& ends) const {
    if (net_.corners.contains(v)) return {{v, {1, {}}}};
    return {{v, {fraction(6, 8), {}}}, {ends[0], {fraction(1, 8), {}}}, {ends[1], {fraction(1, 8), {}}}};
  }
  void add_boundary() {
    for (const auto& [a, b] : net_.boundary) {
      const std::uint32_t middle = result_.of_edge.at({a, b});
      for (const auto& end : {result_.of_vertex[a], result_.of_vertex[b]}) {
        if (end) result_.net.boundary.insert(undirected(*end, middle));
      }
    }
    for (const std::uint32_t v : net_.corners) result_.net.corners.insert(*result_.of_vertex[v]);
  }
  WeightRow loop_edge(Edge edge) const {
    WeightedRow row;
    for (const Edge& side : {edge, Edge{edge.second, edge.first}}) {
      const auto [f, i] = edges_.at(side);
      row.add(side.first, fraction(3, 8));
      row.add(net_.faces[f][(i + 2) % 3], fraction(1, 8));
    }
    return row.take();
  }
  WeightRow catmark_edge(Edge edge) const {
    WeightedRow row;
    for (const Edge& side : {edge, Edge{edge.second, edge.first}}) {
      row.add(side.first, fraction(1, 4));
      const auto& face = net_.faces[edges_.at(side).first];
      for (const std::uint32_t v : face) row.add(v, fraction(1, 4 * static_cast<long>(face.size())));
    }
    return row.take();
  }
  WeightRow loop_vertex(std::uint32_t v, const std::vector<std::uint32_t>& ring) const {
    const auto m = static_cast<std::uint32_t>(ring.size());
    // m b = 5/8 - (3 + c_1)^2 / 64, where c_1^2 = 2 + c_2.
    Weight share{fraction(5, 8) - fraction(11, 64), {}};
    share = sum(share, scaled(twice_cosine(1, m, order_), fraction(-6, 64)));
    share = sum(share, scaled(twice_cosine(2, m, order_), fraction(-1, 64)));
    WeightedRow row;
    row.add(v, sum(Weight{1, {}}, scaled(share, -1)));
    for (const std::uint32_t w : ring) row.add(w, scaled(share, fraction(1, m)));
    return row.take();
  }
  // (Q + 2R + (m - 3) S)/m, R the mean of midpoints; the older rule: (Q + R + 2S)/4, R that of vertices.
  WeightRow catmark_vertex(std::uint32_t v, const std::vector<std::uint32_t>& ring) const {
    const long m = static_cast<long>(ring.size());
    const mpq_class q = scheme_.older_vertices ? fraction(1, 4) : fraction(1, m);
    const mpq_class r = scheme_.older_vertices ? fraction(1, 4) : fraction(1, m);
    WeightedRow row;
    row.add(v, scheme_.older_vertices ? fraction(1, 2) : fraction(m - 3, m) + fraction(1, m));
    for (const std::uint32_t w : ring) {
      row.add(w, r * fraction(1, m));
      const auto& face = net_.faces[edges_.at({v, w}).first];
      for (const std::uint32_t x : face) row.add(x, q * fraction(1, m * static_cast<long>(face.size())));
    }
    return row.take();
  }
  [[nodiscard]] std::optional<std::uint32_t> edge_point(std::uint32_t a, std::uint32_t b) const {
    const auto at = result_.of_edge.find(undirected(a, b));
    if (at == result_.of_edge.end()) return std::nullopt;
    return at->second;
  }
  void add_face(Edge name, const std::vector<std::optional<std::uint32_t>>& corners) {
    std::vector<std::uint32_t> face;
    for (const auto& corner : corners) {
      if (!corner) return;
      face.push_back(*corner);
    }
    result_.child[name] = static_cast<std::uint32_t>(result_.net.faces.size());
    result_.net.faces.push_back(std::move(face));
  }
  void add_children(std::uint32_t f, bool loop) {
    const auto& face = net_.faces[f];
    const std::size_t m = face.size();
    std::vector<std::optional<std::uint32_t>> middle;
    for (std::uint32_t i = 0; i < m; ++i) {
      const auto vertex = result_.of_vertex[face[i]];
      const auto after = edge_point(face[i], face[(i + 1) % m]),
                 before = edge_point(face[(i + m - 1) % m], face[i]);
      middle.push_back(after);
      if (loop) {
        add_face({f, i}, {vertex, after, before});
      } else {
        add_face({f, i}, {vertex, after, result_.of_face[f], before});
      }
    }
    if (loop) add_face({f, 3}, middle);
  }

  void add_dual() {
    SNUG_EXPECT(net_.boundary.empty());
    for (std::uint32_t f = 0; f < net_.faces.size(); ++f) {
      std::vector<std::uint32_t> fine;
      for (std::uint32_t i = 0; i < net_.faces[f].size(); ++i) {
        fine.push_back(result_.child[{f, i}] = add_point(dual_point(net_.faces[f], i)));
      }
      result_.net.faces.push_back(std::move(fine));
    }
    for (const auto& [edge, at] : edges_) {
      const auto other = edges_.find({edge.second, edge.first});
      if (edge.first > edge.second || other == edges_.end()) continue;
      const auto [f, i] = at;
      const auto [g, k] = other->second;
      const auto after = [&](std::uint32_t face, std::uint32_t corner) {
        return result_.child.at({face, (corner + 1) % static_cast<std::uint32_t>(net_.faces[face].size())});
      };
      result_.net.faces.push_back(
          {result_.child.at({f, i}), after(g, k), result_.child.at({g, k}), after(f, i)});
    }
    for (std::uint32_t v = 0; v < net_.points; ++v) {
      std::vector<std::uint32_t> fine;
      for (const std::uint32_t w : around(v)) fine.push_back(result_.child.at(edges_.at({v, w})));
      if (!fine.empty()) result_.net.faces.push_back(std::move(fine));
    }
  }
  WeightRow dual_point(const std::vector<std::uint32_t>& face, std::uint32_t i) const {
    const auto m = static_cast<std::uint32_t>(face.size());
    WeightedRow row;
    if (scheme_.scheme == Scheme::midedge) {
      row.add(face[i], fraction(1, 2));
      row.add(face[(i + 1) % m], fraction(1, 4));
      row.add(face[(i + m - 1) % m], fraction(1, 4));
      return row.take();
    }
    for (std::uint32_t j = 0; j < m; ++j) {
      Weight w = scaled(sum(Weight{3, {}}, twice_cosine(j, m, order_)), fraction(1, 4L * m));
      if (j == 0) w.rational += fraction(1, 4);
      row.add(face[(i + j) % m], w);
    }
    return row.take();
  }

  const NetPart& net_;
  const ExactScheme& scheme_;
  std::uint32_t order_;
  DirectedEdges edges_;
  std::vector<std::vector<std::uint32_t>> out_;  // ends of directed edges from each point
  RefinedNet result_;
};

// A triangle and all triangles at its corners; points as two_corner_net() has them.
NetPart triangle_with_ring(const std::vector<std::uint32_t>& valences) {
  NetPart net;
  net.faces.push_back({0, 1, 2});
  net.points = 4;
  const std::uint32_t first = 3;
  for (std::uint32_t i = 0, begin = first; i < 3; ++i) {
    // From the last edge to the next, counterclockwise.
    std::vector<std::uint32_t> around{(i + 2) % 3, begin};
    while (around.size() + 1 < valences[i]) {
      const bool closing = i == 2 && around.size() + 2 == valences[i];
      around.push_back(closing ? first : net.points++);
    }
    begin = around.back();
    around.push_back((i + 1) % 3);
    for (std::size_t k = 1; k + 1 < around.size(); ++k) net.faces.push_back({i, around[k], around[k + 1]});
  }
  return net;
}

NetPart quad_with_ring(const std::vector<std::uint32_t>& valences) {
  NetPart net;
  net.faces.push_back({0, 1, 2, 3});
  net.points = 4;
  std::vector<std::vector<std::uint32_t>> ends(4),
      diagonals(4);  // of edges and faces at a corner, beyond the piece's
  for (std::uint32_t i = 0; i < 4; ++i) {
    for (std::uint32_t k = 0; k + 2 < valences[i]; ++k) {
      if (k > 0) diagonals[i].push_back(net.points++);
      ends[i].push_back(net.points++);
    }
  }
  for (std::uint32_t i = 0; i < 4; ++i) {
    const std::uint32_t next = (i + 1) % 4;
    for (std::size_t k = 0; k < diagonals[i].size(); ++k) {
      net.faces.push_back({i, ends[i][k], diagonals[i][k], ends[i][k + 1]});
    }
    net.faces.push_back({i, ends[i].back(), ends[next].front(), next});
  }
  return net;
}

NetPart dual_fan(const std::vector<std::uint32_t>& sizes) {
  NetPart net;
  net.points = 5;
  for (std::uint32_t i = 0; i < 4; ++i) {
    std::vector<std::uint32_t> face{0, 1 + i};
    while (face.size() + 1 < sizes[i]) face.push_back(net.points++);
    face.push_back(1 + (i + 1) % 4);
    net.faces.push_back(std::move(face));
  }
  return net;
}

}  // namespace

Weight twice_cosine(std::uint32_t j, std::uint32_t m, std::uint32_t order) {
  j %= m;
  const std::uint32_t common = std::gcd(j, m);
  switch (m / common) {  // where Niven's theorem has a rational value
    case 1:
      return {2, {}};
    case 2:
      return {-2, {}};
    case 3:
      return {-1, {}};
    case 4:
      return {0, {}};
    case 6:
      return {1, {}};
    default:
      break;
  }
  SNUG_EXPECT(order % m == 0);
  const std::uint32_t index = j * (order / m);
  return {0, {{std::min(index, order - index), mpq_class(1)}}};
}

RefinedNet refine(const NetPart& net, const ExactScheme& scheme, std::uint32_t order) {
  return NetRefinement(net, scheme, order).run();
}

std::vector<std::uint32_t> embedded(const NetPart& net, std::array<std::uint32_t, 2> edge,
                                    const NetPart& larger, std::array<std::uint32_t, 2> larger_edge) {
  const DirectedEdges own = directed_edges(net), others = directed_edges(larger);
  constexpr std::uint32_t none = UINT32_MAX;
  std::vector<std::uint32_t> image(net.points, none);
  std::vector<bool> done(net.faces.size());
  std::vector<std::array<std::uint32_t, 2>> waiting{edge};
  image[edge[0]] = larger_edge[0];
  image[edge[1]] = larger_edge[1];
  while (!waiting.empty()) {
    const auto [a, b] = waiting.back();
    waiting.pop_back();
    const auto at = own.find({a, b});
    if (at == own.end() || done[at->second.first]) continue;
    const auto [f, i] = at->second;
    const auto [g, k] = others.at({image[a], image[b]});
    const auto &face = net.faces[f], &there = larger.faces[g];
    SNUG_EXPECT(face.size() == there.size());
    done[f] = true;
    for (std::size_t s = 0; s < face.size(); ++s) {
      std::uint32_t& to = image[face[(i + s) % face.size()]];
      SNUG_EXPECT(to == none || to == there[(k + s) % there.size()]);
      to = there[(k + s) % there.size()];
    }
    for (std::size_t s = 0; s < face.size(); ++s) waiting.push_back({face[(s + 1) % face.size()], face[s]});
  }
  SNUG_EXPECT(std::find(image.begin(), image.end(), none) == image.end());
  return image;
}

NetPart piece_net(const ExactScheme& scheme, std::uint32_t n) {
  NetPart net;
  if (scheme.scheme == Scheme::loop) {
    net.points = n + 6;
    const auto p = [&](std::uint32_t number) { return number - 1; };
    for (std::uint32_t j = 2; j <= n; ++j) net.faces.push_back({p(1), p(j), p(j + 1)});
    net.faces.push_back({p(1), p(n + 1), p(2)});
    for (const auto& [a, b, c] : {std::array{2U, n + 1, n + 2},
                                  {2U, n + 2, n + 3},
                                  {2U, n + 3, n + 4},
                                  {2U, n + 4, 3U},
                                  {n + 1, n + 5, n + 2},
                                  {n + 1, n + 6, n + 5},
                                  {n + 1, n, n + 6}}) {
      net.faces.push_back({p(a), p(b), p(c)});
    }
    return net;
  }
  if (scheme.scheme == Scheme::catmark) {
    net.points = 2 * n + 8;
    const auto e = [&](std::uint32_t j) { return 1 + 2 * (j % n); };
    const auto f = [&](std::uint32_t j) { return 2 + 2 * (j % n); };
    for (std::uint32_t j = 0; j < n; ++j) net.faces.push_back({0, e(j), f(j), e(j + 1)});
    const auto y = [&](std::uint32_t i) { return 2 * n + i; };  // 1 to 7
    for (const auto& [a, b, c, d] : {std::array{f(0), y(1), y(2), e(1)},
                                     {e(1), y(2), y(3), f(1)},
                                     {f(1), y(3), y(4), y(5)},
                                     {e(2), f(1), y(5), y(6)},
                                     {f(2), e(2), y(6), y(7)}}) {
      net.faces.push_back({a, b, c, d});
    }
    return net;
  }
  net.points = n + 5;
  const auto w = [&](std::uint32_t i) { return n + i - 1; };  // 1 to 5
  std::vector<std::uint32_t> polygon(n);
  std::iota(polygon.begin(), polygon.end(), 0U);
  net.faces = {polygon, {1, 0, w(2), w(1)}, {0, w(4), w(3), w(2)}, {0, n - 1, w(5), w(4)}};
  return net;
}

NetPart boundary_net(const ExactScheme& scheme, std::uint32_t n, const BoundaryFace& at) {
  SNUG_EXPECT(!scheme.dual() && at.face >= 1 && at.face <= n);
  const bool loop = scheme.scheme == Scheme::loop, first = at.face == 1, last = at.face == n;
  NetPart net;
  // The end of edge j of the fan, and with Catmull-Clark the far corner of the face after it.
  const auto e = [&](std::uint32_t j) { return loop ? 1 + j : 1 + 2 * j; };
  const auto f = [](std::uint32_t j) { return 2 + 2 * j; };
  for (std::uint32_t j = 0; j < n; ++j) {
    net.faces.push_back(loop ? std::vector{0U, e(j), e(j + 1)} : std::vector{0U, e(j), f(j), e(j + 1)});
  }
  // Beyond the face, from the fan's first side to its last: outer(0) lies straight beyond the end of the face's first edge.
  const std::uint32_t begin = e(n) + 1 + (first ? 0 : 1), left = at.face - 1, right = at.face;
  const auto outer = [&](std::uint32_t i) { return begin + i; };
  const auto before = begin - 1;  // beyond the face before, if there is one
  if (loop) {
    if (!first) {
      net.faces.push_back({e(left), e(left - 1), before});
      net.faces.push_back({e(left), before, outer(0)});
    }
    net.faces.push_back({e(left), outer(0), outer(1)});
    net.faces.push_back({e(right), e(left), outer(1)});
    net.faces.push_back({e(right), outer(1), outer(2)});
    if (!last) {
      net.faces.push_back({e(right), outer(2), outer(3)});
      net.faces.push_back({e(right), outer(3), e(right + 1)});
    }
  } else {
    if (!first) net.faces.push_back({f(left - 1), before, outer(0), e(left)});
    net.faces.push_back({f(left), e(left), outer(0), outer(1)});
    net.faces.push_back({f(left), outer(1), outer(2), outer(3)});
    net.faces.push_back({f(left), outer(3), outer(4), e(right)});
    if (!last) net.faces.push_back({f(right), e(right), outer(4), outer(5)});
  }
  net.points = begin + (loop ? 3 : 5) + (last ? 0 : 1);
  net.boundary = {{0, e(0)}, {0, e(n)}};
  if (first) net.boundary.emplace(e(0), outer(0));
  if (last) net.boundary.emplace(e(n), outer(loop ? 2 : 4));
  if (at.corner) net.corners = {0};
  return net;
}

NetPart two_corner_net(const ExactScheme& scheme, const PieceCorners& corners) {
  const bool loop = scheme.scheme == Scheme::loop;
  std::vector<std::uint32_t> valences(loop ? 3 : 4, loop ? 6 : 4);
  valences[0] = corners.valence;
  valences[corners.opposite ? 2 : 1] = *corners.second;
  if (scheme.dual()) return dual_fan(valences);
  return loop ? triangle_with_ring(valences) : quad_with_ring(valences);
}

NetPart annulus_net(const ExactScheme& scheme, std::uint32_t n) {
  NetPart net;
  if (scheme.scheme == Scheme::loop) {
    net.points = 3 * n + 1;
    const auto u = [&](std::uint32_t j) { return 1 + j % n; };
    const auto across = [&](std::uint32_t j) { return n + 1 + 2 * (j % n); };
    const auto beyond = [&](std::uint32_t j) { return n + 2 + 2 * (j % n); };  // of u(j + 1)
    for (std::uint32_t j = 0; j < n; ++j) {
      net.faces.push_back({0, u(j), u(j + 1)});
      net.faces.push_back({u(j + 1), u(j), across(j)});
      net.faces.push_back({u(j + 1), across(j), beyond(j)});
      net.faces.push_back({u(j + 1), beyond(j), across(j + 1)});
    }
    return net;
  }
  if (scheme.scheme == Scheme::catmark) {
    net.points = 6 * n + 1;
    const auto e = [&](std::uint32_t j) { return 1 + 2 * (j % n); };
    const auto f = [&](std::uint32_t j) { return 2 + 2 * (j % n); };
    const auto o = [&](std::uint32_t i) { return 2 * n + 1 + i % (4 * n); };
    for (std::uint32_t j = 0; j < n; ++j) {
      net.faces.push_back({0, e(j), f(j), e(j + 1)});
      net.faces.push_back({f(j), e(j), o(4 * j), o(4 * j + 1)});
      net.faces.push_back({f(j), o(4 * j + 1), o(4 * j + 2), o(4 * j + 3)});
      net.faces.push_back({f(j), o(4 * j + 3), o(4 * j + 4), e(j + 1)});
    }
    return net;
  }
  net.points = 4 * n;
  std::vector<std::uint32_t> polygon(n);
  std::iota(polygon.begin(), polygon.end(), 0U);
  net.faces = {polygon};
  for (std::uint32_t j = 0; j < n; ++j) {
    const std::uint32_t next = (j + 1) % n, l = n + 3 * j, d = l + 1, r = l + 2;
    net.faces.push_back({j, l, d, r});
    net.faces.push_back({next, j, r, n + 3 * next});
  }
  return net;
}

NetPart closed_net(const ExactScheme& scheme, std::uint32_t n) {
  NetPart net;
  if (scheme.scheme == Scheme::loop) {
    net.points = n + 2;
    for (std::uint32_t j = 0; j < n; ++j) {
      const std::uint32_t a = 2 + j, b = 2 + (j + 1) % n;
      net.faces.push_back({0, a, b});
      net.faces.push_back({1, b, a});
    }
  } else if (scheme.scheme == Scheme::catmark) {
    net.points = 2 * n + 2;
    const auto r = [&](std::uint32_t i) { return 2 + i % (2 * n); };
    for (std::uint32_t i = 0; i < n; ++i) {
      net.faces.push_back({0, r(2 * i), r(2 * i + 1), r(2 * i + 2)});
      net.faces.push_back({1, r(2 * i + 3), r(2 * i + 2), r(2 * i + 1)});
    }
  } else {
    net.points = 2 * n;
    std::vector<std::uint32_t> bottom, top;
    for (std::uint32_t j = 0; j < n; ++j) {
      bottom.push_back(n - 1 - j);
      top.push_back(n + j);
      const std::uint32_t next = (j + 1) % n;
      net.faces.push_back({j, next, n + next, n + j});
    }
    net.faces.push_back(bottom);
    net.faces.push_back(top);
  }
  return net;
}

}  // namespace snug
