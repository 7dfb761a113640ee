#pragma once

#include <bit>
#include <cfloat>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>

#ifdef __FAST_MATH__
#error "snug's bounds do not hold with -ffast-math"
#endif

static_assert(FLT_EVAL_METHOD == 0 && std::numeric_limits<double>::is_iec559,
              "error terms count roundings to IEEE double after every operation");

namespace snug {

/// Half the distance from 1 to the next double: one rounding to nearest errs by at most this, relatively.
inline constexpr double unit_roundoff = 0x1p-53;

/// Error of one operation where denormals are flushed, which programs that link snug may do.
inline constexpr double underflow_error = DBL_MIN;

/// Upper bound of k u / (1 - k u), the relative error of k roundings in a row [Higham02, lemma 3.1].
/// Requires:  k <= 2^40.
[[nodiscard]] constexpr double gamma_bound(std::size_t k) {
  return static_cast<double>(k) * unit_roundoff * (1 + 0x1p-12);
}

/// Upper bound of a non-negative quantity that was computed in doubles by at most a thousand roundings.
[[nodiscard]] constexpr double enlarged(double x) { return x * (1 + 0x1p-42) + underflow_error; }

/// The neighbours of x: with correctly rounded x they enclose the exact value.
/// As std::nextafter(), without a call.
[[nodiscard]] constexpr double rounded_up(double x) {
  if (!(x < std::numeric_limits<double>::infinity())) return x;
  const auto bits = std::bit_cast<std::int64_t>(x);
  constexpr std::int64_t negative_zero = std::numeric_limits<std::int64_t>::min();
  return std::bit_cast<double>(bits == negative_zero ? 1 : bits < 0 ? bits - 1 : bits + 1);
}
[[nodiscard]] constexpr double rounded_down(double x) { return -rounded_up(-x); }

/// The least number of single precision that is not below x.
[[nodiscard]] inline float float_up(double x) {
  const auto f = static_cast<float>(x);
  return static_cast<double>(f) >= x ? f : std::nextafterf(f, INFINITY);
}

/// Largest distance of two points whose coordinates differ by at most `error` each.
[[nodiscard]] constexpr double spatial_error(double error) { return error * 1.7320508075688774; }

}  // namespace snug
