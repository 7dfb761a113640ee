#include <vector>

#include "models.h"

namespace models {

namespace {

struct Ring {
  double radius, height;
  Index count;
  double phase;  ///< in turns
};

struct Placed {
  Index first, count;
  double phase;
};

double angle(const Placed& ring, Index k) { return ring.phase + static_cast<double>(k) / ring.count; }

/// Band of triangles between two rings of possibly different counts: always advances on the ring that lags behind.
void zip(TriangleMesh& mesh, const Placed& low, const Placed& high) {
  Index i = 0, j = 0;
  while (i < low.count || j < high.count) {
    const Index a = low.first + i % low.count;
    const Index b = high.first + j % high.count;
    const bool step_low = j == high.count || (i < low.count && angle(low, i + 1) <= angle(high, j + 1));
    if (step_low) {
      mesh.faces.push_back({a, b, low.first + (i + 1) % low.count});
      ++i;
    } else {
      mesh.faces.push_back({a, b, high.first + (j + 1) % high.count});
      ++j;
    }
  }
}

}  // namespace

// Turned on a lathe: eleven columns at the foot, seven in the stem, eight in the knob, a pole of valence 8 below and of 7 on top.
TriangleMesh make_pawn() {
  const std::vector<Ring> rings = {
      {0.62, 0.00, 8, 0.000},  {1.06, 0.00, 11, 0.020}, {1.12, 0.30, 11, 0.065}, {0.86, 0.48, 11, 0.020},
      {0.88, 0.66, 10, 0.065}, {0.55, 0.92, 9, 0.015},  {0.38, 1.45, 7, 0.070},  {0.30, 2.05, 7, 0.000},
      {0.36, 2.26, 8, 0.060},  {0.68, 2.34, 9, 0.000},  {0.66, 2.50, 9, 0.055},  {0.32, 2.60, 8, 0.000},
      {0.52, 2.84, 8, 0.062},  {0.60, 3.16, 8, 0.000},  {0.42, 3.48, 7, 0.060},
  };
  TriangleMesh mesh;
  std::vector<Placed> placed;
  for (const Ring& ring : rings) {
    placed.push_back({static_cast<Index>(mesh.points.size()), ring.count, ring.phase});
    for (Index k = 0; k < ring.count; ++k) {
      const auto [c, s] = cos_sin(angle(placed.back(), k));
      mesh.points.push_back({ring.radius * c, ring.height, ring.radius * s});
    }
  }
  for (std::size_t r = 0; r + 1 < placed.size(); ++r) zip(mesh, placed[r], placed[r + 1]);
  const auto bottom = static_cast<Index>(mesh.points.size());
  mesh.points.push_back({0, 0.08, 0});
  const auto top = static_cast<Index>(mesh.points.size());
  mesh.points.push_back({0, 3.66, 0});
  for (Index k = 0; k < placed.front().count; ++k) {
    mesh.faces.push_back(
        {bottom, placed.front().first + k, placed.front().first + (k + 1) % placed.front().count});
  }
  for (Index k = 0; k < placed.back().count; ++k) {
    mesh.faces.push_back({top, placed.back().first + (k + 1) % placed.back().count, placed.back().first + k});
  }
  orient_outward(mesh);
  return mesh;
}

}  // namespace models
