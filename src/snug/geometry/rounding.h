#pragma once

#include <bit>
#include <cfloat>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <type_traits>

#ifdef __FAST_MATH__
#error "snug's bounds do not hold with -ffast-math"
#endif

static_assert(FLT_EVAL_METHOD == 0 && std::numeric_limits<double>::is_iec559,
              "error terms count roundings to IEEE double after every operation");

namespace snug {

/// Half the distance from 1 to the next number: one rounding to nearest errs by at most this, relatively.
template <class T>
inline constexpr double roundoff_of = static_cast<double>(std::numeric_limits<T>::epsilon()) / 2;
inline constexpr double unit_roundoff = roundoff_of<double>;

/// Error of one operation where denormals are flushed, which programs that link snug may do.
template <class T>
inline constexpr double underflow_of = static_cast<double>(std::numeric_limits<T>::min());
inline constexpr double underflow_error = underflow_of<double>;

/// Upper bound of k u / (1 - k u), the relative error of k roundings in a row [Higham02, lemma 3.1]; infinite beyond
/// k u = 2^-13, which is 2^40 roundings of doubles and 2^11 of floats.
template <class T = double>
[[nodiscard]] constexpr double gamma_bound(std::size_t k) {
  const double sum = static_cast<double>(k) * roundoff_of<T>;
  return sum <= 0x1p-13 ? sum * (1 + 0x1p-12) : std::numeric_limits<double>::infinity();
}

/// Upper bound of a non-negative quantity that was computed in doubles by at most a thousand roundings.
[[nodiscard]] constexpr double enlarged(double x) { return x * (1 + 0x1p-42) + underflow_error; }

/// The neighbours of x: with correctly rounded x they enclose the exact value.
/// As std::nextafter(), without a call.
template <class T>
[[nodiscard]] constexpr T rounded_up(T x) {
  using Bits = std::conditional_t<sizeof(T) == 4, std::int32_t, std::int64_t>;
  if (!(x < std::numeric_limits<T>::infinity())) return x;
  const auto bits = std::bit_cast<Bits>(x);
  constexpr Bits negative_zero = std::numeric_limits<Bits>::min();
  return std::bit_cast<T>(bits == negative_zero ? Bits{1} : bits < 0 ? bits - 1 : bits + 1);
}
template <class T>
[[nodiscard]] constexpr T rounded_down(T x) {
  return -rounded_up(-x);
}

/// The least number of single precision that is not below x.
[[nodiscard]] constexpr float float_up(double x) {
  const auto f = static_cast<float>(x);
  return static_cast<double>(f) >= x ? f : rounded_up(f);
}

/// Largest distance of two points whose coordinates differ by at most `error` each.
[[nodiscard]] constexpr double spatial_error(double error) { return error * 1.7320508075688774; }

}  // namespace snug
