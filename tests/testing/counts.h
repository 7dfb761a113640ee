#pragma once

#include <cstdint>
#include <cstdlib>

/// How many random cases a test draws; docs/debugging.md has the variables.
namespace snug::testing {

/// Under sanitizers, which look at what code does and not at numbers, a quarter of the usual cases, rounded up.
[[nodiscard]] constexpr std::uint64_t fewer(std::uint64_t usual) {
#ifdef SNUG_SANITIZED
  return (usual + 3) / 4;
#else
  return usual;
#endif
}

/// The number that the environment gives, or the usual one, SNUG_TIMES times as large if that is set, or fewer.
[[nodiscard]] inline std::uint64_t number_of(const char* variable, std::uint64_t usual) {
  if (const char* const text = std::getenv(variable)) return std::strtoull(text, nullptr, 10);
  const char* const times = std::getenv("SNUG_TIMES");
  return times ? usual * std::strtoull(times, nullptr, 10) : fewer(usual);
}

}  // namespace snug::testing
