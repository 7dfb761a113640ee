#include <snug/io/number.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <limits>
#include <system_error>

#include <snug/base/contract.h>
#include <snug/base/error.h>
#include <snug/base/names.h>

namespace snug {
namespace {

constexpr auto number_fault_names = std::to_array<Named<NumberFault>>(
    {{"is not a number", NumberFault::not_a_number},
     {"is not a finite number", NumberFault::not_finite},
     {"is too large for a double", NumberFault::too_large},
     {"is not a number: write a decimal point instead of the comma", NumberFault::decimal_comma},
     {"is a hexadecimal number: write it in decimal", NumberFault::hexadecimal}});

bool is_digit(char c) { return c >= '0' && c <= '9'; }

char lower_case(char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; }

/// Compares the front of a word with a lower-case text.
bool begins_with(std::string_view word, std::string_view text) {
  return word.size() >= text.size() && std::equal(text.begin(), text.end(), word.begin(),
                                                  [](char a, char b) { return a == lower_case(b); });
}

NumberFault fault_of(std::string_view unsigned_word) {
  if (begins_with(unsigned_word, "nan") || begins_with(unsigned_word, "inf")) return NumberFault::not_finite;
  // What Microsoft's old run-time library prints for numbers that are not finite.
  if (begins_with(unsigned_word, "1.#")) return NumberFault::not_finite;
  if (begins_with(unsigned_word, "0x")) return NumberFault::hexadecimal;
  const std::size_t comma = unsigned_word.find(',');
  if (comma != std::string_view::npos && comma > 0 && is_digit(unsigned_word[comma - 1])) {
    return NumberFault::decimal_comma;
  }
  return NumberFault::not_a_number;
}

/// Whether a decimal number that from_chars found out of range is too large, not too small. Both are so far
/// from 1 that the sign of the exponent of the leading digit decides.
bool overflows(std::string_view unsigned_word) {
  const std::size_t mark = std::min(unsigned_word.find_first_of("eE"), unsigned_word.size());
  const std::string_view digits = unsigned_word.substr(0, mark);
  const std::int64_t written =
      mark < unsigned_word.size() ? parse_integer(unsigned_word.substr(mark + 1)).value_or(0) : 0;
  const std::size_t leading = digits.find_first_of("123456789");
  if (leading == std::string_view::npos) return false;
  const std::size_t point = std::min(digits.find('.'), digits.size());
  // The leading digit of 123.4 has exponent 2, that of 0.0012 has -3.
  const std::size_t places = point > leading ? point - leading - 1 : leading - point;
  const auto shift = point > leading ? static_cast<std::int64_t>(places) : -static_cast<std::int64_t>(places);
  constexpr std::int64_t far = std::numeric_limits<std::int64_t>::max() / 4;
  return std::clamp(written, -far, far) + shift >= 0;
}

}  // namespace

ParsedReal parse_real(std::string_view word) {
  if (!word.empty() && word.front() == '+') {
    word.remove_prefix(1);
    if (!word.empty() && word.front() == '-') return {0, NumberFault::not_a_number};
  }
  const bool negative = !word.empty() && word.front() == '-';
  const std::string_view digits = word.substr(negative ? 1 : 0);
  // from_chars itself would accept the words "inf" and "nan".
  if (digits.empty() || !(is_digit(digits.front()) || digits.front() == '.')) return {0, fault_of(digits)};

  double value = 0;
  const char* const end = word.data() + word.size();
  const auto [stop, error] = std::from_chars(word.data(), end, value);
  if (stop != end || error == std::errc::invalid_argument) return {0, fault_of(digits)};
  if (error == std::errc::result_out_of_range) {
    if (overflows(digits)) return {0, NumberFault::too_large};
    value = negative ? -0.0 : 0.0;
  }
  return {value, NumberFault::none};
}

std::optional<std::int64_t> parse_integer(std::string_view word) {
  if (word.size() > 1 && word.front() == '+' && is_digit(word[1])) word.remove_prefix(1);
  std::int64_t value = 0;
  const char* const end = word.data() + word.size();
  const auto [stop, error] = std::from_chars(word.data(), end, value);
  if (stop != end || error == std::errc::invalid_argument) return std::nullopt;
  if (error == std::errc::result_out_of_range) {
    using Limits = std::numeric_limits<std::int64_t>;
    return word.front() == '-' ? Limits::min() : Limits::max();
  }
  return value;
}

std::string_view describe(NumberFault fault) {
  SNUG_EXPECT(fault != NumberFault::none);
  return name_in(number_fault_names, fault);
}

void append_real(std::string& text, double value) {
  require_value(std::isfinite(value), "a number to write is not finite");
  std::array<char, 32> digits;
  const auto result = std::to_chars(digits.data(), digits.data() + digits.size(), value);
  text.append(digits.data(), result.ptr);
}

void append_integer(std::string& text, std::uint64_t value) {
  std::array<char, 24> digits;
  const auto result = std::to_chars(digits.data(), digits.data() + digits.size(), value);
  text.append(digits.data(), result.ptr);
}

}  // namespace snug
