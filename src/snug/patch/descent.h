#pragma once

#include <snug/geometry/rounding.h>
#include <snug/patch/evaluate.h>
#include <support/error.h>

/// How a parameter goes down to the pieces of a patch.
namespace snug {

// Where a parameter lies after one split. Doubling is exact; 1 - 2u may round once, below one unit roundoff.
struct Descent {
  unsigned child;
  TriangleParameter at;
};

// Is the exact sum u + v at most `limit`? Rounding is monotonic, so only a tie needs the sum's own error,
// which is exact [Higham02, sec. 4.3].
inline bool sum_at_most(double u, double v, double limit) {
  const double sum = u + v;
  if (sum != limit) return sum < limit;
  const double rest = sum - u;
  return (u - (sum - rest)) + (v - rest) <= 0;
}

// The parameter that is meant by one whose exact sum is a rounding above 1: the nearest on the far edge. Both
// differences are exact.
inline TriangleParameter on_triangle(TriangleParameter p) {
  if (sum_at_most(p.u, p.v, 1)) return p;
  if (p.u >= 0.5) return {p.u, 1 - p.u};
  return {1 - p.v, p.v};
}

inline Descent descend(TriangleParameter p) {
  if (p.u >= 0.5) return {1, {2 * p.u - 1, 2 * p.v}};
  if (p.v >= 0.5) return {2, {2 * p.u, 2 * p.v - 1}};
  if (sum_at_most(p.u, p.v, 0.5)) return {0, {2 * p.u, 2 * p.v}};
  return {3, {1 - 2 * p.u, 1 - 2 * p.v}};
}

// The corner that a parameter names exactly, or 3.
inline std::size_t corner_at(TriangleParameter p) {
  if (p.u == 0 && p.v == 0) return 0;
  if (p.u == 1 && p.v == 0) return 1;
  if (p.u == 0 && p.v == 1) return 2;
  return 3;
}

// The parameter of a question, on the triangle.
inline TriangleParameter checked(TriangleParameter at) {
  require_value(at.u >= 0 && at.v >= 0 && at.u + at.v <= 1,
                "a parameter is outside its triangle: u and v must be >= 0, and u + v <= 1");
  return on_triangle(at);
}

// Answer of a piece at the depth limit for all its parameters: a corner, with the size of its control net as the
// error, which bounds the distance of any two of its limit points.
inline RelativePoint stopped_point(const Patch& piece) {
  Box3 box;
  for (const Vector3& p : piece.points) box.add(Point3{} + p);
  RelativePoint corner = corner_point(piece, 0);
  corner.error += enlarged(longest_side(box)) + 2 * piece.error;
  return corner;
}

}  // namespace snug
