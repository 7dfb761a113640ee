#pragma once

#include <cstdint>
#include <cstdlib>

/// How many random cases a test draws; docs/debugging.md has the variables.
namespace snug::testing {

/// Sanitizers look at what code does and not at numbers; emulators are fifty times slower than processors.
#if defined(SNUG_SANITIZED) || defined(SNUG_EMULATED)
inline constexpr bool slow = true;
#else
inline constexpr bool slow = false;
#endif

/// Where tests are slow, a quarter of the usual cases, rounded up.
[[nodiscard]] constexpr std::uint64_t fewer(std::uint64_t usual) { return slow ? (usual + 3) / 4 : usual; }

/// The same, and else an N-th of them where SNUG_SHARE is N, rounded up: numbers of random cases, and what these must have met.
[[nodiscard]] inline std::uint64_t share(std::uint64_t usual) {
  if constexpr (slow) return fewer(usual);
  static const char* const text = std::getenv("SNUG_SHARE");
  static const std::uint64_t parts = text ? std::strtoull(text, nullptr, 10) : 1;
  return parts > 1 ? (usual + parts - 1) / parts : usual;
}

/// Is case `number` to be tried? All are, but every fifth where tests are slow.
[[nodiscard]] constexpr bool has_turn(std::uint64_t number) { return !slow || number % 5 == 0; }

/// Is this the long check, where SNUG_TIMES is set? It tries all combinations, where the usual one tries all pairs by turns.
[[nodiscard]] inline bool long_check() { return std::getenv("SNUG_TIMES") != nullptr; }

/// The number that the environment gives, or the usual one, SNUG_TIMES times as large if that is set, or a share.
[[nodiscard]] inline std::uint64_t number_of(const char* variable, std::uint64_t usual) {
  if (const char* const text = std::getenv(variable)) return std::strtoull(text, nullptr, 10);
  const char* const times = std::getenv("SNUG_TIMES");
  return times ? usual * std::strtoull(times, nullptr, 10) : share(usual);
}

}  // namespace snug::testing
