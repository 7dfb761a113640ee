#pragma once

#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <string_view>

#include <support/point.h>

namespace snug {

/// A real number read from a word, or why the word is none.
struct ParsedReal {
  double value = 0;
  /// The end of a sentence that begins with the word: "is not a finite number". Empty for a number.
  std::string_view fault;
};

/// In ASCII, whatever the locale.
[[nodiscard]] constexpr char lower_case(char c) {
  return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
}

/// Reads a whole word as a decimal number, whatever the locale.
///
/// Guarantee: the value is the double nearest to the decimal number, ties to even, also among subnormals. A
///            number nearer to zero than to the least subnormal becomes a zero of its sign: no fault.
/// Errors:    none thrown. Faults: "nan" and "inf" in any spelling, numbers that round beyond the largest
///            double, "1,5", "0x1p3", anything else that is not a number. A leading '+' is accepted.
[[nodiscard]] ParsedReal parse_real(std::string_view word);

/// Reads a whole word as a decimal integer; a leading '+' is accepted. Numbers beyond 64 bits become the
/// nearest 64-bit number, so that a range check still sees them. Nothing if the word is not an integer.
[[nodiscard]] std::optional<std::int64_t> parse_integer(std::string_view word);

/// Appends the shortest decimal that parse_real reads back as the same double, sign of zero included.
///
/// Errors:    InputError (value) on a number that is not finite.
void append_real(std::string& text, double value);

/// Appends "x y z", likewise.
void append_point(std::string& text, const Point3& point);

/// About six digits of a proved bound, rounded to the safe side: down for lower bounds, up with `at_least`
/// for upper ones; more digits where these are more than `within` off.
[[nodiscard]] std::string text_at_most(double x, bool at_least = false,
                                       double within = std::numeric_limits<double>::infinity());

/// "0.031 (0.25 % of the size)": at least that length.
[[nodiscard]] std::string text_of_length(double length, double size);

/// Appends a decimal integer.
void append_integer(std::string& text, std::uint64_t value);

}  // namespace snug
