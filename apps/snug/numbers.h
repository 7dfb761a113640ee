#pragma once

#include <support/number.h>

#include <algorithm>
#include <array>
#include <optional>
#include <string_view>

namespace snug::command {

/// As many numbers, separated by blanks or commas; nothing if the text is not that.
template <std::size_t count>
[[nodiscard]] std::optional<std::array<double, count>> parse_numbers(std::string_view text) {
  constexpr std::string_view blanks = " ,\t\r\n";
  std::array<double, count> numbers{};
  std::size_t found = 0;
  for (auto begin = text.find_first_not_of(blanks); begin != std::string_view::npos;) {
    const auto end = std::min(text.find_first_of(blanks, begin), text.size());
    const ParsedReal number = parse_real(text.substr(begin, end - begin));
    if (!number.fault.empty() || found == count) return {};
    numbers[found++] = number.value;
    begin = text.find_first_not_of(blanks, end);
  }
  if (found < count) return {};
  return numbers;
}

}  // namespace snug::command
