#include <snug/mesh/topology.h>

#include <utility>

#include <snug/base/contract.h>

namespace snug {

Topology::Topology(const ControlMesh& mesh)
    : face_offsets_(mesh.face_offsets), face_vertices_(mesh.face_vertices) {
  connect(mesh.vertex_count());
}

Topology::Topology(std::vector<std::uint32_t> face_offsets, std::vector<VertexId> face_vertices,
                   std::size_t vertex_count)
    : face_offsets_(std::move(face_offsets)), face_vertices_(std::move(face_vertices)) {
  connect(vertex_count);
}

void Topology::connect(std::size_t vertex_count) {
  HalfEdgeGroups groups(face_offsets_, face_vertices_, vertex_count);
  twins_.assign(face_vertices_.size(), no_half_edge);
  edges_.resize(face_vertices_.size());
  edge_half_.resize(groups.edge_count());
  for (std::size_t e = 0; e < groups.edge_count(); ++e) {
    const auto members = groups.of_edge(EdgeId(e));
    SNUG_EXPECT(members.size() <= 2);
    edge_half_[e] = members[0];
    for (const HalfEdge h : members) edges_[h] = EdgeId(e);
    if (members.size() == 2) {
      SNUG_EXPECT(face_vertices_[members[0]] != face_vertices_[members[1]]);
      twins_[members[0]] = members[1];
      twins_[members[1]] = members[0];
    }
  }
  faces_ = groups.take_faces();

  leaving_.assign(vertex_count, no_half_edge);
  for (HalfEdge h = 0; h < face_vertices_.size(); ++h) {
    HalfEdge& best = leaving_[face_vertices_[h].index()];
    if (best == no_half_edge || twins_[h] == no_half_edge) best = h;
  }
}

std::size_t Topology::face_valence(VertexId v) const {
  const HalfEdge start = leaving(v);
  if (start == no_half_edge) return 0;
  std::size_t count = 0;
  HalfEdge h = start;
  do {
    ++count;
    h = ccw(h);
  } while (h != no_half_edge && h != start);
  return count;
}

}  // namespace snug
