#include <snug/mesh/loose_creases.h>

#include <algorithm>
#include <utility>

namespace snug {

std::vector<std::size_t> loose_creases(const ControlMesh& mesh) {
  const std::vector<CreaseTag>& creases = mesh.tags.creases;
  if (creases.empty()) return {};
  using Edge = std::pair<VertexId, VertexId>;
  const auto edge_between = [](VertexId a, VertexId b) { return Edge(std::min(a, b), std::max(a, b)); };
  std::vector<Edge> edges;
  edges.reserve(mesh.face_vertices.size());
  for (std::size_t f = 0; f < mesh.face_count(); ++f) {
    const auto face = mesh.face(FaceId(f));
    for (std::size_t i = 0; i < face.size(); ++i) {
      edges.push_back(edge_between(face[i], face[i + 1 < face.size() ? i + 1 : 0]));
    }
  }
  std::sort(edges.begin(), edges.end());
  std::vector<std::size_t> loose;
  for (std::size_t i = 0; i < creases.size(); ++i) {
    if (!std::binary_search(edges.begin(), edges.end(), edge_between(creases[i].a, creases[i].b))) {
      loose.push_back(i);
    }
  }
  return loose;
}

}  // namespace snug
