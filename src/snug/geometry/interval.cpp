#include <snug/geometry/interval.h>

#include <algorithm>
#include <cstdint>
#include <numbers>

#include <support/contract.h>

namespace snug {
namespace {

// Around the exact values of four numbers that were rounded to nearest.
Interval around(double p, double q, double r, double s) {
  const auto [low, high] = std::minmax({p, q, r, s});
  return {rounded_down(low), rounded_up(high)};
}

// Taylor of sin and cos on [-1, 1]: terms alternate and fall, so the first left out bounds the remainder.
Interval alternating_series(Interval first, Interval x_sq, unsigned factor) {
  Interval term = first, sum = first;
  for (unsigned i = factor; i < 26; i += 2) {
    term = -(term * x_sq) / Interval(static_cast<double>(i * (i + 1)));
    sum = sum + term;
  }
  const double rest = std::fmax(std::fabs(term.lower), std::fabs(term.upper));
  return {rounded_down(sum.lower - rest), rounded_up(sum.upper + rest)};
}

// Between these two neighbours.
constexpr Interval pi(0x1.921fb54442d18p+1, 0x1.921fb54442d19p+1);

}  // namespace

Interval operator+(Interval a, Interval b) {
  return {rounded_down(a.lower + b.lower), rounded_up(a.upper + b.upper)};
}

Interval operator-(Interval a, Interval b) {
  return {rounded_down(a.lower - b.upper), rounded_up(a.upper - b.lower)};
}

Interval operator-(Interval a) { return {-a.upper, -a.lower}; }

Interval operator*(Interval a, Interval b) {
  return around(a.lower * b.lower, a.lower * b.upper, a.upper * b.lower, a.upper * b.upper);
}

Interval operator/(Interval a, Interval b) {
  if (b.contains(0)) return {-INFINITY, INFINITY};
  return around(a.lower / b.lower, a.lower / b.upper, a.upper / b.lower, a.upper / b.upper);
}

Interval square_root(Interval a) {
  return {std::fmax(0.0, rounded_down(std::sqrt(std::fmax(0.0, a.lower)))),
          rounded_up(std::sqrt(std::fmax(0.0, a.upper)))};
}

SineCosine sine_cosine(Interval radians) {
  const double angle = middle(radians), off = radius(radians);
  if (!(std::fabs(angle) < 0x1p40 && off < 1)) return {{-1, 1}, {-1, 1}};
  const double quarters = std::nearbyint(angle * (2 / std::numbers::pi));
  // Half of pi lies between these two neighbours.
  const Interval half_pi(0x1.921fb54442d18p+0, 0x1.921fb54442d19p+0);
  const Interval rest =
      quarters == 0 ? Interval(angle) : Interval(angle) - Interval(quarters) * half_pi;  // in [-0.8, 0.8]
  const Interval rest_sq = rest * rest;
  const auto widened = [&](Interval x) {
    return Interval(std::fmax(-1.0, rounded_down(x.lower - off)), std::fmin(1.0, rounded_up(x.upper + off)));
  };
  const Interval s = widened(alternating_series(rest, rest_sq, 2)),
                 c = widened(alternating_series(1.0, rest_sq, 1));
  switch (static_cast<std::int64_t>(quarters) & 3) {
    case 0:
      return {s, c};
    case 1:
      return {c, -s};
    case 2:
      return {-s, -c};
    default:
      return {-c, s};
  }
}

Interval cos_of_turn(unsigned k, unsigned n) {
  SNUG_EXPECT(n >= 1);
  std::uint64_t num = static_cast<std::uint64_t>(k % n), den = n;
  if (2 * num > den) num = den - num;  // cos(2 pi - x) = cos x: now 0 <= num/den <= 1/2
  if (4 * num > den) {                 // cos(pi - x) = -cos x
    if (2 * num == den) return -1.0;
    if (3 * num == den) return -0.5;
    const std::uint64_t top = den - 2 * num;  // x' = 2 pi (den - 2 num) / (2 den)
    return -cos_of_turn(static_cast<unsigned>(top), static_cast<unsigned>(2 * den));
  }
  if (num == 0) return 1.0;
  if (4 * num == den) return 0.0;
  if (6 * num == den) return 0.5;
  const Interval x =
      Interval(2) * pi * Interval(static_cast<double>(num)) / Interval(static_cast<double>(den));
  if (8 * num <= den) return alternating_series(1.0, x * x, 1);
  const Interval y = pi / Interval(2) - x;  // in (0, pi/4): cos x = sin y
  return alternating_series(y, y * y, 2);
}

SineCosine of_degrees(double angle) {
  SNUG_EXPECT(std::isfinite(angle));
  int quarters = 0;                                         // correct in its last three bits at least
  const double rest = std::remquo(angle, 90.0, &quarters);  // exact, in [-45, 45]
  Interval sine = 0.0, cosine = 1.0;
  if (rest != 0) {
    const Interval x = Interval(rest) * pi / Interval(180);
    sine = alternating_series(x, x * x, 2);
    cosine = alternating_series(1.0, x * x, 1);
  }
  switch (quarters & 3) {
    case 0:
      return {sine, cosine};
    case 1:
      return {cosine, -sine};
    case 2:
      return {-sine, -cosine};
    default:
      return {-cosine, sine};
  }
}

}  // namespace snug
