#pragma once

#include <cstdint>
#include <vector>

namespace snug {

/// Numbers some of many things in the order in which they are first met. Using it again costs no clearing.
class CompactNumbering {
 public:
  /// Forgets all; indices are below `size`.
  void begin(std::size_t size) {
    if (places_.size() < size) places_.resize(size);
    ++round_;
    count_ = 0;
  }
  /// Number of thing i: count() before the call if it is met for the first time.
  std::uint32_t number(std::size_t i) {
    Place& place = places_[i];
    if (place.round != round_) place = {round_, count_++};
    return place.number;
  }
  [[nodiscard]] std::uint32_t count() const { return count_; }

 private:
  struct Place {
    std::uint64_t round = 0;
    std::uint32_t number = 0;
  };
  std::vector<Place> places_;
  std::uint64_t round_ = 0;
  std::uint32_t count_ = 0;
};

}  // namespace snug
