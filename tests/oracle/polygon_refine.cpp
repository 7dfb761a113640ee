#include <oracle/polygon_net.h>

#include <algorithm>

namespace oracle::detail {

namespace {

using Id = std::uint32_t;
using Edge = NetEdge;

bool is_infinite(const Quad& s) { return s >= kInfinitelySharp; }
bool is_finite(const Quad& s) { return s > 0 && !is_infinite(s); }

Quad lowered(const Quad& s) { return is_infinite(s) ? s : s > 1 ? s - 1 : Quad(0); }

/// weight * a + (1 - weight) * b
template <class P>
P blend(const Quad& weight, const P& a, const P& b) {
  P p{};
  add(p, weight, a);
  add(p, 1 - weight, b);
  return p;
}

template <class P>
class Step {
 public:
  Step(const NetOf<P>& net, const Rules& rules) : net_(net), rules_(rules), near_(net) {
    if (catmull_clark())
      for (const auto& face : net.faces) face_points_.push_back(mean(face.vertices));
    lower_edges();
  }

  [[nodiscard]] NetOf<P> result() {
    fine_.points = face_points_;
    for (Id e = 0; e < net_.edges.size(); ++e) fine_.points.push_back(edge_point(e));
    fine_.sharpness.assign(fine_.points.size(), Quad(0));
    for (Id v = 0; v < net_.points.size(); ++v) {
      fine_.points.push_back(vertex_point(v));
      fine_.sharpness.push_back(lowered(net_.sharpness[v]));
    }
    for (Id e = 0; e < net_.edges.size(); ++e) {
      fine_.edges.push_back({vertex_child(net_.edges[e].a), edge_child(e), children_[e][0]});
      fine_.edges.push_back({edge_child(e), vertex_child(net_.edges[e].b), children_[e][1]});
    }
    for (Id f = 0; f < net_.faces.size(); ++f) catmull_clark() ? split_to_quads(f) : split_to_triangles(f);
    return std::move(fine_);
  }

 private:
  [[nodiscard]] bool catmull_clark() const { return rules_.scheme == PrimalScheme::catmull_clark; }

  [[nodiscard]] P mean(const std::vector<Id>& vertices) const {
    P p{};
    for (const Id v : vertices) add(p, 1, net_.points[v]);
    divide(p, static_cast<Quad>(vertices.size()));
    return p;
  }

  // ---- sharpness

  /// Sharpness of the half of `e` at its end `v`. Chaikin: 3/4 of its own and 1/4 of the mean of the other
  /// finitely sharp edges there, less one.
  [[nodiscard]] Quad child_sharpness(Id e, Id v) const {
    const Quad s = net_.edges[e].sharpness;
    if (!rules_.chaikin || !is_finite(s)) return lowered(s);
    Quad sum = 0;
    int count = 0;
    for (const Id other : near_.vertex_edges[v])
      if (is_finite(net_.edges[other].sharpness)) {
        sum += net_.edges[other].sharpness;
        ++count;
      }
    if (count < 2) return lowered(s);
    const Quad child = Quad(0.75) * s + Quad(0.25) * (sum - s) / static_cast<Quad>(count - 1) - 1;
    return child > 0 ? child : Quad(0);
  }
  void lower_edges() {
    for (Id e = 0; e < net_.edges.size(); ++e)
      children_.push_back({child_sharpness(e, net_.edges[e].a), child_sharpness(e, net_.edges[e].b)});
  }

  // ---- points

  [[nodiscard]] P midpoint(const Edge& edge) const {
    return blend(0.5, net_.points[edge.a], net_.points[edge.b]);
  }

  /// The vertex of a triangle that is not on its edge `e`.
  [[nodiscard]] Id opposite(Id f, Id e) const {
    const auto& face = net_.faces[f];
    const auto k = std::find(face.edges.begin(), face.edges.end(), e) - face.edges.begin();
    return face.vertices[static_cast<std::size_t>(k + 2) % 3];
  }

