#include <snug/scheme/limits.h>

#include <snug/base/compact_numbering.h>
#include <snug/scheme/rules.h>

namespace snug {

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
