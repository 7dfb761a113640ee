#include <oracle/polygon_net.h>

#include <algorithm>
#include <map>

namespace oracle::detail {

namespace {

using Id = std::uint32_t;

Quad magnitude(const Quad& x) { return x < 0 ? -x : x; }

/// Where the same masks apply at every level from here on; `ring` where no closed formula is known.
enum class Future { corner, crease, smooth, ring, open };

template <class P>
Future future(const NetOf<P>& net, const Neighbours& near, Id v, const Rules& rules) {
  std::size_t infinite = 0, finite = 0;
  for (const Id e : near.vertex_edges[v]) {
    infinite += net.edges[e].sharpness >= kInfinitelySharp ? 1 : 0;
    finite += net.edges[e].sharpness > 0 && net.edges[e].sharpness < kInfinitelySharp ? 1 : 0;
  }
  const bool own = net.sharpness[v] > 0;
  if (infinite > 2 || net.sharpness[v] >= kInfinitelySharp) return Future::corner;
  if (finite > 0 || own) return Future::open;
  if (infinite == 2) return Future::crease;
  if (rules.scheme == PrimalScheme::catmull_clark)
    for (const Id f : near.vertex_faces[v])
      if (net.faces[f].vertices.size() != 4) return Future::open;
  const bool own_rule = rules.old_vertex_rule && near.vertex_edges[v].size() != 4;
  return infinite == 1 || own_rule ? Future::ring : Future::smooth;
}

/// (4 v + ends) / 6; Loop: w v + (1 - w) mean(ring); Catmull-Clark: (n^2 v + 4 sum(ring) + sum(opposite)) /
/// (n (n + 5)).
template <class P>
P closed_formula(const NetOf<P>& net, const Neighbours& near, Id v, Future kind, const Rules& rules) {
  if (kind == Future::corner) return net.points[v];
  P p{}, ring{};
  for (const Id e : near.vertex_edges[v])
    if (kind == Future::smooth || net.edges[e].sharpness > 0)
      add(ring, 1, net.points[net.edges[e].a == v ? net.edges[e].b : net.edges[e].a]);
  Quad whole = 1;
  const Id valence = static_cast<Id>(near.vertex_edges[v].size());
  if (kind == Future::crease) {
    whole = 6;
    add(p, 4, net.points[v]);
    add(p, 1, ring);
  } else if (rules.scheme == PrimalScheme::loop) {
    const auto w = loop_weights<Quad>(valence);
    add(p, w.limit_self, net.points[v]);
    add(p, w.limit_ring, ring);
  } else {
    const Quad n = valence;
    whole = n * (n + 5);
    add(p, n * n, net.points[v]);
    add(p, 4, ring);
    for (const Id f : near.vertex_faces[v]) {
      const auto& corners = net.faces[f].vertices;
      const auto k = std::find(corners.begin(), corners.end(), v) - corners.begin();
      add(p, 1, net.points[corners[static_cast<std::size_t>(k + 2) % 4]]);
    }
  }
  divide(p, whole);
  return p;
}

/// The faces at `v`, which becomes vertex 0, and all edges that touch them: refine() of it is right at the
/// children of `v` and its edges and faces.
PolygonNet piece_around(const PolygonNet& net, const Neighbours& near, Id v) {
  PolygonNet piece;
  std::map<Id, Id> vertices, edges;
  const auto vertex = [&](Id old) {
    const auto [at, is_new] = vertices.try_emplace(old, static_cast<Id>(piece.points.size()));
    if (is_new) {
      piece.points.push_back(net.points[old]);
      piece.sharpness.push_back(net.sharpness[old]);
    }
    return at->second;
  };
  const auto edge = [&](Id old) {
    const auto [at, is_new] = edges.try_emplace(old, static_cast<Id>(piece.edges.size()));
    if (is_new) {
      const Id a = vertex(net.edges[old].a), b = vertex(net.edges[old].b);
      piece.edges.push_back({a, b, net.edges[old].sharpness});
    }
    return at->second;
  };
  vertex(v);
  std::vector<Id> faces = near.vertex_faces[v];
  std::sort(faces.begin(), faces.end());
  faces.erase(std::unique(faces.begin(), faces.end()), faces.end());
  for (const Id f : faces) {
    PolygonNet::Face face;
    for (const Id w : net.faces[f].vertices) {
      face.vertices.push_back(vertex(w));
      for (const Id e : near.vertex_edges[w]) edge(e);
    }
    for (const Id e : net.faces[f].edges) face.edges.push_back(edge(e));
    piece.faces.push_back(std::move(face));
  }
  return piece;
}

/// How far the corners of the faces of a piece are from vertex 0 at most, along an axis.
Quad extent(const PolygonNet& piece) {
  Quad most = 0;
  for (const auto& face : piece.faces)
    for (const Id w : face.vertices)
      for (std::size_t x = 0; x < 3; ++x)
        most = std::max(most, magnitude(piece.points[w][x] - piece.points[0][x]));
  return most;
}

Quad largest(const PolygonNet& net) {
  Quad most = 0;
  for (const QuadPoint& p : net.points)
    for (const Quad& x : p) most = std::max(most, magnitude(x));
  return most;
}

}  // namespace

template <class P>
std::optional<P> limit_in_star(const NetOf<P>& net, const Neighbours& near, Id v, const Rules& rules) {
  const Future kind = future(net, near, v, rules);
  if (kind == Future::ring || kind == Future::open) return {};
  return closed_formula(net, near, v, kind, rules);
}
template std::optional<QuadPoint> limit_in_star(const PolygonNet&, const Neighbours&, Id, const Rules&);
template std::optional<SparseRow> limit_in_star(const NetOf<SparseRow>&, const Neighbours&, Id, const Rules&);

Limits limit_points(const PolygonNet& net, const Rules& rules, const std::vector<char>& wanted) {
  const Neighbours near(net);
  const Quad small = largest(net) * Quad(0x1p-80);
  Limits limits{net.points, std::vector<Quad>(net.points.size(), 0)};
  for (Id v = 0; v < net.points.size(); ++v) {
    if (!wanted[v]) continue;
    Future kind = future(net, near, v, rules);
    if (kind != Future::ring && kind != Future::open) {
      limits.points[v] = closed_formula(net, near, v, kind, rules);
      continue;
    }
    PolygonNet piece = piece_around(net, near, v);
    while (true) {
      const Neighbours around(piece);
      kind = future(piece, around, 0, rules);
      if (kind == Future::ring && extent(piece) <= small) {
        limits.points[v] = piece.points[0];
        limits.error[v] = extent(piece);  // the limit lies in the hull of the ring
        break;
      }
      if (kind != Future::ring && kind != Future::open) {
        limits.points[v] = closed_formula(piece, around, 0, kind, rules);
        break;
      }
      const PolygonNet fine = refine(piece, rules);
      const Id child = static_cast<Id>(fine.points.size() - piece.points.size());
      piece = piece_around(fine, Neighbours(fine), child);
    }
  }
  return limits;
}

}  // namespace oracle::detail
