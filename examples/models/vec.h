#pragma once
// Points of the example models. Only +, -, *, / and sqrt are used anywhere in the generator, each of which IEEE 754
// rounds correctly: every machine writes the same bytes.

#include <array>
#include <cmath>
#include <cstdint>

namespace models {

using Index = std::uint32_t;

struct Vec3 {
  double x = 0, y = 0, z = 0;

  double& operator[](std::size_t axis) { return axis == 0 ? x : axis == 1 ? y : z; }
  double operator[](std::size_t axis) const { return axis == 0 ? x : axis == 1 ? y : z; }
};

inline Vec3 operator+(const Vec3& a, const Vec3& b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
inline Vec3 operator-(const Vec3& a, const Vec3& b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
inline Vec3 operator*(double s, const Vec3& a) { return {s * a.x, s * a.y, s * a.z}; }
inline double dot(const Vec3& a, const Vec3& b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
inline double length_sq(const Vec3& a) { return dot(a, a); }
inline double length(const Vec3& a) { return std::sqrt(dot(a, a)); }

inline Vec3 cross(const Vec3& a, const Vec3& b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

/// `a` scaled to length one; `a` itself if it is zero.
inline Vec3 unit(const Vec3& a) {
  const double size = length(a);
  return size > 0 ? (1 / size) * a : a;
}

/// Cosine and sine of `turns` full turns, to about 1e-15. Requires: |turns| < 1000.
/// Source: Taylor series on an eighth of a turn, doubled three times (the library's cosine differs between machines).
inline std::array<double, 2> cos_sin(double turns) {
  const double reduced = turns - std::floor(turns + 0.5);
  const double t = reduced * (6.283185307179586476925 / 8);
  const double q = t * t;
  double c = 1, s = 1;
  for (int k = 9; k >= 1; --k) {
    c = 1 - q / ((2 * k - 1) * (2 * k)) * c;
    s = 1 - q / ((2 * k) * (2 * k + 1)) * s;
  }
  s *= t;
  for (int i = 0; i < 3; ++i) {
    const double doubled = c * c - s * s;
    s = 2 * s * c;
    c = doubled;
  }
  return {c, s};
}

}  // namespace models
