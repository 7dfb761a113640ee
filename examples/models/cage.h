#pragma once
// Box modelling: a cage of quads grown by extrusion, one half of a figure that is symmetric in x = 0.

#include <array>
#include <span>
#include <vector>

#include "triangle_mesh.h"

namespace models {

class Cage {
 public:
  Index add_point(const Vec3& p);
  std::size_t add_quad(const Quad& quad);

  /// Pulls a face to the rectangle `centre` +- `u` +- `v`, where cross(u, v) points outward.
  /// Returns the four sides; a side that would lie in x = 0 is left out and repeats the face's own number.
  std::array<std::size_t, 4> extrude(std::size_t face, const Vec3& centre, const Vec3& u, const Vec3& v);

  /// The face among `choices` that looks most towards `direction`.
  std::size_t towards(std::span<const std::size_t> choices, const Vec3& direction) const;

  TriangleMesh triangles() const;

 private:
  Vec3 normal(std::size_t face) const;

  std::vector<Vec3> points_;
  std::vector<Quad> quads_;
};

}  // namespace models
