#pragma once

#include <testing/containment.h>

#include <snug/bvh/frame.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

namespace snug::testing {

inline std::vector<Point3> any_points(std::mt19937_64& random, const Point3& centre, double size) {
  std::uniform_real_distribution<double> unit(-size, size);
  const double flat = random() % 3 == 0 ? 1e-6 : 0.1;
  std::vector<Point3> points;
  for (std::size_t i = 0; i < 1 + random() % 6; ++i) {
    points.push_back(centre + Vector3{unit(random), 0.4 * unit(random), flat * unit(random)});
  }
  return points;
}

inline PlacedFrame any_frame(std::mt19937_64& random) {
  std::normal_distribution<double> normal;
  // Gram-Schmidt in doubles: rigid to a few roundings.
  Vector3 a{normal(random), normal(random), normal(random)},
      b{normal(random), normal(random), normal(random)};
  a = (1 / length(a)) * a;
  b = b - dot(a, b) * a;
  b = (1 / length(b)) * b;
  PlacedFrame frame;
  frame.rows = {a, b, cross(a, b)};
  frame.scale = random() % 2 ? 1.0 : 0.25;
  frame.translation = {normal(random), normal(random), normal(random)};
  frame.defect = 1e-15;
  if (random() % 4 == 0) {  // as far from rigid as is allowed
    frame.rows[0] = (1 + 4e-10) * frame.rows[0];
    frame.rows[1] = frame.rows[1] + 3e-10 * frame.rows[2];
    frame.defect = 1e-9;
  }
  return frame;
}

inline Extended image(const PlacedFrame& frame, const Point3& p) {
  Extended q;
  for (std::size_t k = 0; k < 3; ++k) {
    const Vector3& row = frame.rows[k];
    q[k] = static_cast<long double>(frame.scale) *
               (static_cast<long double>(p.x) * row.x + static_cast<long double>(p.y) * row.y +
                static_cast<long double>(p.z) * row.z) +
           frame.translation[k];
  }
  return q;
}

// Distance of two hulls from above: the nearest of some random combinations of their points, then steps from
// there towards the points that are farthest along the way [Frank and Wolfe].
inline long double distance_from_above(const std::vector<Extended>& a, const std::vector<Extended>& b,
                                       std::mt19937_64& random) {
  std::uniform_real_distribution<double> unit(0, 1);
  Extended best{INFINITY, 0, 0};
  const auto mix = [&](const std::vector<Extended>& points) {
    Extended p{};
    long double sum = 0;
    std::vector<long double> weights;
    for (std::size_t i = 0; i < points.size(); ++i) {
      weights.push_back(random() % 2 ? 0.0L : static_cast<long double>(unit(random)));
      sum += weights.back();
    }
    if (sum == 0) return points[random() % points.size()];
    for (std::size_t i = 0; i < points.size(); ++i) {
      for (std::size_t k = 0; k < 3; ++k) p[k] += weights[i] / sum * points[i][k];
    }
    return p;
  };
  for (int trial = 0; trial < 60; ++trial) {
    const Extended d = minus(mix(a), mix(b));
    if (!(inner(d, d) >= inner(best, best))) best = d;
  }
  const auto farthest = [](const std::vector<Extended>& points, const Extended& along, long double sign) {
    const Extended* most = &points[0];
    for (const Extended& p : points) {
      if (sign * inner(p, along) > sign * inner(*most, along)) most = &p;
    }
    return *most;
  };
  for (int step = 0; step < 60; ++step) {
    const Extended to = minus(farthest(a, best, -1), farthest(b, best, 1)), way = minus(to, best);
    const long double t = -inner(best, way) / inner(way, way);
    if (!(t > 0)) break;
    for (std::size_t k = 0; k < 3; ++k) best[k] += std::min(t, 1.0L) * way[k];
  }
  return std::sqrt(inner(best, best));
}

}  // namespace snug::testing
