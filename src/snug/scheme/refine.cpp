#include <snug/scheme/refine.h>

#include <algorithm>
#include <utility>

#include <snug/scheme/catmark_masks.h>
#include <snug/scheme/dual_masks.h>
#include <snug/scheme/loop_masks.h>
#include <snug/scheme/row_builder.h>

namespace snug {
namespace {

// The rows of a primal scheme.
class PrimalRows {
 public:
  PrimalRows(const Topology& topology, const SchemeOptions& options, const Sharpness& sharpness)
      : topology_(topology), options_(options), sharpness_(sharpness) {}

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
    if (!crease) add_smooth_edge(h, s > 0 ? Interval(1) - share : Interval(1));
    row_.end_row(out);
  }

  void add_centre(FaceId f, Stencils& out) {
    add_face(f, Interval(1));
    row_.end_row(out);
  }

 private:
  // Rows of regular parts are free of rounding: no interval arithmetic touches their weights.
  static Interval times(const Interval& factor, const Interval& weight) {
    return factor == Interval(1) ? weight : factor * weight;
  }

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
        options_.scheme == Scheme::loop ? add_loop_vertex(v, share) : add_catmark_vertex(v, share);
        return;
    }
  }

  void add_loop_vertex(VertexId v, const Interval& share) {
    const loop::RingMask mask = loop::vertex_mask(star_.spokes.size());
    row_.add(v.value(), times(share, mask.centre));
    for (const Spoke& spoke : star_.spokes) row_.add(spoke.end.value(), times(share, mask.each));
  }

  void add_catmark_vertex(VertexId v, const Interval& share) {
    const std::size_t n = star_.faces.size();
    if (std::all_of(star_.faces.begin(), star_.faces.end(), [&](HalfEdge h) { return is_quad(h); })) {
      const catmark::StarMask mask = catmark::vertex_mask(n);
      row_.add(v.value(), times(share, mask.centre));
      for (const Spoke& spoke : star_.spokes) row_.add(spoke.end.value(), times(share, mask.edge));
      for (const HalfEdge h : star_.faces) {
        row_.add(topology_.to(topology_.next(h)).value(), times(share, mask.diagonal));
      }
      return;
    }
    const catmark::CentreMask mask = catmark::vertex_centre_mask(n);
    row_.add(v.value(), share * mask.centre);
    for (const Spoke& spoke : star_.spokes) row_.add(spoke.end.value(), share * mask.edge);
    for (const HalfEdge h : star_.faces) add_face(topology_.face_of(h), share * mask.face);
  }

  [[nodiscard]] bool is_quad(HalfEdge h) const { return topology_.face(topology_.face_of(h)).size() == 4; }

  void add_face(FaceId f, const Interval& share) {
    const auto corners = topology_.face(f);
    const std::size_t n = corners.size();
    const Interval each =
        share == Interval(1) && n == 4 ? Interval(0.25) : share / Interval(static_cast<double>(n));
    for (const VertexId c : corners) row_.add(c.value(), each);
  }

  // h lies inside: it has a twin.
  void add_smooth_edge(HalfEdge h, const Interval& share) {
    const HalfEdge twin = topology_.twin(h);
    const VertexId a = topology_.from(h), b = topology_.to(h);
    if (options_.scheme == Scheme::loop) {
      for (const VertexId end : {a, b}) row_.add(end.value(), times(share, loop::edge_end));
      for (const HalfEdge g : {h, twin}) {
        row_.add(topology_.from(topology_.prev(g)).value(), times(share, loop::edge_wing));
      }
      return;
    }
    if (is_quad(h) && is_quad(twin)) {
      for (const VertexId end : {a, b}) row_.add(end.value(), times(share, catmark::edge_end));
      for (const HalfEdge g : {h, twin}) {
        row_.add(topology_.from(topology_.prev(g)).value(), times(share, catmark::edge_wing));
        row_.add(topology_.to(topology_.next(g)).value(), times(share, catmark::edge_wing));
      }
      return;
    }
    Interval face = catmark::edge_face;  // both faces' weight
    if (options_.triangles == SmoothTriangles::smooth) {
      const auto weight = [&](HalfEdge g) {
        return topology_.face(topology_.face_of(g)).size() == 3 ? catmark::smooth_triangle_face()
                                                                : Interval(catmark::edge_face);
      };
      face = Interval(0.5) * (weight(h) + weight(twin));
    }
    const Interval end = Interval(0.5) * (Interval(1) - Interval(2) * face);
    row_.add(a.value(), share * end);
    row_.add(b.value(), share * end);
    for (const HalfEdge g : {h, twin}) add_face(topology_.face_of(g), share * face);
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

  const Topology& topology_;
  const SchemeOptions& options_;
  const Sharpness& sharpness_;
  Star star_;
  std::vector<Spoke> next_;
  RowBuilder row_;
};

