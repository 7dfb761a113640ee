#include "models.h"

namespace models {

// A cube whose six faces are drawn out into spikes: 8 corners of valence 6, 6 tips of valence 4.
TriangleMesh make_star() {
  TriangleMesh mesh;
  for (int corner = 0; corner < 8; ++corner) {
    mesh.points.push_back({corner & 1 ? 0.3 : -0.3, corner & 2 ? 0.3 : -0.3, corner & 4 ? 0.3 : -0.3});
  }
  constexpr std::array<Quad, 6> sides = {
      {{0, 4, 6, 2}, {1, 3, 7, 5}, {0, 1, 5, 4}, {2, 6, 7, 3}, {0, 2, 3, 1}, {4, 5, 7, 6}}};
  constexpr double reach = 2.4;
  for (std::size_t side = 0; side < 6; ++side) {
    Vec3 tip;
    tip[side / 2] = side % 2 == 0 ? -reach : reach;
    const auto v = static_cast<Index>(mesh.points.size());
    mesh.points.push_back(tip);
    for (std::size_t k = 0; k < 4; ++k) mesh.faces.push_back({sides[side][k], sides[side][(k + 1) % 4], v});
  }
  return mesh;
}

}  // namespace models
