#include <snug/search/enclosed_pieces.h>

#include <algorithm>
#include <cmath>

#include <snug/geometry/rounding.h>

namespace snug {

Enclosed::Extent EnclosedHulls::extent(const Vector3& direction) const {
  Extent all{INFINITY, -INFINITY};
  const double sum = std::fabs(direction.x) + std::fabs(direction.y) + std::fabs(direction.z);
  for (const HullPoints* hull : hulls_) {
    const Slab slab = outer_slab(*hull, direction);
    const double from = dot(direction, hull->origin - Point3{});
    const double error =
        enlarged(8 * unit_roundoff * sum * (max_abs(hull->origin - Point3{}) + hull->largest)) +
        8 * underflow_error;
    all = {std::min(all.lower, from + slab.lower - error), std::max(all.upper, from + slab.upper + error)};
    if (std::isnan(slab.lower) || std::isnan(slab.upper)) return {-INFINITY, INFINITY};
  }
  return all;
}

Enclosed::Extent EnclosedTriangles::extent(const Vector3& direction) const {
  Extent all{INFINITY, -INFINITY};
  for (const OffsetTriangle& triangle : triangles_) {
    Extent one{INFINITY, -INFINITY};
    double largest = 0;
    for (const Point3& p : triangle.base) {
      const double height = dot(direction, p - Point3{});
      one = {std::min(one.lower, height), std::max(one.upper, height)};
      largest = std::max(largest, max_abs(p - Point3{}));
    }
    const double reach =
        enlarged(triangle.radius * length(direction) + 16 * unit_roundoff * largest) + 8 * underflow_error;
    if (!std::isfinite(reach)) return {-INFINITY, INFINITY};
    all = {std::min(all.lower, one.lower - reach), std::max(all.upper, one.upper + reach)};
  }
  return all;
}

}  // namespace snug
