#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <optional>
#include <utility>

namespace snug {

/// The last n values that were made, each under its key. Not thread-safe.
/// Requires:  equal keys make equal values, so that nothing depends on which of them are still here.
template <class Key, class Value, std::size_t n>
class RecentValues {
 public:
  /// The value of `key`, made where it is not here; stays until n others are. If `make` throws: no change.
  template <class Make>
  [[nodiscard]] const Value& get(const Key& key, Make&& make) {
    const auto found = std::find_if(entries_.begin(), entries_.end(),
                                    [&](const auto& entry) { return entry && entry->first == key; });
    if (found != entries_.end()) return (*found)->second;
    Value fresh = make();
    auto& oldest = entries_[next_];
    next_ = (next_ + 1) % n;
    return oldest.emplace(key, std::move(fresh)).second;
  }

 private:
  std::array<std::optional<std::pair<Key, Value>>, n> entries_;
  std::size_t next_ = 0;
};

}  // namespace snug
