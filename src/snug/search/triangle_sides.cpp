#include <snug/search/triangle_sides.h>

#include <algorithm>
#include <unordered_map>

namespace snug {

TriangleSides sides_of(std::span<const std::array<std::uint32_t, 3>> triangles) {
  TriangleSides found;
  std::unordered_map<std::uint64_t, std::size_t> sides;
  sides.reserve(3 * triangles.size());
  const auto key = [](std::uint32_t from, std::uint32_t to) { return std::uint64_t{from} << 32 | to; };
  for (std::size_t t = 0; t < triangles.size(); ++t) {
    for (std::size_t k = 0; k < 3; ++k) {
      const auto [there, added] = sides.emplace(key(triangles[t][k], triangles[t][(k + 1) % 3]), t);
      if (!added) found.same_way = {there->second, t};
    }
  }
  found.border = std::any_of(sides.begin(), sides.end(), [&](const auto& side) {
    return !sides.contains(
        key(static_cast<std::uint32_t>(side.first), static_cast<std::uint32_t>(side.first >> 32)));
  });
  return found;
}

}  // namespace snug
