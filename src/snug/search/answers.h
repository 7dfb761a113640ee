#pragma once

#include <array>
#include <cstdint>
#include <optional>

#include <snug/surface/evaluate.h>

namespace snug {

/// What a query did.
struct SearchStats {
  std::uint64_t box_tests = 0;       ///< of sets in trees
  std::uint64_t triangle_tests = 0;  ///< of base triangles
  std::uint64_t evaluations = 0;     ///< of limit points, pairs of them
  std::uint64_t splits = 0;          ///< of pieces, each time one is opened
};

/// Where two witnesses lie on their surfaces, of A and of B; nothing for one that is a point of the other surface alone.
using WitnessPlaces = std::array<std::optional<SurfaceParameter>, 2>;

}  // namespace snug
