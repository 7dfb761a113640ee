#include <snug/scheme/creases.h>

#include <algorithm>
#include <numeric>
#include <set>
#include <utility>

namespace snug {
namespace {

// The edge between two vertices, if there is one.
EdgeId edge_between(const Topology& topology, VertexId a, VertexId b) {
  EdgeId found;
  walk_edges(topology, a, [&](EdgeId e, VertexId end) {
    if (end == b) found = e;
  });
  return found;
}

bool is_topological_corner(const Topology& topology, VertexId v) {
  const HalfEdge h = topology.leaving(v);
  return topology.on_boundary(topology.edge_of(h)) &&
         topology.on_boundary(topology.edge_of(topology.prev(h))) && topology.more_fans(v).empty();
}

// Does a crease of non-manifold edges run through the vertex?
bool on_non_manifold_curve(const Topology& topology, VertexId v) {
  std::set<EdgeId> edges;
  std::size_t sides = 0;  // of edges, two a face
  walk_edges(topology, v, [&](EdgeId e, VertexId) {
    edges.insert(e);
    ++sides;
  });
  const auto odd =
      std::count_if(edges.begin(), edges.end(), [&](EdgeId e) { return !topology.is_manifold(e); });
  const bool boundary =
      std::any_of(edges.begin(), edges.end(), [&](EdgeId e) { return topology.on_boundary(e); });
  return odd == 2 && !boundary && sides > 2 * edges.size();
}

}  // namespace

void set_sharpness(std::vector<double>& entries, std::size_t count, std::size_t i, double sharpness) {
  if (sharpness == 0) return;
  if (entries.empty()) entries.assign(count, 0.0);
  entries[i] = sharpness;
}

Sharpness sharpness_of(const ControlMesh& mesh, const Topology& topology) {
  Sharpness result;
  for (const CreaseTag& tag : mesh.tags.creases) {
    const EdgeId e = edge_between(topology, tag.a, tag.b);
    if (!e.valid()) continue;
    if (result.edges.empty()) result.edges.assign(topology.edge_count(), 0.0);
    const bool counts = !topology.ends_fans(e) || tag.sharpness >= infinite_sharpness;
    result.edges[e.index()] = counts ? tag.sharpness : 0;
  }
  for (const CornerTag& tag : mesh.tags.corners) {
    if (result.vertices.empty()) result.vertices.assign(topology.vertex_count(), 0.0);
    result.vertices[tag.vertex.index()] = tag.sharpness;
  }
  const auto nothing = [](const std::vector<double>& all) {
    return std::all_of(all.begin(), all.end(), [](double s) { return s == 0; });
  };
  if (nothing(result.edges)) result.edges.clear();
  if (nothing(result.vertices)) result.vertices.clear();
  return result;
}

bool loses_surface(const Topology& topology, const Sharpness& sharpness, FaceId f) {
  bool open = false;
  for (const VertexId v : topology.face(f)) {
    walk_edges(topology, v, [&](EdgeId e, VertexId) {
      open = open || (topology.on_boundary(e) &&
                      (sharpness.edges.empty() || sharpness.edges[e.index()] < infinite_sharpness));
    });
  }
  return open;
}

double edge_sharpness(const Topology& topology, const Sharpness& sharpness, EdgeId e) {
  if (topology.ends_fans(e)) return infinite_sharpness;
  return sharpness.edges.empty() ? 0 : sharpness.edges[e.index()];
}

double vertex_sharpness(const Topology& topology, const Sharpness& sharpness, VertexId v,
                        BoundaryRule boundary) {
  if (topology.isolated(v)) return infinite_sharpness;
  const double own = sharpness.vertices.empty() ? 0 : sharpness.vertices[v.index()];
  if (sharpness.vertices_complete) return own;
  const bool corner = boundary == BoundaryRule::edge_and_corner && is_topological_corner(topology, v);
  const bool odd = !topology.is_manifold() && !topology.is_manifold(v) && !on_non_manifold_curve(topology, v);
  return corner || odd ? infinite_sharpness : own;
}

void gather_star(const RuledMesh& mesh, VertexId v, Star& out) {
  const Topology& topology = mesh.topology;
  out.spokes.clear();
  out.faces.clear();
  const auto add = [&](EdgeId e, VertexId end) {
    out.spokes.push_back({e, end, edge_sharpness(topology, mesh.sharpness, e)});
  };
  topology.for_each_fan(v, [&](HalfEdge start) {
    topology.walk_fan(start, [&](HalfEdge h) {
      out.faces.push_back(h);
      add(topology.edge_of(h), topology.to(h));
    });
    if (topology.twin(start) != no_half_edge) return;
    const HalfEdge in = topology.prev(out.faces.back());
    add(topology.edge_of(in), topology.from(in));
  });
  if (!topology.is_manifold()) {  // an edge may end several fans
    std::vector<Spoke> once;
    for (const Spoke& spoke : out.spokes) {
      const auto same = [&](const Spoke& other) { return other.edge == spoke.edge; };
      if (std::none_of(once.begin(), once.end(), same)) once.push_back(spoke);
    }
    out.spokes = std::move(once);
  }
  out.sharpness = vertex_sharpness(topology, mesh.sharpness, v, mesh.options.boundary);
}

VertexRule vertex_rule(double own, std::span<const Spoke> spokes) {
  if (own > 0) return VertexRule::corner;
  const auto sharp =
      std::count_if(spokes.begin(), spokes.end(), [](const Spoke& s) { return s.sharpness > 0; });
  return sharp > 2 ? VertexRule::corner : sharp == 2 ? VertexRule::crease : VertexRule::smooth;
}

double decayed(double sharpness) {
  return sharpness >= infinite_sharpness ? sharpness : std::max(0.0, sharpness - 1);
}

double decayed(const Star& star, const Spoke& spoke, CreaseMethod method) {
  if (method == CreaseMethod::uniform || !is_semi_sharp(spoke.sharpness)) return decayed(spoke.sharpness);
  std::vector<double> all;
  for (const Spoke& other : star.spokes) {
    if (is_semi_sharp(other.sharpness)) all.push_back(other.sharpness);
  }
  if (all.size() < 2) return decayed(spoke.sharpness);
  std::sort(all.begin(), all.end());
  const double sum = std::accumulate(all.begin(), all.end(), 0.0);
  const double others = (sum - spoke.sharpness) / static_cast<double>(all.size() - 1);
  return std::max(0.0, 0.75 * spoke.sharpness + 0.25 * others - 1);
}

void add_far_ends(const RuledMesh& mesh, VertexId v, std::vector<VertexId>& out) {
  if (mesh.options.creases == CreaseMethod::uniform || mesh.sharpness.edges.empty()) return;
  Star here, there;
  gather_star(mesh, v, here);
  for (const Spoke& spoke : here.spokes) {
    if (!is_semi_sharp(spoke.sharpness)) continue;
    gather_star(mesh, spoke.end, there);
    const auto another = [&](const Spoke& other) {
      return other.edge != spoke.edge && is_semi_sharp(other.sharpness);
    };
    if (std::any_of(there.spokes.begin(), there.spokes.end(), another)) out.push_back(spoke.end);
  }
}

bool is_stationary(const Star& star) {
  return !is_semi_sharp(star.sharpness) &&
         std::none_of(star.spokes.begin(), star.spokes.end(),
                      [](const Spoke& s) { return is_semi_sharp(s.sharpness); });
}

}  // namespace snug
