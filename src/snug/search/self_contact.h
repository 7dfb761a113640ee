#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include <snug/run.h>
#include <support/point.h>

namespace snug {

/// Pairs of triangles of a mesh that are not proved to have no more in common than the vertices that both
/// name, the edge between two of these included; at most `most` of them, and 16 of a triangle with later ones.
///
/// Guarantee: without a pair the mesh does not touch itself, in exact arithmetic. Pairs are in the order of
///            triangles, the same for any number of threads.
/// Requires:  indices in range; coordinates of at most about 2.
/// Cost:      some microseconds a triangle.
/// Source:    derivations/hulls.md, "Meshes that do not touch themselves".
[[nodiscard]] std::vector<std::pair<std::uint32_t, std::uint32_t>> self_contacts(
    std::span<const Point3> points, std::span<const std::array<std::uint32_t, 3>> triangles, std::size_t most,
    int threads, const WorkMonitor& monitor = {});

}  // namespace snug
