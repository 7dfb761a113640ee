#pragma once

#include <bit>
#include <cmath>
#include <cstdint>
#include <cstdlib>

#include <support/point.h>

namespace snug {

/// Multiplication by a power of two: brings coordinates to about 1 before any arithmetic, and results back.
///
/// Guarantee: exact, but for results below DBL_MIN, off by less than underflow_error, and above DBL_MAX.
class PowerOfTwo {
 public:
  PowerOfTwo() = default;
  explicit PowerOfTwo(int exponent) : exponent_(exponent) {
    const bool plain = std::abs(exponent) <= 1000;
    factor_ = plain ? normal_power(exponent) : 0;
    inverse_factor_ = plain ? normal_power(-exponent) : 0;
  }
  /// The power that brings `largest` (> 0, finite) into [1, 2); 1 for zero.
  [[nodiscard]] static PowerOfTwo normalising(double largest);

  [[nodiscard]] int exponent() const { return exponent_; }
  [[nodiscard]] PowerOfTwo inverse() const { return PowerOfTwo(-exponent_); }
  friend PowerOfTwo operator*(PowerOfTwo a, PowerOfTwo b) { return PowerOfTwo(a.exponent_ + b.exponent_); }

  /// May overflow to infinity: for a caller who knows that it cannot, or checks.
  [[nodiscard]] double apply(double x) const { return factor_ > 0 ? x * factor_ : std::ldexp(x, exponent_); }
  [[nodiscard]] Point3 apply(Point3 p) const { return {apply(p.x), apply(p.y), apply(p.z)}; }
  [[nodiscard]] Vector3 apply(Vector3 v) const { return {apply(v.x), apply(v.y), apply(v.z)}; }
  /// Then apply(x) cannot overflow for |x| <= 2^60, and loses less than underflow_error.
  [[nodiscard]] bool moderate() const { return std::abs(exponent_) <= 900; }
  /// 2^exponent() and 2^-exponent(), if moderate().
  [[nodiscard]] double factor() const { return factor_; }
  [[nodiscard]] double inverse_factor() const { return inverse_factor_; }
  /// Does x survive the way there and back?
  [[nodiscard]] bool exact(double x) const {
    return factor_ > 0 ? (x * factor_) * inverse_factor_ == x
                       : std::ldexp(std::ldexp(x, exponent_), -exponent_) == x;
  }

 private:
  // 2^exponent by its bits.
  static double normal_power(int exponent) {
    return std::bit_cast<double>(static_cast<std::uint64_t>(1023 + exponent) << 52);
  }

  int exponent_ = 0;
  double factor_ = 1;  // 2^exponent, or 0 where that is near the ends of the range
  double inverse_factor_ = 1;
};

/// Throws InputError (refused) if x is not finite: a result that no longer fits a double is not handed out.
double require_representable(double x);
Point3 require_representable(Point3 p);
Vector3 require_representable(Vector3 v);

}  // namespace snug
