#include <experiments/prism.h>

#include <algorithm>
#include <cmath>

namespace snug {

Prism kobbelt_prism(const BoundingPoints& points, const std::array<Vector3, 3>& corners) {
  const Vector3 direction = cross(corners[1] - corners[0], corners[2] - corners[0]);
  const double size = length(direction);
  const Vector3 normal = size > 0 ? (1 / size) * direction : Vector3{};
  const Slab slab = outer_slab(points, normal);
  const double height = dot(normal, corners[0]);
  Prism prism;
  for (std::size_t k = 0; k < 3; ++k) {
    prism.lower[k] = points.origin + corners[k] + (slab.lower - height) * normal;
    prism.upper[k] = points.origin + corners[k] + (slab.upper - height) * normal;
  }
  return prism;
}

double distance_outside(const Prism& prism, const Point3& p) {
  const Vector3 direction = cross(prism.upper[1] - prism.upper[0], prism.upper[2] - prism.upper[0]);
  const Vector3 normal = (1 / length(direction)) * direction;
  double outside = std::max({0.0, dot(normal, p - prism.upper[0]), dot(normal, prism.lower[0] - p)});
  for (std::size_t k = 0; k < 3; ++k) {
    const Vector3 edge = prism.upper[(k + 1) % 3] - prism.upper[k];
    const Vector3 outward = cross(edge, normal);
    outside = std::max(outside, dot((1 / length(outward)) * outward, p - prism.upper[k]));
  }
  return outside;
}

}  // namespace snug