  [[nodiscard]] P smooth_edge_point(Id e) const {
    const Edge& edge = net_.edges[e];
    const auto& faces = near_.edge_faces[e];
    // Only edges with two faces are ever smooth; in a piece of a net others occur, and nobody uses them.
    if (faces.size() != 2) return midpoint(edge);
    Quad face_weight = catmull_clark() ? Quad(0.25) : Quad(0.125);
    if (catmull_clark() && rules_.smooth_triangles) {
      face_weight = 0;
      for (const Id f : faces)
        face_weight += (net_.faces[f].vertices.size() == 3 ? Quad(47) / 100 : Quad(0.25)) / 2;
    }
    P p{};
    for (const Id f : faces)
      add(p, face_weight, catmull_clark() ? face_points_[f] : net_.points[opposite(f, e)]);
    add(p, 1 - 2 * face_weight, midpoint(edge));
    return p;
  }

  [[nodiscard]] P edge_point(Id e) const {
    const Edge& edge = net_.edges[e];
    if (!(edge.sharpness > 0)) return smooth_edge_point(e);
    if (children_[e][0] > 0 && children_[e][1] > 0) return midpoint(edge);
    Quad weight = edge.sharpness;
    if (rules_.clamp_dart_edges && weight > 1) weight = 1;
    return blend(weight, midpoint(edge), smooth_edge_point(e));
  }

  [[nodiscard]] P smooth_vertex_point(Id v) const {
    const auto& edges = near_.vertex_edges[v];
    const auto& faces = near_.vertex_faces[v];
    const Quad n = static_cast<Quad>(edges.size());
    P p{};
    if (!catmull_clark()) {
      const auto& w = weights()[static_cast<Id>(edges.size())];
      for (const Id e : edges) add(p, w.vertex_ring, net_.points[other_end(e, v)]);
      add(p, w.vertex_self, net_.points[v]);
      return p;
    }
    P q{}, r{};
    for (const Id f : faces) add(q, 1 / static_cast<Quad>(faces.size()), face_points_[f]);
    for (const Id e : edges) add(r, 1 / n, midpoint(net_.edges[e]));
    const Quad whole = rules_.old_vertex_rule ? Quad(4) : n;
    add(p, 1 / whole, q);
    add(p, 2 / whole, r);
    add(p, (whole - 3) / whole, net_.points[v]);
    return p;
  }
  static WeightTable<Quad>& weights() {
    static WeightTable<Quad> table;
    return table;
  }
  [[nodiscard]] Id other_end(Id e, Id v) const {
    return net_.edges[e].a == v ? net_.edges[e].b : net_.edges[e].a;
  }

  /// By one rule; `sharp` tells a crease its two edges.
  [[nodiscard]] P by_rule(Rule rule, Id v, const std::vector<Quad>& sharp) const {
    if (rule == Rule::smooth || rule == Rule::dart) return smooth_vertex_point(v);
    if (rule == Rule::corner) return net_.points[v];
    P p{};
    for (std::size_t i = 0; i < sharp.size(); ++i)
      if (sharp[i] > 0) add(p, 0.125, net_.points[other_end(near_.vertex_edges[v][i], v)]);
    add(p, 0.75, net_.points[v]);
    return p;
  }

  [[nodiscard]] P vertex_point(Id v) const {
    const auto& edges = near_.vertex_edges[v];
    std::vector<Quad> parent, child;
    for (const Id e : edges) {
      parent.push_back(net_.edges[e].sharpness);
      child.push_back(child_sharpness(e, v));
    }
    const Quad own = net_.sharpness[v], own_child = lowered(own);
    const Rule before = vertex_rule(own, parent), after = vertex_rule(own_child, child);
    const P p = by_rule(before, v, parent);
    if (before == Rule::smooth || before == Rule::dart || before == after) return p;
    // The mean of the sharpnesses that vanish, one at most, is the old rule's weight.
    Quad sum = 0;
    int count = 0;
    const auto vanishes = [&](const Quad& s) {
      sum += s;
      ++count;
    };
    if (own > 0 && !(own_child > 0)) vanishes(own);
    for (std::size_t i = 0; i < edges.size(); ++i)
      if (parent[i] > 0 && !(child[i] > 0)) vanishes(parent[i]);
    Quad weight = count == 0 ? Quad(0) : sum / static_cast<Quad>(count);
    if (weight > 1) weight = 1;
    return blend(weight, p, by_rule(after, v, child));
  }

