#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>

namespace snug {

/// How triangles meet along their edges. One hash a side.
struct TriangleSides {
  std::optional<std::array<std::size_t, 2>> same_way;  ///< two that run along an edge the same way
  bool border = false;                                 ///< does an edge belong to one triangle only?
};
[[nodiscard]] TriangleSides sides_of(std::span<const std::array<std::uint32_t, 3>> triangles);

}  // namespace snug
