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

/// The number that the environment gives, or SNUG_TIMES times the full one if that is set, or half of the full one, or fewer.
[[nodiscard]] inline std::uint64_t number_of(const char* variable, std::uint64_t full) {
  if (const char* const text = std::getenv(variable)) return std::strtoull(text, nullptr, 10);
  const char* const times = std::getenv("SNUG_TIMES");
  return times ? full * std::strtoull(times, nullptr, 10) : fewer((full + 1) / 2);
}

}  // namespace snug::testing
