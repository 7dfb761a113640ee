#include <snug/scheme/creased.h>

#include <algorithm>
#include <array>

#include <snug/scheme/loop_masks.h>
#include <snug/scheme/rings.h>

namespace snug {

namespace {

// The rows of vertices and edges.
class Rows {
 public:
  Rows(const CreasedRules& rules, const Topology& topology, const SchemeOptions& options,
       const Sharpness& sharpness)
      : rules_(rules), topology_(topology), options_(options), sharpness_(sharpness) {}

  void add_vertex(VertexId v, Stencils& out) {
    if (topology_.isolated(v)) {
      out.add(v.value(), 1.0);
      out.end_row();
      return;
    }
    gather_star(topology_, sharpness_, v, options_.boundary, star_);
    const VertexRule now = vertex_rule(star_.sharpness, star_.spokes);
    if (is_stationary(star_)) {
      add_by_rule(v, now, star_.spokes, Interval(1));
    } else {
      // Where the rule changes, the share of the old one is the mean of the sharpnesses that end.
      next_ = star_.spokes;
      double sum = 0;
      int ending = 0;
      for (std::size_t i = 0; i < next_.size(); ++i) {
        next_[i].sharpness = decayed(star_, star_.spokes[i], options_.creases);
        if (star_.spokes[i].sharpness > 0 && next_[i].sharpness == 0)
          sum += star_.spokes[i].sharpness, ++ending;
      }
      const double own = decayed(star_.sharpness);
      if (star_.sharpness > 0 && own == 0) sum += star_.sharpness, ++ending;
      const VertexRule then = vertex_rule(own, next_);
      const Interval share = then == now || ending == 0 || sum >= ending ? Interval(1)
                             : ending == 1                               ? Interval(sum)
                                                                         : Interval(sum) / Interval(ending);
      add_by_rule(v, now, star_.spokes, share);
      if (share != Interval(1)) add_by_rule(v, then, next_, Interval(1) - share);
    }
    row_.end_row(out);
  }

  void add_edge(EdgeId e, Stencils& out) {
    const HalfEdge h = topology_.half_of(e);
    const double s = edge_sharpness(topology_, sharpness_, e);
    const bool crease = s >= 1 || (s > 0 && stays_sharp(e));
    const Interval share = crease ? 1.0 : s;
    if (s > 0) {
      row_.add(topology_.from(h).value(), share * Interval(loop::curve_edge_end));
      row_.add(topology_.to(h).value(), share * Interval(loop::curve_edge_end));
    }
    if (!crease) {
      rules_.add_smooth_edge(topology_, options_, h, s > 0 ? Interval(1) - share : Interval(1), row_);
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
        row_.add(v.value(), times(share, loop::curve_centre));
        for (const Spoke& spoke : spokes) {
          if (spoke.sharpness > 0) row_.add(spoke.end.value(), times(share, loop::curve_side));
        }
        return;
      case VertexRule::smooth:
        rules_.add_smooth_vertex(topology_, options_, v, star_, share, row_);
        return;
    }
  }

  // Chaikin may keep both halves of an edge sharp that is below 1.
  bool stays_sharp(EdgeId e) {
    if (options_.creases == CreaseMethod::uniform) return false;
    const HalfEdge h = topology_.half_of(e);
    for (const VertexId v : {topology_.from(h), topology_.to(h)}) {
      gather_star(topology_, sharpness_, v, options_.boundary, star_);
      for (const Spoke& spoke : star_.spokes) {
        if (spoke.edge == e && decayed(star_, spoke, options_.creases) == 0) return false;
      }
    }
    return true;
  }