  // ---- faces

  [[nodiscard]] Id edge_child(Id e) const { return static_cast<Id>(face_points_.size()) + e; }
  [[nodiscard]] Id vertex_child(Id v) const { return edge_child(static_cast<Id>(net_.edges.size())) + v; }
  /// The half of side k of a face at its start or its end.
  [[nodiscard]] Id half(const NetFace& face, std::size_t k, bool at_end) const {
    const Id e = face.edges[k];
    const bool forward = net_.edges[e].a == face.vertices[k];
    return 2 * e + (forward == at_end ? 1 : 0);
  }

  void split_to_quads(Id f) {
    const auto& face = net_.faces[f];
    const std::size_t n = face.vertices.size();
    const Id inner = static_cast<Id>(fine_.edges.size());
    for (std::size_t k = 0; k < n; ++k) fine_.edges.push_back({edge_child(face.edges[k]), f, Quad(0)});
    for (std::size_t k = 0; k < n; ++k) {
      const std::size_t before = (k + n - 1) % n;
      NetFace child{
          {vertex_child(face.vertices[k]), edge_child(face.edges[k]), f, edge_child(face.edges[before])},
          {half(face, k, false), inner + static_cast<Id>(k), inner + static_cast<Id>(before),
           half(face, before, true)}};
      if (n == 4)
        for (auto* ids : {&child.vertices, &child.edges})
          std::rotate(ids->begin(), ids->end() - static_cast<std::ptrdiff_t>(k), ids->end());
      fine_.faces.push_back(std::move(child));
    }
  }

  void split_to_triangles(Id f) {
    const auto& face = net_.faces[f];
    const Id inner = static_cast<Id>(fine_.edges.size());  // inner + k cuts corner k off
    std::array<Id, 3> m;
    for (std::size_t k = 0; k < 3; ++k) m[k] = edge_child(face.edges[k]);
    for (std::size_t k = 0; k < 3; ++k) fine_.edges.push_back({m[k], m[(k + 2) % 3], Quad(0)});
    for (std::size_t k = 0; k < 3; ++k) {
      const std::size_t before = (k + 2) % 3;
      NetFace child{{vertex_child(face.vertices[k]), m[k], m[before]},
                    {half(face, k, false), inner + static_cast<Id>(k), half(face, before, true)}};
      for (auto* ids : {&child.vertices, &child.edges})
        std::rotate(ids->begin(), ids->end() - static_cast<std::ptrdiff_t>(k), ids->end());
      fine_.faces.push_back(std::move(child));
    }
    fine_.faces.push_back({{m[1], m[2], m[0]}, {inner + 2, inner, inner + 1}});
  }

  const NetOf<P>& net_;
  const Rules& rules_;
  Neighbours near_;
  std::vector<P> face_points_;
  std::vector<std::array<Quad, 2>> children_;  // sharpness of the halves at a and at b
  NetOf<P> fine_;
};

}  // namespace

Rule vertex_rule(const Quad& own, const std::vector<Quad>& edges) {
  const auto sharp = std::count_if(edges.begin(), edges.end(), [](const Quad& s) { return s > 0; });
  if (own > 0 || sharp > 2) return Rule::corner;
  return sharp == 2 ? Rule::crease : sharp == 1 ? Rule::dart : Rule::smooth;
}

template <class P>
NetOf<P> refine(const NetOf<P>& net, const Rules& rules) {
  return Step<P>(net, rules).result();
}
template PolygonNet refine(const PolygonNet&, const Rules&);
template NetOf<SparseRow> refine(const NetOf<SparseRow>&, const Rules&);

}  // namespace oracle::detail
