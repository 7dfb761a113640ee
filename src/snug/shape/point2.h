#pragma once

namespace snug {

/// A point, or a vector, of a plane layout.
struct Point2 {
  double x = 0, y = 0;
};
[[nodiscard]] inline Point2 operator+(Point2 a, Point2 b) { return {a.x + b.x, a.y + b.y}; }
[[nodiscard]] inline Point2 operator-(Point2 a, Point2 b) { return {a.x - b.x, a.y - b.y}; }
[[nodiscard]] inline Point2 operator*(double s, Point2 a) { return {s * a.x, s * a.y}; }
[[nodiscard]] inline double dot(Point2 a, Point2 b) { return a.x * b.x + a.y * b.y; }
[[nodiscard]] inline double cross(Point2 a, Point2 b) { return a.x * b.y - a.y * b.x; }

}  // namespace snug
