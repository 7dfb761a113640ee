#include <snug/bvh/carried_axes.h>

#include <cmath>

namespace snug {
namespace {

// Two edges of a triangle, and across them a vector that grows as they do.
struct Basis {
  Vector3 first, second, across;
};
Basis basis_of(const Triangle& points) {
  const Vector3 first = points[1] - points[0], second = points[2] - points[0], normal = cross(first, second);
  const double area = length(normal);
  return {first, second, area > 0 ? (1 / std::sqrt(area)) * normal : Vector3{}};
}

}  // namespace

CarriedAxes::CarriedAxes(const Axes& axes, const Triangle& points) : coordinates_{axes[0], axes[1]} {
  const Basis basis = basis_of(points);
  const double aa = length_sq(basis.first), ab = dot(basis.first, basis.second), bb = length_sq(basis.second),
               nn = length_sq(basis.across), determinant = aa * bb - ab * ab;
  if (!(determinant > 0x1p-30 * aa * bb) || !(nn > 0)) return;
  for (std::size_t k = 0; k < 2; ++k) {
    const double a = dot(axes[k], basis.first), b = dot(axes[k], basis.second);
    const Vector3 found{(a * bb - b * ab) / determinant, (b * aa - a * ab) / determinant,
                        dot(axes[k], basis.across) / nn};
    if (!is_finite(found)) {
      coordinates_ = {axes[0], axes[1]};
      return;
    }
    coordinates_[k] = found;
  }
  carried_ = true;
}

Axes CarriedAxes::at(const Triangle& points) const {
  if (!carried_) return orthonormal_axes(coordinates_[0], coordinates_[1]);
  const Basis basis = basis_of(points);
  std::array<Vector3, 2> axes;
  for (std::size_t k = 0; k < 2; ++k) {
    const Vector3& c = coordinates_[k];
    axes[k] = c.x * basis.first + c.y * basis.second + c.z * basis.across;
  }
  return orthonormal_axes(axes[0], axes[1]);
}

std::array<std::size_t, 3> spread_points(std::span<const Point3> points) {
  std::array<std::size_t, 3> chosen{0, 0, 0};
  double most = 0;
  for (std::size_t i = 1; i < points.size(); ++i) {
    const double apart_sq = length_sq(points[i] - points[0]);
    if (!(apart_sq > most)) continue;
    most = apart_sq;
    chosen[1] = i;
  }
  const Vector3 line = points[chosen[1]] - points[0];
  most = 0;
  for (std::size_t i = 1; i < points.size(); ++i) {
    const double apart_sq = length_sq(cross(line, points[i] - points[0]));
    if (!(apart_sq > most)) continue;
    most = apart_sq;
    chosen[2] = i;
  }
  return chosen;
}

}  // namespace snug
