#include "length.h"

#include <charconv>
#include <cmath>
#include <string_view>

#include <snug/base/error.h>

namespace snug::command {
namespace {

// The whole text as one finite number, or nothing.
bool parse_number(std::string_view text, double& number) {
  if (!text.empty() && text.front() == '+') text.remove_prefix(1);
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  return error == std::errc() && end == text.data() + text.size() && std::isfinite(number);
}

// Without blanks at either end.
std::string_view trimmed(std::string_view text) {
  const auto begin = text.find_first_not_of(' ');
  return begin == std::string_view::npos ? "" : text.substr(begin, text.find_last_not_of(' ') - begin + 1);
}

}  // namespace

double Length::in_mesh_units(double size) const {
  const double result = percent ? number / 100 * size : number;
  if (!std::isfinite(result) || (number > 0 && !(result > 0))) {
    throw InputError(InputProblem::refused,
                     "a length in percent does not fit a double for a mesh of this size: give it "
                     "in mesh units");
  }
  return result;
}

Length parse_length(const std::string& text, const std::string& option, bool zero_allowed) {
  Length length;
  std::string_view digits = trimmed(text);
  if (digits.ends_with('%')) {
    length.percent = true;
    digits = trimmed(digits.substr(0, digits.size() - 1));
  }
  if (!parse_number(digits, length.number) || length.number < 0 || (length.number == 0 && !zero_allowed)) {
    throw UsageError(option + ": '" + text + "' is not a " + (zero_allowed ? "length" : "positive length") +
                     "; give mesh units (0.01) or percent of the size (1%)");
  }
  return length;
}

Motion parse_placement(const std::string& text, const std::string& option) {
  std::array<double, 12> numbers{};
  std::size_t count = 0, i = 0;
  const auto blank = [](char c) { return c == ' ' || c == ',' || c == '\t' || c == '\n' || c == '\r'; };
  while (i < text.size()) {
    if (blank(text[i])) {
      ++i;
      continue;
    }
    std::size_t end = i;
    while (end < text.size() && !blank(text[end])) ++end;
    double number = 0;
    const std::string word = text.substr(i, end - i);
    if (!parse_number(word, number)) throw UsageError(option + ": '" + word + "' is not a finite number");
    if (count < 12) numbers[count] = number;
    ++count;
    i = end;
  }
  if (count != 12) {
    throw UsageError(option + ": " + std::to_string(count) +
                     " numbers; a placement has twelve, a row-major 3x4 motion");
  }
  try {
    return Motion::from_3x4(numbers);
  } catch (const InputError& error) {
    throw InputError(error.problem(), option + ": " + error.what());
  }
}

}  // namespace snug::command