  const CreasedRules& rules_;
  const Topology& topology_;
  const SchemeOptions& options_;
  const Sharpness& sharpness_;
  Star star_;
  std::vector<Spoke> next_;
  RowBuilder row_;
};

// Where a face runs along an edge twice, or along one from a vertex to itself, pieces of what ended the fans may be twins
// after a step: they are kept infinitely sharp. The middle of the latter stays where the vertex is.
void keep_closed_edges_sharp(const Topology& topology, const SchemeOptions& options, const Topology& refined,
                             Sharpness& result) {
  for (std::size_t e = 0; e < topology.edge_count(); ++e) {
    if (!topology.ends_fans(EdgeId(e))) continue;
    const HalfEdge h = topology.half_of(EdgeId(e));
    for (const HalfEdge half : halves_of(topology, rules_of(options.scheme).corners, h)) {
      const EdgeId own = refined.edge_of(half);
      if (refined.ends_fans(own)) continue;
      if (result.edges.empty()) result.edges.assign(refined.edge_count(), 0.0);
      result.edges[own.index()] = infinite_sharpness;
    }
    if (topology.from(h) != topology.to(h)) continue;
    if (result.vertices.empty()) result.vertices.assign(refined.vertex_count(), 0.0);
    result.vertices[topology.vertex_count() + e] = infinite_sharpness;
  }
}

Sharpness sharpness_left(const Topology& topology, const SchemeOptions& options, const Sharpness& sharpness,
                         const Topology& refined) {
  Sharpness result;
  const auto set_edge = [&](HalfEdge h, double s) {
    if (s == 0) return;
    if (result.edges.empty()) result.edges.assign(refined.edge_count(), 0.0);
    result.edges[refined.edge_of(h).index()] = s;
  };
  Star star;
  for (std::size_t e = 0; e < sharpness.edges.size(); ++e) {
    if (sharpness.edges[e] == 0 || topology.ends_fans(EdgeId(e))) continue;
    const HalfEdge h = topology.half_of(EdgeId(e));
    const std::array<HalfEdge, 2> halves = halves_of(topology, rules_of(options.scheme).corners, h);
    for (std::size_t end = 0; end < 2; ++end) {
      double s = decayed(sharpness.edges[e]);
      if (options.creases == CreaseMethod::chaikin) {
        gather_star(topology, sharpness, end == 0 ? topology.from(h) : topology.to(h), options.boundary,
                    star);
        for (const Spoke& spoke : star.spokes) {
          if (spoke.edge == EdgeId(e)) s = decayed(star, spoke, options.creases);
        }
      }
      set_edge(halves[end], s);
    }
  }
  result.vertices_complete = sharpness.vertices_complete || !topology.is_manifold();
  const bool derived = result.vertices_complete && !sharpness.vertices_complete;
  for (std::size_t v = 0; v < (derived ? topology.vertex_count() : sharpness.vertices.size()); ++v) {
    const double s = decayed(derived ? vertex_sharpness(topology, sharpness, VertexId(v), options.boundary)
                                     : sharpness.vertices[v]);
    if (s == 0) continue;
    if (result.vertices.empty()) result.vertices.assign(refined.vertex_count(), 0.0);
    result.vertices[v] = s;
  }
  if (!topology.is_manifold()) keep_closed_edges_sharp(topology, options, refined, result);
  return result;
}

}  // namespace

RefinedTopology CreasedRules::refine(const Topology& topology, const SchemeOptions& options,
                                     const Sharpness& sharpness, const WorkMonitor& monitor) const {
  const std::size_t vertices = topology.vertex_count(), edges = topology.edge_count();
  RefinedTopology result;
  result.stencils.reserve(vertices + edges, 7 * vertices + 4 * edges);
  Rows rows(*this, topology, options, sharpness);
  for (std::size_t v = 0; v < vertices; ++v) {
    monitor.checkpoint();
    rows.add_vertex(VertexId(v), result.stencils);
  }
  for (std::size_t e = 0; e < edges; ++e) {
    monitor.checkpoint();
    rows.add_edge(EdgeId(e), result.stencils);
  }
  RowBuilder row;
  for (std::size_t f = 0; f < topology.face_count() && !triangular(); ++f) {
    monitor.checkpoint();
    add_mean(topology.face(FaceId(f)), Interval(1), row);
    row.end_row(result.stencils);
  }
  result.topology = split_faces(topology, corners);
  monitor.checkpoint();
  result.sharpness = sharpness_left(topology, options, sharpness, result.topology);
  return result;
}

Topology CreasedRules::ring(std::span<const CornerFan> fans) const {
  return ring_of_face(fans.first(corners));
}

}  // namespace snug
