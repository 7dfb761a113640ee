#include <oracle/self_twin.h>

#include <algorithm>
#include <cmath>
#include <vector>

namespace oracle {
namespace {

using Real = long double;
using Vec = std::array<Real, 3>;

Vec minus(const Vec& a, const Vec& b) { return {a[0] - b[0], a[1] - b[1], a[2] - b[2]}; }
Vec cross(const Vec& a, const Vec& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}
Real dot(const Vec& a, const Vec& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }
Real length(const Vec& a) { return std::sqrt(dot(a, a)); }

bool passes(const Vec& from, const Vec& to, const std::array<Vec, 3>& t, Real margin) {
  const Vec normal = cross(minus(t[1], t[0]), minus(t[2], t[0]));
  const Real size = length(normal);
  if (size < 1e-14L) return false;
  const Real a = dot(normal, minus(from, t[0])) / size, b = dot(normal, minus(to, t[0])) / size;
  if (!((a > margin && b < -margin) || (a < -margin && b > margin))) return false;
  Vec at;
  for (std::size_t k = 0; k < 3; ++k) at[k] = from[k] + a / (a - b) * (to[k] - from[k]);
  for (std::size_t k = 0; k < 3; ++k) {
    const Vec edge = minus(t[(k + 1) % 3], t[k]);
    if (dot(cross(normal, edge), minus(at, t[k])) / (size * length(edge)) <= margin) return false;
  }
  return true;
}

}  // namespace

std::optional<std::pair<std::size_t, std::size_t>> crossing_triangles(
    std::span<const std::array<double, 3>> points, std::span<const std::array<std::uint32_t, 3>> triangles,
    double margin) {
  struct Item {
    std::size_t index;
    std::array<Vec, 3> corners;
    Vec low, high;
  };
  std::vector<Item> items;
  for (std::size_t i = 0; i < triangles.size(); ++i) {
    Item item{i, {}, {}, {}};
    for (std::size_t k = 0; k < 3; ++k) {
      const auto& p = points[triangles[i][k]];
      item.corners[k] = {p[0], p[1], p[2]};
    }
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const auto [low, high] =
          std::minmax({item.corners[0][axis], item.corners[1][axis], item.corners[2][axis]});
      item.low[axis] = low;
      item.high[axis] = high;
    }
    items.push_back(item);
  }
  std::sort(items.begin(), items.end(), [](const Item& a, const Item& b) { return a.low[0] < b.low[0]; });
  for (std::size_t i = 0; i < items.size(); ++i) {
    for (std::size_t j = i + 1; j < items.size() && items[j].low[0] <= items[i].high[0]; ++j) {
      const Item &a = items[i], &b = items[j];
      if (a.low[1] > b.high[1] || b.low[1] > a.high[1] || a.low[2] > b.high[2] || b.low[2] > a.high[2])
        continue;
      const auto &x = triangles[a.index], &y = triangles[b.index];
      if (std::any_of(x.begin(), x.end(),
                      [&](auto v) { return std::find(y.begin(), y.end(), v) != y.end(); }))
        continue;
      for (std::size_t k = 0; k < 3; ++k) {
        if (passes(a.corners[k], a.corners[(k + 1) % 3], b.corners, margin) ||
            passes(b.corners[k], b.corners[(k + 1) % 3], a.corners, margin)) {
          return std::pair(a.index, b.index);
        }
      }
    }
  }
  return std::nullopt;
}

}  // namespace oracle
