#pragma once

#include <algorithm>
#include <charconv>
#include <cstddef>
#include <string_view>

namespace snug::command {

/// The next blank-separated word of a line, or an empty one.
inline std::string_view next_word(std::string_view& line) {
  const auto begin = line.find_first_not_of(" \t\r");
  if (begin == std::string_view::npos) return line = {};
  const auto end = std::min(line.find_first_of(" \t\r", begin), line.size());
  const std::string_view word = line.substr(begin, end - begin);
  line.remove_prefix(end);
  return word;
}

/// A whole word as a number.
template <class Number>
bool parse(std::string_view word, Number& number) {
  const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), number);
  return error == std::errc() && end == word.data() + word.size() && !word.empty();
}

/// Calls visit(line, number) for the lines of a text, from 1 on, but for blank ones and those that begin with
/// #.
template <class Visit>
void for_each_line(std::string_view text, Visit&& visit) {
  std::size_t number = 0;
  while (!text.empty()) {
    const auto end = std::min(text.find('\n'), text.size());
    const std::string_view line = text.substr(0, end);
    text.remove_prefix(std::min(end + 1, text.size()));
    ++number;
    std::string_view rest = line;
    const std::string_view first = next_word(rest);
    if (!first.empty() && first.front() != '#') visit(line, number);
  }
}

}  // namespace snug::command