Topology loop_faces(const Topology& topology) {
  const std::size_t vertices = topology.vertex_count();
  std::vector<std::uint32_t> offsets(4 * topology.face_count() + 1);
  for (std::size_t f = 0; f < offsets.size(); ++f) offsets[f] = static_cast<std::uint32_t>(3 * f);
  std::vector<VertexId> corners;
  corners.reserve(12 * topology.face_count());
  for (std::size_t f = 0; f < topology.face_count(); ++f) {
    const HalfEdge h = topology.first_of(FaceId(f));
    const auto c = topology.face(FaceId(f));
    const auto middle = [&](HalfEdge g) { return VertexId(vertices + topology.edge_of(g).index()); };
    const VertexId m01 = middle(h), m12 = middle(h + 1), m20 = middle(h + 2);
    corners.insert(corners.end(), {c[0], m01, m20, m01, c[1], m12, m20, m12, c[2], m12, m20, m01});
  }
  return Topology(std::move(offsets), std::move(corners), vertices + topology.edge_count());
}

// Where corner h of a quad stands in its quarter: in its own place; elsewhere first.
std::size_t place_in_quarter(const Topology& topology, HalfEdge h) {
  const FaceId f = topology.face_of(h);
  return topology.face(f).size() == 4 ? h - topology.first_of(f) : 0;
}

Topology catmark_faces(const Topology& topology) {
  const std::size_t vertices = topology.vertex_count(), edges = topology.edge_count();
  std::vector<std::uint32_t> offsets(topology.half_edge_count() + 1);
  for (std::size_t f = 0; f < offsets.size(); ++f) offsets[f] = static_cast<std::uint32_t>(4 * f);
  std::vector<VertexId> corners(4 * topology.half_edge_count());
  for (HalfEdge h = 0; h < topology.half_edge_count(); ++h) {
    const auto middle = [&](HalfEdge g) { return VertexId(vertices + topology.edge_of(g).index()); };
    const std::size_t place = place_in_quarter(topology, h);
    const std::array<VertexId, 4> around{topology.from(h), middle(h),
                                         VertexId(vertices + edges + topology.face_of(h).index()),
                                         middle(topology.prev(h))};
    for (std::size_t k = 0; k < 4; ++k) corners[4 * h + (place + k) % 4] = around[k];
  }
  return Topology(std::move(offsets), std::move(corners), vertices + edges + topology.face_count());
}

// Half-edges of the refined mesh on the halves of h: from h's first vertex to the middle, from there to the second.
std::array<HalfEdge, 2> halves_of(const Topology& topology, Scheme scheme, HalfEdge h) {
  const FaceId f = topology.face_of(h);
  const HalfEdge base = topology.first_of(f), next = topology.next(h);
  if (scheme == Scheme::loop) {
    const HalfEdge k = h - base, l = next - base, first = 3 * (4 * f.value());
    return {first + 3 * k + k, first + 3 * l + k};
  }
  const auto place = [&](HalfEdge g, std::size_t step) {
    return static_cast<HalfEdge>(4 * g + (place_in_quarter(topology, g) + step) % 4);
  };
  return {place(h, 0), place(next, 3)};
}

