#include <snug/enclose/base_triangle.h>

namespace snug {

BaseTriangle base_triangle(const HullPoints& points, const std::array<Vector3, 3>& corners) {
  BaseTriangle base;
  base.relative = corners;
  Vector3 normal = cross(corners[1] - corners[0], corners[2] - corners[0]);
  const double size = length(normal);
  if (size > 0 && std::isfinite(size) && is_finite(normal = (1 / size) * normal)) {
    const auto [lower, upper] = kernels::heights(points.coordinates(), corners[0], normal);
    const Vector3 shift = (0.5 * (lower + upper)) * normal;
    if (is_finite(shift)) {
      for (Vector3& corner : base.relative) corner = corner + shift;
    }
  }
  double largest = 0;
  for (std::size_t k = 0; k < 3; ++k) {
    base.placed[k] = points.origin + base.relative[k];
    largest = std::max(largest, max_abs(base.placed[k] - Point3{}));
  }
  base.placing_error = unit_roundoff * largest * (1 + 0x1p-50);
  return base;
}

}  // namespace snug
