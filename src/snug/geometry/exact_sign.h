#pragma once

#include <cmath>
#include <cstddef>

#include <support/point.h>

/// Signs of determinants, exact for the given doubles.
///
/// Guarantee: the sign of the determinant in exact arithmetic.
/// Requires:  may_be_signed() of all points.
/// Cost:      8 ns; where that is too close to zero for doubles, a microsecond or less.
/// Source:    [Shewchuk97]; differs: no stages between doubles and the exact sum of all parts of all products.
namespace snug {

/// Coordinates of 0 or from 2^-300 to 2^100 in size: then no part of a product of three differences underflows.
[[nodiscard]] inline bool may_be_signed(const Point3& p) {
  const auto fits = [](double x) { return x == 0 || (std::fabs(x) >= 0x1p-300 && std::fabs(x) <= 0x1p100); };
  return fits(p.x) && fits(p.y) && fits(p.z);
}

/// Sign of det(b - a, c - a, d - a): 1 if d is on the side of the triangle a b c from which it runs counter-clockwise, 0
/// if it is in its plane.
[[nodiscard]] int orientation(const Point3& a, const Point3& b, const Point3& c, const Point3& d);

/// Two coordinates of three, in this order.
struct Projection {
  std::size_t first = 0, second = 1;
};
/// 1 if a, b, c run counter-clockwise as the projection sees them, 0 if they are on a line there.
[[nodiscard]] int orientation(const Point3& a, const Point3& b, const Point3& c, Projection to);

}  // namespace snug
