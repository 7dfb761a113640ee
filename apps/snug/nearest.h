#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace snug::command {

/// The candidate that a mistyped word most likely means: the one with the fewest letters to insert, delete,
/// replace or swap with a neighbour, at most one in three of the longer word's; or one that the word begins.
/// The first of several.
[[nodiscard]] std::optional<std::string> nearest_word(std::string_view word,
                                                      const std::vector<std::string>& candidates);

/// "; did you mean 'X'?", or nothing if no candidate is near.
[[nodiscard]] std::string did_you_mean(std::string_view word, const std::vector<std::string>& candidates);

}  // namespace snug::command
