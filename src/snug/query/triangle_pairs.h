#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include <snug/surface/limit_surface.h>

namespace snug {

/// Two triangles as a square, cut along its diagonal, or one of them as the lower half. Corners of the halves are those of SquareHalf;
/// corner k is corner (k + turn) mod 3 of the patch.
struct PairedTriangles {
  PatchId lower;
  std::uint8_t turn = 0;
  std::optional<PatchId> upper{};
  std::uint8_t upper_turn = 0;
};

/// All triangles of a surface with a limit patch, most of them in pairs. Pairs are smooth along their diagonal, and their corners
/// are less than half a turn. Where the mesh is regular, diagonals are parallel. Of facets each by itself.
/// Requires:  a triangular scheme.
/// Cost:      linear; 0.1 to 0.3 microseconds a triangle.
[[nodiscard]] std::vector<PairedTriangles> paired(const LimitSurface& surface);

}  // namespace snug
