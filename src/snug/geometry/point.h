#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace snug {

/// A displacement. Points and vectors are different types: two points cannot be added by accident.
struct Vector3 {
  double x = 0, y = 0, z = 0;
  [[nodiscard]] constexpr double operator[](std::size_t axis) const {
    return axis == 0 ? x : axis == 1 ? y : z;
  }
  constexpr double& operator[](std::size_t axis) { return axis == 0 ? x : axis == 1 ? y : z; }
  friend constexpr bool operator==(const Vector3&, const Vector3&) = default;
};

/// A position.
struct Point3 {
  double x = 0, y = 0, z = 0;
  [[nodiscard]] constexpr double operator[](std::size_t axis) const {
    return axis == 0 ? x : axis == 1 ? y : z;
  }
  constexpr double& operator[](std::size_t axis) { return axis == 0 ? x : axis == 1 ? y : z; }
  friend constexpr bool operator==(const Point3&, const Point3&) = default;
};

/// A position that was computed, and how far it is from the exact one.
struct BoundedPoint {
  Point3 position;
  double error =
      0;  ///< upper bound, a coordinate, of |position - exact|, rounding of the coordinates included
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
constexpr double max_abs(Vector3 a) {
  const double x = a.x < 0 ? -a.x : a.x, y = a.y < 0 ? -a.y : a.y, z = a.z < 0 ? -a.z : a.z;
  return std::max(x, std::max(y, z));
}
inline bool is_finite(Vector3 a) { return std::isfinite(a.x) && std::isfinite(a.y) && std::isfinite(a.z); }
inline bool is_finite(Point3 a) { return std::isfinite(a.x) && std::isfinite(a.y) && std::isfinite(a.z); }

/// Closed axis-aligned box; empty while lower > upper.
struct Box3 {
  Point3 lower{INFINITY, INFINITY, INFINITY};
  Point3 upper{-INFINITY, -INFINITY, -INFINITY};
  friend constexpr bool operator==(const Box3&, const Box3&) = default;

  constexpr void add(Point3 p) {
    lower = {std::min(lower.x, p.x), std::min(lower.y, p.y), std::min(lower.z, p.z)};
    upper = {std::max(upper.x, p.x), std::max(upper.y, p.y), std::max(upper.z, p.z)};
  }
  constexpr void add(const Box3& box) {
    add(box.lower);
    add(box.upper);
  }
  [[nodiscard]] constexpr bool empty() const { return lower.x > upper.x; }
  /// Length of the longest side; 0 for an empty box.
  [[nodiscard]] constexpr double longest_side() const {
    return empty() ? 0.0 : std::max(upper.x - lower.x, std::max(upper.y - lower.y, upper.z - lower.z));
  }
};

}  // namespace snug
