#include <snug/scheme/refine.h>

#include <array>
#include <utility>

#include <snug/scheme/rules.h>
#include <support/compact_numbering.h>

namespace snug {
namespace {

Topology split_triangles(const Topology& topology) {
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

Topology split_to_quads(const Topology& topology) {
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

}  // namespace

Topology split_faces(const Topology& topology, std::size_t corners) {
  return corners == 3 ? split_triangles(topology) : split_to_quads(topology);
}

std::array<HalfEdge, 2> halves_of(const Topology& topology, std::size_t corners, HalfEdge h) {
  const HalfEdge next = topology.next(h);
  if (corners == 3) {
    const HalfEdge base = topology.first_of(topology.face_of(h)), k = h - base, l = next - base;
    return {4 * base + 4 * k, 4 * base + 3 * l + k};
  }
  const auto place = [&](HalfEdge g, std::size_t step) {
    return static_cast<HalfEdge>(4 * g + (place_in_quarter(topology, g) + step) % 4);
  };
  return {place(h, 0), place(next, 3)};
}

namespace {

// Tags of a refined mesh: what is left of the old ones.
MeshTags refined_tags(const ControlMesh& mesh, const SchemeOptions& options, const Topology& topology,
                      const RefinedTopology& refined) {
  const SchemeRules& rules = rules_of(options.scheme);
  MeshTags tags;
  tags.scheme = mesh.tags.scheme;
  tags.boundary = mesh.tags.boundary;
  tags.crease_method = mesh.tags.crease_method;
  if (rules.triangular()) tags.smooth_triangles = mesh.tags.smooth_triangles;
  if (!rules.primal) return tags;
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
    if (rules.triangular()) {
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
  return rules_of(options.scheme).refine({topology, options, sharpness}, monitor);
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

void vertices_of(const Topology& topology, std::span<const HalfEdge> firsts, std::vector<VertexId>& names,
                 std::vector<VertexId>* corners) {
  thread_local CompactNumbering met;
  met.begin(topology.vertex_count());
  names.clear();
  for (const HalfEdge first : firsts) {
    HalfEdge h = first;
    do {
      const VertexId v = topology.from(h), own(met.number(v.index()));
      if (own.index() == names.size()) names.push_back(v);
      if (corners) corners->push_back(own);
      h = topology.next(h);
    } while (h != first);
  }
}

PartOfMesh part_of(const Topology& topology, const Sharpness& sharpness, BoundaryRule boundary,
                   std::span<const HalfEdge> firsts) {
  PartOfMesh part;
  std::vector<std::uint32_t> offsets{0};
  std::vector<VertexId> corners;
  vertices_of(topology, firsts, part.names, &corners);
  for (const HalfEdge first : firsts) {
    const FaceId f = topology.face_of(first);
    part.faces.push_back(f);
    offsets.push_back(offsets.back() + static_cast<std::uint32_t>(topology.face(f).size()));
  }
  part.topology = Topology(std::move(offsets), std::move(corners), part.names.size());

  for (std::size_t i = 0; i < part.names.size(); ++i) {
    set_sharpness(part.sharpness.vertices, part.names.size(), i,
                  vertex_sharpness(topology, sharpness, part.names[i], boundary));
  }
  part.sharpness.vertices_complete = true;
  HalfEdge own = 0;
  for (const HalfEdge first : firsts) {
    HalfEdge h = first;
    do {
      set_sharpness(part.sharpness.edges, part.topology.edge_count(), part.topology.edge_of(own).index(),
                    edge_sharpness(topology, sharpness, topology.edge_of(h)));
      h = topology.next(h);
      ++own;
    } while (h != first);
  }
  return part;
}

Stencils limit_stencils(const Topology& topology, const SchemeOptions& options, const Sharpness& sharpness,
                        const WorkMonitor& monitor) {
  const SchemeRules& rules = rules_of(options.scheme);
  Stencils out;
  out.reserve(topology.vertex_count(), 7 * topology.vertex_count());
  for (std::size_t v = 0; v < topology.vertex_count(); ++v) {
    monitor.checkpoint();
    if (topology.isolated(VertexId(v))) {
      out.add_unit_row(static_cast<std::uint32_t>(v));
    } else {
      rules.add_limit_row({topology, options, sharpness}, VertexId(v), out);
    }
  }
  return out;
}

}  // namespace snug
