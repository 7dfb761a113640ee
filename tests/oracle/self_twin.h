#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <utility>

namespace oracle {

/// Two triangles of a mesh without a common vertex of which an edge of one passes through the inside of the
/// other, each end and each side by more than `margin`; by brute force, in long doubles. Nothing of the library.
[[nodiscard]] std::optional<std::pair<std::size_t, std::size_t>> crossing_triangles(
    std::span<const std::array<double, 3>> points, std::span<const std::array<std::uint32_t, 3>> triangles,
    double margin);

}  // namespace oracle
