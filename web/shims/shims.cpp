#include <emscripten.h>
#include <math.h>

#include <array>
#include <bit>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <string>
#include <system_error>

namespace {

// Quadruple precision is made of integers here and takes microseconds, and boxes ask for the same few angles again and again.
template <long double function(long double)>
double remembered(double x) {
  struct Known {
    double x = 0, value = static_cast<double>(function(0));
  };
  static std::array<Known, 256> known;
  const auto bits = std::bit_cast<std::uint64_t>(x);
  Known& place = known[(bits * 0x9e3779b97f4a7c15u) >> 56];
  if (std::bit_cast<std::uint64_t>(place.x) != bits) place = {x, static_cast<double>(function(x))};
  return place.value;
}

}  // namespace

// Sine, cosine and arc tangent come from the C library, whose last bit is nobody's promise, and answers depend on it through
// boxes' axes; motions have their own. Rounded from quadruple precision they are those nearest to the exact ones, as glibc's are but for
// very few arguments. These definitions come before those of the C library.
extern "C" double sin(double x) { return remembered<sinl>(x); }
extern "C" double cos(double x) { return remembered<cosl>(x); }
// For the angle of a screw, once a piece of a motion.
extern "C" double atan2(double y, double x) { return static_cast<double>(atan2l(y, x)); }

#if _LIBCPP_VERSION < 15000

// The shortest digits that read back as the same double, as JavaScript has them: plain where that is not longer, like
// std::to_chars. Whole numbers from 2^53 on are written with all their digits.
// clang-format off
EM_JS(int, snug_shortest, (double x, char* to, int room), {
  const [digits, exponent] = x.toExponential().split("e");
  const scientific = digits + "e" + exponent[0] + exponent.slice(1).padStart(2, "0");
  const sign = x < 0 || Object.is(x, -0) ? "-" : "";
  const figures = digits.split("-").join("").split(".").join("");
  const at = Number(exponent);
  let plain;
  if (at < 0) plain = "0." + "0".repeat(-at - 1) + figures;
  else if (figures.length <= at + 1) plain = figures + "0".repeat(at + 1 - figures.length);
  else plain = figures.slice(0, at + 1) + "." + figures.slice(at + 1);
  const other = (scientific.startsWith("-") ? "" : sign) + scientific;
  const exact = plain.indexOf(".") < 0 && Math.abs(x) >= 9007199254740992 ? BigInt(Math.abs(x)).toString() : plain;
  const text = sign.length + plain.length <= other.length ? sign + exact : other;
  if (text.length > room) return -1;
  for (let i = 0; i < text.length; ++i) HEAPU8[to + i] = text.charCodeAt(i);
  return text.length;
});
// clang-format on

_LIBCPP_BEGIN_NAMESPACE_STD

from_chars_result from_chars(const char* first, const char* last, double& value) {
  const auto digits = [last](const char* at) {
    while (at != last && '0' <= *at && *at <= '9') ++at;
    return at;
  };
  const char* const begin = first != last && *first == '-' ? first + 1 : first;
  const char* end = digits(begin);
  std::ptrdiff_t count = end - begin;
  if (end != last && *end == '.') {
    const char* const point = end;
    end = digits(point + 1);
    count += end - point - 1;
  }
  if (count == 0) return {first, errc::invalid_argument};
  const char* const mantissa_end = end;
  if (end != last && (*end == 'e' || *end == 'E')) {
    const char* sign = end + 1;
    if (sign != last && (*sign == '+' || *sign == '-')) ++sign;
    const char* const stop = digits(sign);
    if (stop != sign) end = stop;
  }
  const std::string text(first, end);
  const double read = std::strtod(text.c_str(), nullptr);
  const auto nonzero = [](char c) { return '1' <= c && c <= '9'; };
  bool vanished = false;
  for (const char* at = begin; read == 0 && at != mantissa_end; ++at) vanished = vanished || nonzero(*at);
  if (vanished || std::isinf(read)) return {end, errc::result_out_of_range};
  value = read;
  return {end, {}};
}

to_chars_result to_chars(char* first, char* last, double value) {
  if (!std::isfinite(value)) {
    const char* const word = std::isnan(value) ? "nan" : value < 0 ? "-inf" : "inf";
    const std::ptrdiff_t length = static_cast<std::ptrdiff_t>(std::strlen(word));
    if (last - first < length) return {last, errc::value_too_large};
    std::memcpy(first, word, static_cast<std::size_t>(length));
    return {first + length, {}};
  }
  const int length = snug_shortest(value, first, static_cast<int>(last - first));
  if (length < 0) return {last, errc::value_too_large};
  return {first + length, {}};
}

to_chars_result to_chars(char* first, char* last, double value, chars_format, int precision) {
  std::array<char, 64> text;
  const int length = std::snprintf(text.data(), text.size(), "%.*g", precision, value);
  if (length < 0 || length >= static_cast<int>(text.size()) || length > last - first)
    return {last, errc::value_too_large};
  std::memcpy(first, text.data(), static_cast<std::size_t>(length));
  return {first + length, {}};
}

_LIBCPP_END_NAMESPACE_STD

#endif

// Of Highway's library, which is not built for browsers, this is all that its headers call.
namespace hwy {

[[noreturn]] void Abort(const char* file, int line, const char* format, ...) {
  std::fprintf(stderr, "%s:%d: %s\n", file, line, format);
  std::abort();
}

}  // namespace hwy
