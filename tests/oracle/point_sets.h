#pragma once

#include <oracle/twin_mesh.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

namespace oracle {

/// How far the points of either list are from their nearest in the other at most; infinite if their numbers
/// differ.
[[nodiscard]] inline double farthest_from_partner(const std::vector<Point>& a, const std::vector<Point>& b) {
  if (a.size() != b.size()) return std::numeric_limits<double>::infinity();
  double worst = 0;
  for (const auto& [from, to] : {std::pair{&a, &b}, std::pair{&b, &a}})
    for (const Point& p : *from) {
      double nearest = std::numeric_limits<double>::infinity();
      for (const Point& q : *to)
        nearest = std::min(nearest, std::hypot(p[0] - q[0], p[1] - q[1], p[2] - q[2]));
      worst = std::max(worst, nearest);
    }
  return worst;
}

}  // namespace oracle
