#pragma once

#include <snug/geometry.h>
#include <snug/geometry/rounding.h>

namespace snug {

/// Arithmetic of intervals, by rounding to nearest and stepping to the neighbour: no rounding mode is needed.
/// For masks and kinds, not for inner loops. Division by an interval that contains zero gives the whole line.
///
/// Guarantee: inclusion; each end is off from that of the exact range by at most two units in its last place.
[[nodiscard]] Interval operator+(Interval a, Interval b);
[[nodiscard]] Interval operator-(Interval a, Interval b);
[[nodiscard]] Interval operator*(Interval a, Interval b);
[[nodiscard]] Interval operator/(Interval a, Interval b);
[[nodiscard]] Interval operator-(Interval a);

[[nodiscard]] constexpr double middle(const Interval& a) { return a.lower + (a.upper - a.lower) / 2; }
/// Upper bound of |x - middle(a)| for x in the interval.
[[nodiscard]] inline double radius(const Interval& a) {
  const double m = middle(a);
  return a.lower == a.upper ? 0.0 : rounded_up(std::fmax(a.upper - m, m - a.lower));
}

/// Of the part that is not negative.
[[nodiscard]] Interval square_root(Interval a);

struct SineCosine {
  Interval sine, cosine;
};
/// Of every angle in the interval.
/// Guarantee: inclusion; width at most 64 unit roundoffs plus that of the angle, for an angle up to 4 in size.
[[nodiscard]] SineCosine sine_cosine(Interval radians);

/// cos(2 pi k / n), by exact values where it is rational and a Taylor polynomial with remainder elsewhere.
/// Guarantee: inclusion; width at most 64 unit roundoffs.
/// Requires:  n >= 1.
[[nodiscard]] Interval cos_of_turn(unsigned k, unsigned n);

/// Sine and cosine of an angle in degrees, exact for multiples of 90.
/// Guarantee: inclusion; width at most 64 unit roundoffs.
/// Requires:  a finite angle.
[[nodiscard]] SineCosine of_degrees(double angle);

}  // namespace snug
