#include <snug/bounds/base_triangle.h>

namespace snug {

BaseTriangle base_triangle(const HullPoints& points, const std::array<Vector3, 3>& corners) {
  BaseTriangle base;
  base.relative = corners;
  base.tips_stick_out = false;
  Vector3 normal = cross(corners[1] - corners[0], corners[2] - corners[0]);
  const double size = length(normal);
  if (size > 0 && std::isfinite(size) && is_finite(normal = (1 / size) * normal)) {
    const kernels::Coordinates all = points.coordinates();
    auto [lower, upper] = kernels::heights(all.first(points.tips_begin()), corners[0], normal);
    if (points.tips[0].kind) {
      const kernels::Range tips = kernels::heights(all.from(points.tips_begin()), corners[0], normal);
      base.tips_stick_out =
          std::max(lower - tips.lower, tips.upper - upper) > notable_excess * (upper - lower);
      lower = std::min(lower, tips.lower);
      upper = std::max(upper, tips.upper);
    }
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
