#include "cage.h"

namespace models {

Index Cage::add_point(const Vec3& p) {
  points_.push_back(p);
  return static_cast<Index>(points_.size() - 1);
}

std::size_t Cage::add_quad(const Quad& quad) {
  quads_.push_back(quad);
  return quads_.size() - 1;
}

Vec3 Cage::normal(std::size_t face) const {
  const Quad& q = quads_[face];
  return unit(cross(points_[q[2]] - points_[q[0]], points_[q[3]] - points_[q[1]]));
}

std::array<std::size_t, 4> Cage::extrude(std::size_t face, const Vec3& centre, const Vec3& u, const Vec3& v) {
  const Quad old = quads_[face];
  const std::array<Vec3, 4> corners = {centre - u - v, centre + u - v, centre + u + v, centre - u + v};
  Vec3 middle;
  for (const Index w : old) middle = middle + 0.25 * points_[w];
  std::size_t turn = 0;
  double least = 0;
  for (std::size_t k = 0; k < 4; ++k) {  // the turn that twists least
    double sum = 0;
    for (std::size_t i = 0; i < 4; ++i) {
      sum += length_sq((corners[(i + k) % 4] - centre) - (points_[old[i]] - middle));
    }
    if (k == 0 || sum < least) {
      least = sum;
      turn = k;
    }
  }
  Quad fresh{};
  for (std::size_t i = 0; i < 4; ++i) fresh[i] = add_point(corners[(i + turn) % 4]);
  quads_[face] = fresh;
  std::array<std::size_t, 4> sides{face, face, face, face};
  for (std::size_t i = 0; i < 4; ++i) {
    const std::size_t j = (i + 1) % 4;
    if (points_[old[i]].x == 0 && points_[old[j]].x == 0) continue;
    sides[i] = add_quad({old[i], old[j], fresh[j], fresh[i]});
  }
  return sides;
}

std::size_t Cage::towards(std::span<const std::size_t> choices, const Vec3& direction) const {
  std::size_t best = choices.front();
  for (const std::size_t face : choices) {
    if (dot(normal(face), direction) > dot(normal(best), direction)) best = face;
  }
  return best;
}

TriangleMesh Cage::triangles() const { return {points_, triangulate(points_, quads_)}; }

}  // namespace models
