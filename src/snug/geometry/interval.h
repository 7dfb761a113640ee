#pragma once

#include <snug/geometry/rounding.h>

namespace snug {

/// Closed interval of reals. Every operation returns an interval that contains all exact results, by rounding
/// to nearest and stepping to the neighbour: it needs no rounding mode. For masks and kinds, not for inner
/// loops.
///
/// Guarantee: inclusion; a result is wider than the exact range by at most two units in the last place of
///            each end.
/// Errors:    division by an interval that contains zero gives the whole line.
struct Interval {
  double lower = 0, upper = 0;

  constexpr Interval() = default;
  constexpr Interval(double exact) : lower(exact), upper(exact) {}  // NOLINT: exact numbers are intervals
  constexpr Interval(double low, double high) : lower(low), upper(high) {}

  [[nodiscard]] constexpr double middle() const { return lower + (upper - lower) / 2; }
  /// Upper bound of |x - middle()| for x in the interval.
  [[nodiscard]] double radius() const {
    const double m = middle();
    return lower == upper ? 0.0 : rounded_up(std::fmax(upper - m, m - lower));
  }
  [[nodiscard]] constexpr bool contains(double x) const { return lower <= x && x <= upper; }
  friend constexpr bool operator==(const Interval&, const Interval&) = default;
};

[[nodiscard]] Interval operator+(Interval a, Interval b);
[[nodiscard]] Interval operator-(Interval a, Interval b);
[[nodiscard]] Interval operator*(Interval a, Interval b);
[[nodiscard]] Interval operator/(Interval a, Interval b);
[[nodiscard]] Interval operator-(Interval a);

/// cos(2 pi k / n), by exact values where it is rational and a Taylor polynomial with remainder elsewhere.
/// Guarantee: inclusion; width at most 64 unit roundoffs.
/// Requires:  n >= 1.
[[nodiscard]] Interval cos_of_turn(unsigned k, unsigned n);

}  // namespace snug