// Where a face runs along an edge twice, or along one from a vertex to itself, pieces of what ended the fans may be twins
// after a step: they are kept infinitely sharp. The middle of the latter stays where the vertex is.
void keep_closed_edges_sharp(const Topology& topology, const SchemeOptions& options, const Topology& refined,
                             Sharpness& result) {
  for (std::size_t e = 0; e < topology.edge_count(); ++e) {
    if (!topology.ends_fans(EdgeId(e))) continue;
    const HalfEdge h = topology.half_of(EdgeId(e));
    for (const HalfEdge half : halves_of(topology, options.scheme, h)) {
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
    const std::array<HalfEdge, 2> halves = halves_of(topology, options.scheme, h);
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

RefinedTopology refine_primal(const Topology& topology, const SchemeOptions& options,
                              const Sharpness& sharpness, const WorkMonitor& monitor) {
  const std::size_t vertices = topology.vertex_count(), edges = topology.edge_count();
  RefinedTopology result;
  result.stencils.reserve(vertices + edges, 7 * vertices + 4 * edges);
  PrimalRows rows(topology, options, sharpness);
  for (std::size_t v = 0; v < vertices; ++v) {
    monitor.checkpoint();
    rows.add_vertex(VertexId(v), result.stencils);
  }
  for (std::size_t e = 0; e < edges; ++e) {
    monitor.checkpoint();
    rows.add_edge(EdgeId(e), result.stencils);
  }
  if (options.scheme == Scheme::loop) {
    result.topology = loop_faces(topology);
  } else {
    for (std::size_t f = 0; f < topology.face_count(); ++f) {
      monitor.checkpoint();
      rows.add_centre(FaceId(f), result.stencils);
    }
    result.topology = catmark_faces(topology);
  }
  monitor.checkpoint();
  result.sharpness = sharpness_left(topology, options, sharpness, result.topology);
  return result;
}

RefinedTopology refine_dual(const Topology& topology, Scheme scheme, const WorkMonitor& monitor) {
  RefinedTopology result;
  std::vector<std::uint32_t> offsets{0};
  std::vector<VertexId> corners;
  const auto end_face = [&] { offsets.push_back(static_cast<std::uint32_t>(corners.size())); };
  for (std::size_t f = 0; f < topology.face_count(); ++f) {
    monitor.checkpoint();
    const auto face = topology.face(FaceId(f));
    const std::size_t n = face.size();
    const std::vector<Interval> mask =
        scheme == Scheme::doo_sabin ? dual::doo_sabin_mask(n) : dual::midedge_mask(n);
    for (std::size_t k = 0; k < n; ++k) {
      for (std::size_t i = 0; i < n; ++i) {
        if (mask[i] != Interval(0)) result.stencils.add(face[(k + i) % n].value(), mask[i]);
      }
      result.stencils.end_row();
      corners.emplace_back(topology.first_of(FaceId(f)) + k);
    }
    end_face();
  }
  for (std::size_t e = 0; e < topology.edge_count(); ++e) {
    monitor.checkpoint();
    const HalfEdge h = topology.half_of(EdgeId(e)), g = topology.twin(h);
    if (g == no_half_edge) continue;
    for (const HalfEdge corner : {topology.next(h), h, topology.next(g), g}) corners.emplace_back(corner);
    end_face();
  }
  for (std::size_t v = 0; v < topology.vertex_count(); ++v) {
    if (topology.isolated(VertexId(v)) || topology.on_boundary(VertexId(v))) continue;
    topology.walk_fan(topology.leaving(VertexId(v)), [&](HalfEdge h) { corners.emplace_back(h); });
    end_face();
  }
  result.topology = Topology(std::move(offsets), std::move(corners), topology.half_edge_count());
  return result;
}

// Tags of a refined mesh: what is left of the old ones.
MeshTags refined_tags(const ControlMesh& mesh, const SchemeOptions& options, const Topology& topology,
                      const RefinedTopology& refined) {
  MeshTags tags;
  tags.boundary = mesh.tags.boundary;
  tags.crease_method = mesh.tags.crease_method;
  if (options.scheme == Scheme::loop) tags.smooth_triangles = mesh.tags.smooth_triangles;
  if (!is_primal(options.scheme)) return tags;
  for (std::size_t e = 0; e < refined.sharpness.edges.size(); ++e) {
    if (refined.sharpness.edges[e] == 0) continue;
    const HalfEdge h = refined.topology.half_of(EdgeId(e));
    tags.creases.push_back({refined.topology.from(h), refined.topology.to(h), refined.sharpness.edges[e]});
  }
  for (std::size_t v = 0; v < refined.sharpness.vertices.size(); ++v) {
    if (refined.sharpness.vertices[v] > 0)
      tags.corners.push_back({VertexId(v), refined.sharpness.vertices[v]});
  }
  for (const FaceId hole : mesh.tags.holes) {
    if (options.scheme == Scheme::loop) {
      for (std::size_t k = 0; k < 4; ++k) tags.holes.emplace_back(4 * hole.index() + k);
    } else {
      const HalfEdge first = topology.first_of(hole);
      for (std::size_t k = 0; k < topology.face(hole).size(); ++k) tags.holes.emplace_back(first + k);
    }
  }
  return tags;
}

}  // namespace

RefinedTopology refine(const Topology& topology, const SchemeOptions& options, const Sharpness& sharpness,
                       const WorkMonitor& monitor) {
  return is_primal(options.scheme) ? refine_primal(topology, options, sharpness, monitor)
                                   : refine_dual(topology, options.scheme, monitor);
}

ControlMesh refine(const ControlMesh& mesh, const SchemeOptions& options) {
  const Topology topology(mesh);
  return refined_mesh(mesh, options, topology, refine(topology, options, sharpness_of(mesh, topology)));
}

ControlMesh refined_mesh(const ControlMesh& mesh, const SchemeOptions& options, const Topology& topology,
                         const RefinedTopology& refined, const WorkMonitor& monitor) {
  ControlMesh result;
  result.points.reserve(refined.stencils.row_count());
  for (std::size_t r = 0; r < refined.stencils.row_count(); ++r) {
    monitor.checkpoint();
    result.points.push_back(refined.stencils.apply<Point3>(r, mesh.points));
  }
  for (std::size_t f = 0; f < refined.topology.face_count(); ++f) {
    monitor.checkpoint();
    result.add_face(refined.topology.face(FaceId(f)));
  }
  result.tags = refined_tags(mesh, options, topology, refined);
  return result;
}

}  // namespace snug
