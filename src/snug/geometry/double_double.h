#pragma once

#include <type_traits>

#include <support/point.h>

/// Sums of two doubles, of which the second is at most half a unit in the last place of the first: some 106 bits.
namespace snug {

/// A sum, and what rounding took from it: x + y = high + low exactly.
/// Source:    [Shewchuk97, theorems 7 and 18].
struct DoubleDouble {
  double high = 0, low = 0;
};
[[nodiscard]] constexpr DoubleDouble exact_sum(double x, double y) {
  const double sum = x + y, y_part = sum - x, x_part = sum - y_part;
  return {sum, (x - x_part) + (y - y_part)};
}
/// The same where |x| >= |y| or x = 0.
[[nodiscard]] constexpr DoubleDouble exact_ordered_sum(double x, double y) {
  const double sum = x + y;
  return {sum, y - (sum - x)};
}
/// x y = high + low exactly, without a fused multiply-add.
/// Requires:  |x|, |y| at most 2^500, and all of the product a multiple of 2^-1074, as it is if it is 2^-900 or more.
[[nodiscard]] constexpr DoubleDouble exact_product(double x, double y) {
  constexpr double splitter = 0x1p27 + 1;
  const double product = x * y;
  const double x_big = splitter * x, y_big = splitter * y;
  const double x_high = x_big - (x_big - x), y_high = y_big - (y_big - y);
  const double x_low = x - x_high, y_low = y - y_high;
  return {product, x_low * y_low - (((product - x_high * y_high) - x_low * y_high) - x_high * y_low)};
}

/// Arithmetic with relative errors below 2^-100, but for products that underflow.
/// Source:    [Joldes17, algorithms 6, 12 and 17].
[[nodiscard]] constexpr DoubleDouble operator+(DoubleDouble x, DoubleDouble y) {
  const DoubleDouble s = exact_sum(x.high, y.high), t = exact_sum(x.low, y.low);
  const DoubleDouble v = exact_ordered_sum(s.high, s.low + t.high);
  return exact_ordered_sum(v.high, t.low + v.low);
}
[[nodiscard]] constexpr DoubleDouble operator-(DoubleDouble x) { return {-x.high, -x.low}; }
[[nodiscard]] constexpr DoubleDouble operator-(DoubleDouble x, DoubleDouble y) { return x + -y; }
[[nodiscard]] constexpr DoubleDouble operator*(DoubleDouble x, DoubleDouble y) {
  const DoubleDouble p = exact_product(x.high, y.high);
  return exact_ordered_sum(p.high, p.low + (x.high * y.low + x.low * y.high));
}
[[nodiscard]] constexpr DoubleDouble operator/(DoubleDouble x, DoubleDouble y) {
  const double q = x.high / y.high;
  const DoubleDouble rest = x - y * DoubleDouble{q, 0};
  return exact_ordered_sum(q, rest.high / y.high);
}

/// A vector of double-doubles or doubles.
template <class Number>
struct Vector3Of {
  Number x, y, z;
};
/// y - x, exact for double-doubles, rounded for doubles.
template <class Number>
[[nodiscard]] constexpr Vector3Of<Number> difference(const Point3& x, const Point3& y) {
  const auto one = [](double from, double to) -> Number {
    if constexpr (std::is_same_v<Number, double>) {
      return to - from;
    } else {
      return exact_sum(to, -from);
    }
  };
  return {one(x.x, y.x), one(x.y, y.y), one(x.z, y.z)};
}
template <class Number>
[[nodiscard]] constexpr Vector3Of<Number> operator-(const Vector3Of<Number>& a, const Vector3Of<Number>& b) {
  return {a.x - b.x, a.y - b.y, a.z - b.z};
}
template <class Number>
[[nodiscard]] constexpr Vector3Of<Number> operator*(Number s, const Vector3Of<Number>& a) {
  return {s * a.x, s * a.y, s * a.z};
}
template <class Number>
[[nodiscard]] constexpr Number dot(const Vector3Of<Number>& a, const Vector3Of<Number>& b) {
  return a.x * b.x + a.y * b.y + a.z * b.z;
}
template <class Number>
[[nodiscard]] constexpr Vector3Of<Number> cross(const Vector3Of<Number>& a, const Vector3Of<Number>& b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

}  // namespace snug
