#pragma once

#include <cstdint>
#include <cstdlib>

/// How many random cases a test draws; docs/debugging.md has the variables.
namespace snug::testing {

/// The number that the environment gives, or the usual one, SNUG_TIMES times as large if that is set.
[[nodiscard]] inline std::uint64_t number_of(const char* variable, std::uint64_t usual) {
  if (const char* const text = std::getenv(variable)) return std::strtoull(text, nullptr, 10);
  const char* const times = std::getenv("SNUG_TIMES");
  return times ? usual * std::strtoull(times, nullptr, 10) : usual;
}

}  // namespace snug::testing
