#include <snug/mesh/statistics.h>

#include <algorithm>
#include <numeric>
#include <vector>

#include <snug/mesh/half_edges.h>

namespace snug {
namespace {

// The mesh without faces that name vertices it does not have.
struct SoundFaces {
  std::vector<std::uint32_t> offsets{0};
  std::vector<VertexId> vertices;
};

SoundFaces sound_faces(const ControlMesh& mesh) {
  SoundFaces result;
  for (std::size_t f = 0; f < mesh.face_count(); ++f) {
    const auto face = mesh.face(FaceId(f));
    if (std::any_of(face.begin(), face.end(), [&](VertexId v) { return v.index() >= mesh.vertex_count(); }))
      continue;
    result.vertices.insert(result.vertices.end(), face.begin(), face.end());
    result.offsets.push_back(static_cast<std::uint32_t>(result.vertices.size()));
  }
  return result;
}

std::size_t count_components(const SoundFaces& faces, std::size_t vertex_count) {
  std::vector<std::uint32_t> parent(vertex_count);
  std::iota(parent.begin(), parent.end(), 0u);
  const auto root = [&](std::uint32_t v) {
    while (parent[v] != v) v = parent[v] = parent[parent[v]];
    return v;
  };
  std::vector<bool> used(vertex_count, false);
  for (std::size_t f = 0; f + 1 < faces.offsets.size(); ++f) {
    for (std::size_t i = faces.offsets[f]; i < faces.offsets[f + 1]; ++i) {
      used[faces.vertices[i].index()] = true;
      parent[root(faces.vertices[i].value())] = root(faces.vertices[faces.offsets[f]].value());
    }
  }
  std::size_t components = 0;
  for (std::uint32_t v = 0; v < vertex_count; ++v) components += used[v] && root(v) == v;
  return components;
}

}  // namespace

MeshStatistics statistics(const ControlMesh& mesh, std::size_t regular_valence) {
  const SoundFaces faces = sound_faces(mesh);
  const HalfEdgeGroups groups(faces.offsets, faces.vertices, mesh.vertex_count());
  MeshStatistics result;
  result.edges = groups.edge_count();
  result.components = count_components(faces, mesh.vertex_count());
  std::vector<std::uint32_t> valence(mesh.vertex_count(), 0);
  std::vector<bool> boundary(mesh.vertex_count(), false);
  result.closed = groups.edge_count() > 0;
  for (std::size_t e = 0; e < groups.edge_count(); ++e) {
    const auto members = groups.of_edge(EdgeId(e));
    const VertexId a = faces.vertices[members[0]];
    const VertexId b = faces.vertices[next_in_face(faces.offsets, groups.face(members[0]), members[0])];
    ++valence[a.index()];
    ++valence[b.index()];
    result.closed = result.closed && members.size() == 2;
    if (members.size() == 1) {
      ++result.boundary_edges;
      boundary[a.index()] = boundary[b.index()] = true;
    }
  }
  for (std::size_t v = 0; v < mesh.vertex_count(); ++v) {
    if (valence[v] == 0) continue;
    const std::size_t n = valence[v];
    result.min_valence = result.used_vertices++ == 0 ? n : std::min(result.min_valence, n);
    result.max_valence = std::max(result.max_valence, n);
    result.extraordinary += n != (boundary[v] ? regular_valence / 2 + 1 : regular_valence);
  }
  return result;
}

}  // namespace snug
