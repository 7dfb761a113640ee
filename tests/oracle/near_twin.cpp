#include <oracle/near_twin.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <map>
#include <queue>
#include <utility>

namespace oracle {

EdgeWays::EdgeWays(std::span<const Point> points, const std::vector<std::vector<std::uint32_t>>& faces)
    : points_(points.begin(), points.end()), next_(points.size()) {
  std::map<std::pair<std::uint32_t, std::uint32_t>, std::vector<std::size_t>> at_edge;
  const auto join = [&](std::uint32_t a, std::uint32_t b) {
    if (a == b) return;
    next_[a].push_back(b);
    next_[b].push_back(a);
  };
  for (std::size_t f = 0; f < faces.size(); ++f) {
    const auto& face = faces[f];
    for (std::size_t i = 0; i < face.size(); ++i) {
      const std::uint32_t a = face[i], b = face[(i + 1) % face.size()];
      longest_ = std::max(longest_, straight(a, b));
      at_edge[{std::min(a, b), std::max(a, b)}].push_back(f);
      for (std::size_t k = i + 1; k < face.size(); ++k) join(a, face[k]);
    }
  }
  // Across edges between triangles.
  for (const auto& [edge, sides] : at_edge) {
    if (sides.size() != 2 || faces[sides[0]].size() != 3 || faces[sides[1]].size() != 3) continue;
    std::array<std::uint32_t, 2> far{};
    for (std::size_t s = 0; s < 2; ++s) {
      for (const std::uint32_t v : faces[sides[s]]) {
        if (v != edge.first && v != edge.second) far[s] = v;
      }
    }
    join(far[0], far[1]);
  }
}

double EdgeWays::straight(std::uint32_t a, std::uint32_t b) const {
  const Point &p = points_[a], &q = points_[b];
  return std::hypot(p[0] - q[0], p[1] - q[1], p[2] - q[2]);
}

std::uint32_t EdgeWays::nearest(const Point& p) const {
  std::uint32_t best = 0;
  double least = std::numeric_limits<double>::infinity();
  for (std::uint32_t i = 0; i < points_.size(); ++i) {
    const double d = std::hypot(p[0] - points_[i][0], p[1] - points_[i][1], p[2] - points_[i][2]);
    if (d < least) {
      least = d;
      best = i;
    }
  }
  return best;
}

std::vector<double> EdgeWays::from(std::uint32_t point, double most) const {
  std::vector<double> ways(points_.size(), std::numeric_limits<double>::infinity());
  using Entry = std::pair<double, std::uint32_t>;
  std::priority_queue<Entry, std::vector<Entry>, std::greater<>> open;
  ways[point] = 0;
  open.emplace(0, point);
  while (!open.empty()) {
    const auto [d, at] = open.top();
    open.pop();
    if (d > ways[at]) continue;
    for (const std::uint32_t next : next_[at]) {
      const double way = d + straight(at, next);
      if (way > most || way >= ways[next]) continue;
      ways[next] = way;
      open.emplace(way, next);
    }
  }
  return ways;
}

double EdgeWays::longest_way(double chord, double most, std::uint32_t step) const {
  double longest = 0;
  for (std::uint32_t a = 0; a < points_.size(); a += step) {
    if (next_[a].empty()) continue;
    std::vector<double> ways;
    for (std::uint32_t b = 0; b < points_.size(); ++b) {
      if (next_[b].empty() || straight(a, b) > chord) continue;
      if (ways.empty()) ways = from(a, most);
      longest = std::max(longest, ways[b]);
    }
  }
  return longest;
}

}  // namespace oracle
