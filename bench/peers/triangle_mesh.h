#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include <support/point.h>

namespace snug::bench {

/// Input of the peers: triangles as indices of points.
struct TriangleMesh {
  std::vector<Point3> points;
  std::vector<std::array<std::uint32_t, 3>> triangles;
};

}  // namespace snug::bench
