#include "length.h"

#include <charconv>
#include <cmath>
#include <string_view>

#include <support/error.h>

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

}  // namespace snug::command
