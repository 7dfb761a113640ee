#include "length.h"

#include <array>
#include <charconv>
#include <cmath>
#include <string_view>

#include <support/error.h>
#include <support/number.h>

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

struct UnitName {
  std::string_view word, unit;
  double metres;
};
// Longer words before those that they end with; the first of a unit is the one that is written.
constexpr std::array<UnitName, 9> unit_names{{{"micron", "micron", 1e-6},
                                              {"um", "micron", 1e-6},
                                              {"mm", "mm", 1e-3},
                                              {"cm", "cm", 1e-2},
                                              {"inch", "inch", 0.0254},
                                              {"in", "inch", 0.0254},
                                              {"foot", "foot", 0.3048},
                                              {"ft", "foot", 0.3048},
                                              {"m", "m", 1}}};

}  // namespace

std::vector<std::string> unit_words() {
  std::vector<std::string> words;
  for (const UnitName& known : unit_names) {
    if (known.word == known.unit) words.emplace_back(known.word);
  }
  return words;
}

double metres_of(const std::string& unit) {
  for (const UnitName& known : unit_names) {
    if (known.unit == unit) return known.metres;
  }
  return 1;
}

std::optional<std::string> unit_of(double metres) {
  for (const UnitName& known : unit_names) {
    if (known.metres == metres) return std::string(known.unit);
  }
  return {};
}

std::string text_of_unit(double metres) {
  std::string text = "units of ";
  append_real(text, metres);
  return unit_of(metres).value_or(text + " m");
}

double Length::in_mesh_units(double size, std::optional<double> metres_per_unit) const {
  if (!unit.empty() && !metres_per_unit) {
    throw UsageError(
        "a length in " + unit +
        " needs a mesh whose units are known: give --units, or the length in mesh units or percent of the "
        "size (1%)");
  }
  const bool same = unit.empty() || metres_of(unit) == *metres_per_unit;
  const double in_own = same ? number : number * metres_of(unit) / *metres_per_unit;
  const double result = percent ? number / 100 * size : in_own;
  if (!std::isfinite(result) || (number > 0 && !(result > 0))) {
    throw InputError(
        InputProblem::refused,
        "a length in percent or with a unit does not fit a double for this mesh: give it in mesh units");
  }
  return result;
}

Length parse_length(const std::string& text, const std::string& option, bool zero_allowed) {
  Length length;
  std::string_view digits = trimmed(text);
  if (digits.ends_with('%')) {
    length.percent = true;
    digits = trimmed(digits.substr(0, digits.size() - 1));
  } else {
    for (const UnitName& known : unit_names) {
      if (!digits.ends_with(known.word)) continue;
      length.unit = known.unit;
      digits = trimmed(digits.substr(0, digits.size() - known.word.size()));
      break;
    }
  }
  if (!parse_number(digits, length.number) || length.number < 0 || (length.number == 0 && !zero_allowed)) {
    throw UsageError(option + ": '" + text + "' is not a " + (zero_allowed ? "length" : "positive length") +
                     "; give mesh units (0.01), percent of the size (1%), or a length with a unit (0.1mm)");
  }
  return length;
}

}  // namespace snug::command
