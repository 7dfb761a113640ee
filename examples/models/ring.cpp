#include "models.h"

namespace models {

// A trefoil knot: a tube of five sides along the (2, 3) curve of a torus, framed by the torus's own normal.
TriangleMesh make_ring() {
  constexpr Index stations = 22, sides = 5;
  constexpr double large = 2.0, small = 0.95, tube = 0.62;
  const auto centre = [&](double t) {
    const auto [c2, s2] = cos_sin(2 * t);
    const auto [c3, s3] = cos_sin(3 * t);
    return Vec3{(large + small * c3) * c2, (large + small * c3) * s2, 1.15 * small * s3};
  };
  TriangleMesh mesh;
  for (Index i = 0; i < stations; ++i) {
    const double t = static_cast<double>(i) / stations;
    const auto [c2, s2] = cos_sin(2 * t);
    const auto [c3, s3] = cos_sin(3 * t);
    const Vec3 along = unit(centre(t + 1e-3) - centre(t - 1e-3));
    const Vec3 rough = {c3 * c2, c3 * s2, s3};
    const Vec3 side = unit(cross(along, rough));
    const Vec3 out = cross(side, along);
    for (Index k = 0; k < sides; ++k) {
      const auto [c, s] = cos_sin((k + 0.5 * (i % 2)) / sides);
      mesh.points.push_back(centre(t) + (tube * c) * out + (tube * s) * side);
    }
  }
  std::vector<Quad> quads;
  for (Index i = 0; i < stations; ++i) {
    const Index next = (i + 1) % stations;
    const Index shift = i % 2;  // odd stations are half a side ahead
    for (Index k = 0; k < sides; ++k) {
      const Index k2 = (k + shift) % sides;
      const Index k1 = (k + 1) % sides, k3 = (k2 + 1) % sides;
      quads.push_back({i * sides + k, i * sides + k1, next * sides + k3, next * sides + k2});
    }
  }
  mesh.faces = triangulate(mesh.points, quads);
  orient_outward(mesh);
  scatter_flips(mesh, 5, 7);
  return mesh;
}

}  // namespace models
