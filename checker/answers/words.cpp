#include "words.h"

#include <algorithm>
#include <charconv>
#include <cmath>

#include "../rejected.h"

namespace answers {
namespace {

constexpr std::string_view blanks = " \t\r\n";

}  // namespace

std::string_view Words::peek() const {
  const std::size_t begin = std::min(text_.find_first_not_of(blanks, at_), text_.size());
  return text_.substr(begin, std::min(text_.find_first_of(blanks, begin), text_.size()) - begin);
}

std::string_view Words::up_to_next(std::size_t begin) const {
  const std::size_t end = std::min(text_.find_first_not_of(blanks, at_), text_.size());
  return text_.substr(begin, end - begin);
}

std::string_view Words::next() {
  const std::string_view word = peek();
  if (word.empty()) refuse("the file ends too early");
  const auto begin = static_cast<std::size_t>(word.data() - text_.data());
  line_ += static_cast<std::size_t>(
      std::count(text_.begin() + static_cast<std::ptrdiff_t>(at_), word.begin(), '\n'));
  at_ = begin + word.size();
  return word;
}

void Words::expect(std::string_view word) {
  const std::string_view found = next();
  if (found != word) refuse("\"" + std::string(word) + "\" expected");
}

bool Words::take(std::string_view word) {
  const bool here = peek() == word;
  if (here) next();
  return here;
}

double Words::real() {
  std::string_view word = next();
  const bool negative = word.starts_with('-');
  if (negative) word.remove_prefix(1);
  const bool hex = word.starts_with("0x");
  if (hex) word.remove_prefix(2);
  if (word.starts_with('-')) refuse("a second sign");
  double value = NAN;
  const auto format = hex ? std::chars_format::hex : std::chars_format::general;
  const auto [end, error] = std::from_chars(word.begin(), word.end(), value, format);
  if (error != std::errc() || end != word.end() || !std::isfinite(value))
    refuse("a finite number expected");
  return negative ? -value : value;
}

std::int64_t Words::integer(std::int64_t least, std::int64_t most) {
  const std::string_view word = next();
  std::int64_t value = 0;
  const auto [end, error] = std::from_chars(word.begin(), word.end(), value);
  if (error != std::errc() || end != word.end() || value < least || value > most) {
    refuse("an integer from " + std::to_string(least) + " to " + std::to_string(most) +
           " expected");
  }
  return value;
}

void Words::refuse(const std::string& why) const {
  throw checker::Rejected("line " + std::to_string(line_) + ": " + why);
}

}  // namespace answers
