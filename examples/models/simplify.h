#pragma once
// Edge collapses on one half of a mirror-symmetric mesh.

#include <cstdint>
#include <vector>

#include "sculpt.h"

namespace models {

/// A half mesh and, for each vertex, the planes it must stay in.
struct HalfMesh {
  static constexpr std::uint8_t kMirror = 1;  ///< on x = 0
  static constexpr std::uint8_t kRim = 2;     ///< on the open floor

  TriangleMesh mesh;
  std::vector<std::uint8_t> planes;
};

/// Collapses edges, cheapest first, until half of options.faces are left or no collapse is legal.
/// Guarantee: stays a manifold whose mirror join is one too; each vertex keeps its planes.
HalfMesh simplify(const HalfMesh& half, const SculptOptions& options);

}  // namespace models
