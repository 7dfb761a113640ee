#pragma once

#include <array>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace snug {

/// An enumerator and its name in files, on the command line and in answers. The names of an enumeration stand
/// in one table, std::to_array<Named<E>>({...}); a second name of a value is read, and never written.
template <class E>
struct Named {
  const char* name;
  E value;
};

/// The name of an enumerator; empty for a value that is none.
template <class E, std::size_t n>
[[nodiscard]] constexpr const char* name_in(const std::array<Named<E>, n>& table, E value) {
  for (const Named<E>& each : table) {
    if (each.value == value) return each.name;
  }
  return "";
}

/// The enumerator of this name; nothing if there is none.
template <class E, std::size_t n>
[[nodiscard]] constexpr std::optional<E> value_in(const std::array<Named<E>, n>& table,
                                                  std::string_view name) {
  for (const Named<E>& each : table) {
    if (each.name == name) return each.value;
  }
  return std::nullopt;
}

/// All names, in the order of the table.
template <class E, std::size_t n>
[[nodiscard]] std::vector<std::string> all_names(const std::array<Named<E>, n>& table) {
  std::vector<std::string> names;
  for (const Named<E>& each : table) names.emplace_back(each.name);
  return names;
}

/// "a, b and c", with this conjunction.
[[nodiscard]] inline std::string listed(const std::vector<std::string>& words, const char* conjunction) {
  std::string text;
  for (std::size_t i = 0; i < words.size(); ++i) {
    if (i > 0) text += i + 1 < words.size() ? ", " : " " + std::string(conjunction) + " ";
    text += words[i];
  }
  return text;
}

}  // namespace snug
