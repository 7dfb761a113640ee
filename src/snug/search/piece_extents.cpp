#include <snug/search/piece_extents.h>

#include <algorithm>
#include <cmath>

#include <snug/geometry/rounding.h>

namespace snug {

Extent extent_of(const HullPoints& hull, const Vector3& direction, const Point3& from) {
  const Slab slab = outer_slab(hull, direction);
  if (std::isnan(slab.lower) || std::isnan(slab.upper)) return unbounded;
  const double sum = std::fabs(direction.x) + std::fabs(direction.y) + std::fabs(direction.z);
  const Vector3 between = hull.origin - from;
  const double height = dot(direction, between);
  const double error =
      enlarged(8 * unit_roundoff * sum * (max_abs(between) + hull.largest)) + 8 * underflow_error;
  return {height + slab.lower - error, height + slab.upper + error};
}

Extent extent_of(const OffsetTriangle& triangle, const Vector3& direction) {
  Extent extent;
  double largest = 0;
  for (const Point3& p : triangle.base) {
    extent.add(dot(direction, p - Point3{}));
    largest = std::max(largest, max_abs(p - Point3{}));
  }
  const double reach =
      enlarged(triangle.radius * length(direction) + 16 * unit_roundoff * largest) + 8 * underflow_error;
  if (!std::isfinite(reach)) return unbounded;
  return {extent.lower - reach, extent.upper + reach};
}

}  // namespace snug
