#pragma once

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <span>

namespace snug::kernels {

/// Nodes of a CasterTree that are still to be visited, the nearest last.
class OpenNodes {
 public:
  struct Item {
    std::uint32_t name;
    float enter;
  };
  [[nodiscard]] bool empty() const { return count_ == 0; }
  Item take() { return items_[--count_]; }
  void add(std::uint32_t name, float enter) { items_[count_++] = {name, enter}; }
  // Adds children, sorted.
  void add(std::span<const std::uint32_t> names, std::uint32_t which, std::span<const float> enter) {
    const std::size_t first = count_;
    for (; which != 0; which &= which - 1) {
      const auto i = static_cast<std::size_t>(std::countr_zero(which));
      std::size_t at = count_++;
      for (; at > first && items_[at - 1].enter < enter[i]; --at) items_[at] = items_[at - 1];
      items_[at] = {names[i], enter[i]};
    }
  }

 private:
  std::array<Item, 128> items_;  // a tree of 2^31 leaves has eleven levels
  std::size_t count_ = 0;
};

}  // namespace snug::kernels
