#include <support/number.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <limits>
#include <system_error>

#include <support/error.h>

namespace snug {
namespace {

constexpr std::string_view not_a_number = "is not a number", not_finite = "is not a finite number";

bool is_digit(char c) { return c >= '0' && c <= '9'; }

/// Compares the front of a word with a lower-case text.
bool begins_with(std::string_view word, std::string_view text) {
  return word.size() >= text.size() && std::equal(text.begin(), text.end(), word.begin(),
                                                  [](char a, char b) { return a == lower_case(b); });
}

std::string_view fault_of(std::string_view unsigned_word) {
  // The last is what Microsoft's old run-time library prints.
  for (const char* text : {"nan", "inf", "1.#"}) {
    if (begins_with(unsigned_word, text)) return not_finite;
  }
  if (begins_with(unsigned_word, "0x")) return "is a hexadecimal number: write it in decimal";
  const std::size_t comma = unsigned_word.find(',');
  if (comma != std::string_view::npos && comma > 0 && is_digit(unsigned_word[comma - 1])) {
    return "is not a number: write a decimal point instead of the comma";
  }
  return not_a_number;
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
  const auto shift =
      static_cast<std::int64_t>(point) - static_cast<std::int64_t>(leading) - (point > leading);
  constexpr std::int64_t far = std::numeric_limits<std::int64_t>::max() / 4;
  return std::clamp(written, -far, far) + shift >= 0;
}

}  // namespace

ParsedReal parse_real(std::string_view word) {
  if (!word.empty() && word.front() == '+') {
    word.remove_prefix(1);
    if (!word.empty() && word.front() == '-') return {0, not_a_number};
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
    if (overflows(digits)) return {0, "is too large for a double"};
    value = negative ? -0.0 : 0.0;
  }
  return {value, {}};
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

void append_real(std::string& text, double value) {
  require_value(std::isfinite(value), "a number to write is not finite");
  std::array<char, 32> digits;
  const auto result = std::to_chars(digits.data(), digits.data() + digits.size(), value);
  text.append(digits.data(), result.ptr);
}

std::string text_at_most(double x, bool at_least, double within) {
  std::array<char, 32> text{};  // "-1.2345678901234567e-308"
  const auto written = [&](int digits) {
    return std::to_chars(text.data(), text.data() + text.size(), x, std::chars_format::general, digits).ptr;
  };
  const char* end = nullptr;
  for (int digits = 6; digits <= 17; ++digits) {  // 17 distinguish any two doubles
    end = written(digits);
    double read = x;
    std::from_chars(text.data(), end, read);
    if (read == x || ((at_least ? read > x : read < x) && std::fabs(read - x) <= within)) break;
  }
  return {text.data(), static_cast<std::size_t>(end - text.data())};
}

std::string text_of_length(double length, double size) {
  if (!(size > 0)) return text_at_most(length, true);
  // As enlarged() of geometry/rounding.h, which is none of this room's.
  const double percent = length > 0 ? length / size * 100 * (1 + 0x1p-42) + 0x1p-1022 : 0;
  return text_at_most(length, true) + " (" + text_at_most(percent, true) + " % of the size)";
}

void append_point(std::string& text, const Point3& point) {
  for (std::size_t axis = 0; axis < 3; ++axis) {
    if (axis > 0) text += ' ';
    append_real(text, point[axis]);
  }
}

void append_integer(std::string& text, std::uint64_t value) { text += std::to_string(value); }

}  // namespace snug
