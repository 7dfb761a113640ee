#pragma once

#include <algorithm>
#include <cmath>

#include <snug/geometry.h>

namespace snug {

/// A position that was computed, and how far it is from the exact one.
struct BoundedPoint {
  Point3 position;
  double error = 0;  ///< upper bound, per coordinate, of |position - exact|, rounding included
};

constexpr Vector3 operator+(Vector3 a, Vector3 b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
constexpr Vector3 operator-(Vector3 a, Vector3 b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
constexpr Vector3 operator-(Vector3 a) { return {-a.x, -a.y, -a.z}; }
constexpr Vector3 operator*(double s, Vector3 a) { return {s * a.x, s * a.y, s * a.z}; }
constexpr Vector3 operator-(Point3 a, Point3 b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
constexpr Point3 operator+(Point3 a, Vector3 b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
constexpr Point3 operator-(Point3 a, Vector3 b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }

constexpr double dot(Vector3 a, Vector3 b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
constexpr Vector3 cross(Vector3 a, Vector3 b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
constexpr double length_sq(Vector3 a) { return dot(a, a); }
inline double length(Vector3 a) { return std::sqrt(dot(a, a)); }
inline double distance(Point3 a, Point3 b) { return length(a - b); }
inline double max_abs(Vector3 a) {
  return std::max(std::fabs(a.x), std::max(std::fabs(a.y), std::fabs(a.z)));
}
inline bool is_finite(Vector3 a) { return std::isfinite(a.x) && std::isfinite(a.y) && std::isfinite(a.z); }
inline bool is_finite(Point3 a) { return std::isfinite(a.x) && std::isfinite(a.y) && std::isfinite(a.z); }

/// A matrix by its rows; its product, and that of its transpose, with a vector.
using Rows3 = std::array<Vector3, 3>;
constexpr Vector3 times(const Rows3& m, Vector3 v) { return {dot(m[0], v), dot(m[1], v), dot(m[2], v)}; }
constexpr Vector3 transposed_times(const Rows3& m, Vector3 v) { return v.x * m[0] + v.y * m[1] + v.z * m[2]; }

/// Length of the longest side; 0 for an empty box.
[[nodiscard]] constexpr double longest_side(const Box3& box) {
  if (box.empty()) return 0;
  const Vector3 sides = box.upper - box.lower;
  return std::max(sides.x, std::max(sides.y, sides.z));
}

}  // namespace snug
