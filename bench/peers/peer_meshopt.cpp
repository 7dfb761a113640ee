#include "peer_meshopt.h"

#include <meshoptimizer.h>

namespace snug::bench {

TriangleMesh meshopt_simplified(const TriangleMesh& mesh, double error) {
  std::vector<float> positions;
  positions.reserve(3 * mesh.points.size());
  for (const Point3& p : mesh.points) {
    for (std::size_t k = 0; k < 3; ++k) positions.push_back(static_cast<float>(p[k]));
  }
  std::vector<unsigned int> indices;
  indices.reserve(3 * mesh.triangles.size());
  for (const auto& t : mesh.triangles) indices.insert(indices.end(), t.begin(), t.end());
  std::vector<unsigned int> simple(indices.size());
  simple.resize(meshopt_simplify(simple.data(), indices.data(), indices.size(), positions.data(),
                                 mesh.points.size(), 3 * sizeof(float), 0, static_cast<float>(error), 0,
                                 nullptr));
  // Points keep their doubles: simplification picks vertices, it moves none.
  TriangleMesh result;
  constexpr std::uint32_t unused = 0xffffffffu;
  std::vector<std::uint32_t> place(mesh.points.size(), unused);
  for (std::size_t i = 0; i < simple.size(); i += 3) {
    auto& triangle = result.triangles.emplace_back();
    for (std::size_t k = 0; k < 3; ++k) {
      std::uint32_t& at = place[simple[i + k]];
      if (at == unused) {
        at = static_cast<std::uint32_t>(result.points.size());
        result.points.push_back(mesh.points[simple[i + k]]);
      }
      triangle[k] = at;
    }
  }
  return result;
}

}  // namespace snug::bench
