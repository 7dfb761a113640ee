#pragma once
// Solids as functions: negative inside, roughly a distance near the surface.

#include <algorithm>
#include <functional>

#include "vec.h"

namespace models {

using Solid = std::function<double(const Vec3&)>;

inline double ellipsoid(const Vec3& p, const Vec3& centre, const Vec3& radii) {
  const Vec3 d = p - centre;
  const Vec3 a = {d.x / radii.x, d.y / radii.y, d.z / radii.z};
  const Vec3 b = {a.x / radii.x, a.y / radii.y, a.z / radii.z};
  const double near_centre = std::min({radii.x, radii.y, radii.z});
  const double slope = length(b);
  return slope < 1e-9 ? -near_centre : length(a) * (length(a) - 1) / slope;
}

inline double ball(const Vec3& p, const Vec3& centre, double radius) { return length(p - centre) - radius; }

/// Round bar from `a` to `b` whose radius runs from `ra` to `rb`.
inline double bar(const Vec3& p, const Vec3& a, double ra, const Vec3& b, double rb) {
  const Vec3 axis = b - a;
  const double t = std::clamp(dot(p - a, axis) / length_sq(axis), 0.0, 1.0);
  return length(p - a - t * axis) - (ra + t * (rb - ra));
}

/// Bar squashed across: distances along the unit vector `flat` count `ratio` times.
inline double blade(const Vec3& p, const Vec3& a, double ra, const Vec3& b, double rb, const Vec3& flat,
                    double ratio) {
  const auto squash = [&](const Vec3& q) { return q + ((ratio - 1) * dot(q, flat)) * flat; };
  return bar(squash(p), squash(a), ra, squash(b), rb) / (0.5 * (1 + ratio));
}

/// `p` turned about the x axis through `centre`; `c` and `s` need not have length one.
inline Vec3 pitched(const Vec3& p, const Vec3& centre, double c, double s) {
  const double size = std::sqrt(c * c + s * s);
  const Vec3 d = p - centre;
  return centre + Vec3{d.x, (c * d.y - s * d.z) / size, (s * d.y + c * d.z) / size};
}

/// Union whose seam is filled to a width of about `blend`. Source: the quadratic polynomial smooth minimum.
inline double join(double a, double b, double blend) {
  const double h = std::max(blend - (a > b ? a - b : b - a), 0.0) / blend;
  return std::min(a, b) - h * h * blend / 4;
}

inline double carve(double a, double b, double blend) { return -join(-a, b, blend); }
inline double common(double a, double b, double blend) { return -join(-a, -b, blend); }

}  // namespace models
