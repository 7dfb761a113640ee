#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace snug {

/// Why a word is not a finite real number.
enum class NumberFault : std::uint8_t {
  none,
  not_a_number,
  not_finite,
  too_large,
  decimal_comma,
  hexadecimal
};

/// A real number read from a word; `value` is meaningful only without a fault.
struct ParsedReal {
  double value = 0;
  NumberFault fault = NumberFault::none;
};

/// Reads a whole word as a decimal number, whatever the locale.
///
/// Guarantee: the value is the double nearest to the decimal number, ties to even, also among subnormals. A
///            number nearer to zero than to the least subnormal becomes a zero of its sign: it is not a
///            fault.
/// Errors:    none thrown. Faults: "nan" and "inf" in any spelling, numbers that round beyond the largest
///            double, "1,5", "0x1p3", anything else that is not a number. A leading '+' is accepted.
/// Cost:      linear in the word, no allocation.
[[nodiscard]] ParsedReal parse_real(std::string_view word);

/// Reads a whole word as a decimal integer; a leading '+' is accepted. Numbers beyond 64 bits become the
/// nearest 64-bit number, so that a range check still sees them. Nothing if the word is not an integer.
[[nodiscard]] std::optional<std::int64_t> parse_integer(std::string_view word);

/// The end of a sentence that begins with the word: "is not a finite number".
///
/// Requires:  a fault other than none.
[[nodiscard]] std::string_view describe(NumberFault fault);

/// Appends the shortest decimal that parse_real reads back as the same double, sign of zero included.
///
/// Errors:    InputError (value) on a number that is not finite.
void append_real(std::string& text, double value);

/// Appends a decimal integer.
void append_integer(std::string& text, std::uint64_t value);

}  // namespace snug
