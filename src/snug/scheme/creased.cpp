#include <snug/scheme/creased.h>

#include <array>

namespace snug {

namespace {

// The rows of vertices and edges.
class Rows {
 public:
  Rows(const CreasedRules& rules, const RuledMesh& mesh) : rules_(rules), mesh_(mesh) {}

  void add_vertex(VertexId v, Stencils& out) {
    if (topology_.isolated(v)) {
      out.add_unit_row(v.value());
      return;
    }
    gather_star(mesh_, v, star_);
    const VertexRule now = vertex_rule(star_);
    if (is_stationary(star_)) {
      add_by_rule(v, now, star_.spokes, Interval(1));
    } else {
      // Where the rule changes, the share of the old one is the mean of the sharpnesses that end.
      Interval sum = 0.0;
      int ending = 0;
      const auto left = [&](double sharpness, double next) {
        if (sharpness > 0 && next == 0) sum = ++ending == 1 ? Interval(sharpness) : sum + Interval(sharpness);
        return next;
      };
      next_ = star_.spokes;
      for (Spoke& spoke : next_) {
        spoke.sharpness = left(spoke.sharpness, decayed(star_, spoke, mesh_.options.creases));
      }
      const VertexRule then = vertex_rule(left(star_.sharpness, decayed(star_.sharpness)), next_);
      Interval share = 1.0;
      if (then != now && ending > 0 && sum.lower < ending) {
        if (ending > 1) sum = sum / Interval(ending);
        share = {sum.lower, std::min(sum.upper, 1.0)};
      }
      add_by_rule(v, now, star_.spokes, share);
      if (share != Interval(1)) add_by_rule(v, then, next_, Interval(1) - share);
    }
    row_.end_row(out);
  }

  void add_edge(EdgeId e, Stencils& out) {
    const HalfEdge h = topology_.half_of(e);
    const double s = edge_sharpness(topology_, mesh_.sharpness, e);
    const bool crease = s >= 1 || (s > 0 && stays_sharp(e));
    const Interval share = crease ? 1.0 : s;
    if (s > 0) {
      for (const VertexId end : {topology_.from(h), topology_.to(h)})
        row_.add(end.value(), share * Interval(0.5));
    }
    if (!crease) {
      rules_.add_smooth_edge(topology_, mesh_.options.triangles, h, s > 0 ? Interval(1) - share : Interval(1),
                             row_);
    }
    row_.end_row(out);
  }

 private:
  void add_by_rule(VertexId v, VertexRule rule, std::span<const Spoke> spokes, const Interval& share) {
    switch (rule) {
      case VertexRule::corner:
        row_.add(v.value(), share);
        return;
      case VertexRule::crease:
        row_.add(v.value(), times(share, 0.75));
        for (const Spoke& spoke : spokes) {
          if (spoke.sharpness > 0) row_.add(spoke.end.value(), times(share, 0.125));
        }
        return;
      case VertexRule::smooth:
        rules_.add_smooth_vertex(topology_, v, star_, share, row_);
        return;
    }
  }

  // Chaikin may keep both halves of an edge sharp that is below 1.
  bool stays_sharp(EdgeId e) {
    if (mesh_.options.creases == CreaseMethod::uniform) return false;
    const HalfEdge h = topology_.half_of(e);
    for (const VertexId v : {topology_.from(h), topology_.to(h)}) {
      gather_star(mesh_, v, star_);
      for (const Spoke& spoke : star_.spokes) {
        if (spoke.edge == e && decayed(star_, spoke, mesh_.options.creases) == 0) return false;
      }
    }
    return true;
  }

  const CreasedRules& rules_;
  const RuledMesh& mesh_;
  const Topology& topology_ = mesh_.topology;
  Star star_;
  std::vector<Spoke> next_;
  RowBuilder row_;
};

// Where a face runs along an edge twice, or along one from a vertex to itself, pieces of what ended the fans
// may be twins after a step: they are kept infinitely sharp. The middle of the latter is the vertex.
void keep_closed_edges_sharp(const Topology& topology, std::size_t corners, const Topology& refined,
                             Sharpness& result) {
  for (std::size_t e = 0; e < topology.edge_count(); ++e) {
    if (!topology.ends_fans(EdgeId(e))) continue;
    const HalfEdge h = topology.half_of(EdgeId(e));
    for (const HalfEdge half : halves_of(topology, corners, h)) {
      const EdgeId own = refined.edge_of(half);
      if (refined.ends_fans(own)) continue;
      set_sharpness(result.edges, refined.edge_count(), own.index(), infinite_sharpness);
    }
    if (topology.from(h) != topology.to(h)) continue;
    set_sharpness(result.vertices, refined.vertex_count(), topology.vertex_count() + e, infinite_sharpness);
  }
}

Sharpness sharpness_left(const RuledMesh& mesh, std::size_t corners, const Topology& refined) {
  const auto& [topology, options, sharpness] = mesh;
  Sharpness result;
  Star star;
  for (std::size_t e = 0; e < sharpness.edges.size(); ++e) {
    if (sharpness.edges[e] == 0 || topology.ends_fans(EdgeId(e))) continue;
    const HalfEdge h = topology.half_of(EdgeId(e));
    const std::array<HalfEdge, 2> halves = halves_of(topology, corners, h);
    for (std::size_t end = 0; end < 2; ++end) {
      double s = decayed(sharpness.edges[e]);
      if (options.creases == CreaseMethod::chaikin) {
        gather_star(mesh, end == 0 ? topology.from(h) : topology.to(h), star);
        for (const Spoke& spoke : star.spokes) {
          if (spoke.edge == EdgeId(e)) s = decayed(star, spoke, options.creases);
        }
      }
      set_sharpness(result.edges, refined.edge_count(), refined.edge_of(halves[end]).index(), s);
    }
  }
  result.vertices_complete = sharpness.vertices_complete || !topology.is_manifold();
  const bool derived = result.vertices_complete && !sharpness.vertices_complete;
  for (std::size_t v = 0; v < (derived ? topology.vertex_count() : sharpness.vertices.size()); ++v) {
    const double s = derived ? vertex_sharpness(topology, sharpness, VertexId(v), options.boundary)
                             : sharpness.vertices[v];
    set_sharpness(result.vertices, refined.vertex_count(), v, decayed(s));
  }
  if (!topology.is_manifold()) keep_closed_edges_sharp(topology, corners, refined, result);
  return result;
}

}  // namespace

RefinedTopology CreasedRules::refine(const RuledMesh& mesh, const WorkMonitor& monitor) const {
  const Topology& topology = mesh.topology;
  const std::size_t vertices = topology.vertex_count(), edges = topology.edge_count();
  RefinedTopology result;
  result.stencils.reserve(vertices + edges, 7 * vertices + 4 * edges);
  Rows rows(*this, mesh);
  for (std::size_t v = 0; v < vertices; ++v) {
    monitor.checkpoint();
    rows.add_vertex(VertexId(v), result.stencils);
  }
  for (std::size_t e = 0; e < edges; ++e) {
    monitor.checkpoint();
    rows.add_edge(EdgeId(e), result.stencils);
  }
  if (!triangular()) add_face_means(topology, monitor, result.stencils);
  result.topology = split_faces(topology, corners);
  monitor.checkpoint();
  result.sharpness = sharpness_left(mesh, corners, result.topology);
  return result;
}

Topology CreasedRules::ring(std::span<const CornerFan> fans) const {
  return ring_of_face(fans.first(corners));
}

}  // namespace snug
