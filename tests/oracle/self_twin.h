#pragma once

#include <oracle/winding_twin.h>

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

/// Does a limit surface cross itself within some distance of a place, about? Only the faces near it are refined, level by level, until
/// they are small beside that distance. From the seventh level on triangles are small beside the surface's curvature: an edge of one must
/// pass through another one without a common vertex, off its ends and sides by more than a thousandth of the smaller one's longest edge, and
/// half that share at each further level, as triangles become flatter.
///
/// Faces left out change the rules at those that stay: vertices that any of them bears upon are marked, and their triangles not asked.
[[nodiscard]] bool crosses_near(TaggedMesh mesh, const WindingScheme& scheme, const Point& place,
                                double within);

}  // namespace oracle
