#include "nearest.h"

#include <algorithm>

namespace snug::command {
namespace {

// Edits between two words, where swapping neighbours is one edit.
std::size_t edits(std::string_view a, std::string_view b) {
  std::vector<std::size_t> before, above(b.size() + 1), row(b.size() + 1);
  for (std::size_t j = 0; j <= b.size(); ++j) above[j] = j;
  for (std::size_t i = 1; i <= a.size(); ++i) {
    row[0] = i;
    for (std::size_t j = 1; j <= b.size(); ++j) {
      row[j] = std::min({above[j] + 1, row[j - 1] + 1, above[j - 1] + (a[i - 1] != b[j - 1])});
      const bool swapped = i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1];
      if (swapped) row[j] = std::min(row[j], before[j - 2] + 1);
    }
    before = above;
    above = row;
  }
  return above[b.size()];
}

}  // namespace

std::optional<std::string> nearest_word(std::string_view word, const std::vector<std::string>& candidates) {
  constexpr std::size_t longest = 40;  // of what anyone mistypes
  if (word.empty() || word.size() > longest) return {};
  std::optional<std::string> nearest;
  std::size_t least = 0;
  for (const std::string& candidate : candidates) {
    const std::size_t count = edits(word, candidate);
    if (3 * count > std::max(word.size(), candidate.size())) continue;
    if (!nearest || count < least) nearest = candidate;
    if (*nearest == candidate) least = count;
  }
  if (nearest) return nearest;
  const auto begun = std::find_if(candidates.begin(), candidates.end(),
                                  [&](const std::string& c) { return c.starts_with(word); });
  if (begun != candidates.end() && word.find_first_not_of('-') != std::string_view::npos) return *begun;
  return {};
}

std::string did_you_mean(std::string_view word, const std::vector<std::string>& candidates) {
  const std::optional<std::string> nearest = nearest_word(word, candidates);
  return nearest ? "; did you mean '" + *nearest + "'?" : "";
}

}  // namespace snug::command
