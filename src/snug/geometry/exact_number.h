#pragma once

#include <array>
#include <vector>

#include <snug/geometry/double_double.h>
#include <snug/geometry/exact_sign.h>
#include <support/point.h>

namespace snug {

/// A number as the sum of doubles that do not overlap, smallest first: sums and products of few of them, without rounding.
///
/// Requires:  all products a multiple of 2^-1074, as exact_product().
/// Source:    [Shewchuk97]; differs: products are sums of all parts.
class ExactNumber {
 public:
  ExactNumber() = default;
  explicit ExactNumber(double x) { add(x); }

  void add(double x);
  [[nodiscard]] int sign() const { return parts_.empty() ? 0 : parts_.back() > 0 ? 1 : -1; }
  /// Is it a double?
  [[nodiscard]] bool plain() const { return parts_.size() <= 1; }
  /// Up to 2^-96 of itself; a double as it is.
  [[nodiscard]] DoubleDouble about() const;

  friend ExactNumber operator+(const ExactNumber& a, const ExactNumber& b);
  friend ExactNumber operator-(const ExactNumber& a, const ExactNumber& b);
  friend ExactNumber operator*(const ExactNumber& a, const ExactNumber& b);

 private:
  std::vector<double> parts_;
};

/// A point whose coordinates are such numbers.
struct ExactPoint {
  std::array<ExactNumber, 3> exact;
  Point3 about;      ///< rounded
  double error = 0;  ///< upper bound, a coordinate, of what that took
  /// Of a double's size: exact_sign.h does for it.
  bool plain = false;

  ExactPoint() = default;
  explicit ExactPoint(std::array<ExactNumber, 3> coordinates);
  explicit ExactPoint(const Point3& p);
};

/// The determinants of exact_sign.h, and their signs.
/// Cost:      the signs 10 ns where doubles show them; else some microseconds, of points that take several doubles some ten.
[[nodiscard]] ExactNumber determinant(const ExactPoint& a, const ExactPoint& b, const ExactPoint& c,
                                      const ExactPoint& d);
[[nodiscard]] ExactNumber determinant(const ExactPoint& a, const ExactPoint& b, const ExactPoint& c,
                                      Projection to);
[[nodiscard]] int orientation(const ExactPoint& a, const ExactPoint& b, const ExactPoint& c,
                              const ExactPoint& d);
[[nodiscard]] int orientation(const ExactPoint& a, const ExactPoint& b, const ExactPoint& c, Projection to);

}  // namespace snug
