#pragma once

#include <algorithm>
#include <cstdint>
#include <numeric>
#include <vector>

namespace snug {

/// The numbers below a count, each in a set of its own until sets are joined.
///
/// Source:    union-find with path halving; the least number of a set stands for it, whatever the order of
///            joining.
class DisjointSets {
 public:
  explicit DisjointSets(std::size_t count) : parent_(count) { std::iota(parent_.begin(), parent_.end(), 0u); }

  /// The least number of the set that i is in.
  std::uint32_t least(std::uint32_t i) {
    while (parent_[i] != i) i = parent_[i] = parent_[parent_[i]];
    return i;
  }
  /// Makes one set of those of i and k; false if they were one.
  bool join(std::uint32_t i, std::uint32_t k) {
    const auto [first, second] = std::minmax({least(i), least(k)});
    parent_[second] = first;
    return first != second;
  }

 private:
  std::vector<std::uint32_t> parent_;
};

}  // namespace snug
