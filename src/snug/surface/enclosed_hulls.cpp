#include <snug/surface/enclosed_hulls.h>

#include <algorithm>
#include <cmath>

#include <snug/base/rounding.h>

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

}  // namespace snug
