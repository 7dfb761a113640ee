#include <snug/geometry/nearest_to_origin.h>

#include <algorithm>
#include <array>
#include <cstddef>

#include <snug/geometry/triangle.h>

namespace snug {
namespace {

// The nearest point of a triangle, which may be a segment or a point.
Vector3 nearest_of(const std::array<Vector3, 3>& t) { return -TriangleFoot(t[0], t[1], t[2]).rest({}); }

bool contains_origin(const std::array<Vector3, 3>& t, const Vector3& p) {
  const std::array<Vector3, 4> all{t[0], t[1], t[2], p};
  for (std::size_t k = 0; k < 4; ++k) {
    const Vector3 &a = all[(k + 1) % 4], &b = all[(k + 2) % 4], &c = all[(k + 3) % 4];
    const Vector3 normal = cross(b - a, c - a);
    const double own = dot(normal, all[k] - a), origin = dot(normal, -a);
    if (own == 0 || origin * own < 0) return false;
  }
  return true;
}

}  // namespace

Vector3 nearest_to_origin(std::span<const Vector3> points) {
  constexpr int max_steps = 200;
  // A triangle of points, corners of which may be the same.
  std::array<Vector3, 3> simplex{points[0], points[0], points[0]};
  Vector3 nearest = points[0];
  for (int step = 0; step < max_steps; ++step) {
    const auto along = [&](const Vector3& a, const Vector3& b) { return dot(nearest, a) < dot(nearest, b); };
    const Vector3 next = *std::min_element(points.begin(), points.end(), along);
    const double square = length_sq(nearest);
    if (square - dot(nearest, next) <= 0x1p-44 * square) break;
    if (contains_origin(simplex, next)) return {};
    std::array<Vector3, 3> best = simplex;
    double least = square;
    for (std::size_t k = 0; k < 3; ++k) {
      std::array<Vector3, 3> t = simplex;
      t[k] = next;
      if (const double own = length_sq(nearest_of(t)); own < least) {
        least = own;
        best = t;
      }
    }
    if (!(least < square)) break;
    simplex = best;
    nearest = nearest_of(simplex);
  }
  return nearest;
}

}  // namespace snug
