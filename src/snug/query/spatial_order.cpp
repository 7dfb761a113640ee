#include <snug/query/spatial_order.h>

#include <algorithm>
#include <utility>

namespace snug {
namespace {

// The low 10 bits, two zeros before each.
std::uint32_t spread(std::uint32_t bits) {
  bits = (bits | bits << 16) & 0x030000ffu;
  bits = (bits | bits << 8) & 0x0300f00fu;
  bits = (bits | bits << 4) & 0x030c30c3u;
  return (bits | bits << 2) & 0x09249249u;
}

}  // namespace

std::vector<std::uint32_t> spatial_order(std::span<const Point3> points) {
  Box3 box;
  for (const Point3& p : points) box.add(p);
  std::vector<std::pair<std::uint32_t, std::uint32_t>> places;
  places.reserve(points.size());
  for (const Point3& p : points) {
    std::uint32_t code = 0;
    for (std::size_t k = 0; k < 3; ++k) {
      const double share = (p[k] - box.lower[k]) / (box.upper[k] - box.lower[k]);
      const double cell = share >= 0 && share <= 1 ? 1023 * share : 0;
      code |= spread(static_cast<std::uint32_t>(cell)) << k;
    }
    places.emplace_back(code, static_cast<std::uint32_t>(places.size()));
  }
  std::sort(places.begin(), places.end());
  std::vector<std::uint32_t> order;
  order.reserve(places.size());
  for (const auto& place : places) order.push_back(place.second);
  return order;
}

}  // namespace snug
