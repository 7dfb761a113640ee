#pragma once

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <span>

namespace snug::kernels {

/// Nodes of a CasterTree that are still to be visited; the next one is the last.
class OpenNodes {
 public:
  struct Item {
    std::uint32_t name;
    float enter;
  };
  [[nodiscard]] bool empty() const { return count_ == 0; }
  Item take() { return items_[--count_]; }
  void add(std::uint32_t name, float enter) { items_[count_++] = {name, enter}; }
  enum class Order : std::uint8_t { nearest_first, farthest_first };
  // Adds children, sorted.
  template <Order order = Order::nearest_first>
  void add(std::span<const std::uint32_t> names, std::uint32_t which, std::span<const float> enter) {
    const std::size_t first = count_;
    for (; which != 0; which &= which - 1) {
      const auto i = static_cast<std::size_t>(std::countr_zero(which));
      std::size_t at = count_++;
      for (; at > first && is_later<order>(enter[i], items_[at - 1].enter); --at) items_[at] = items_[at - 1];
      items_[at] = {names[i], enter[i]};
    }
  }

 private:
  template <Order order>
  static bool is_later(float a, float b) {
    return order == Order::nearest_first ? a > b : a < b;
  }

  std::array<Item, 128> items_;  // a tree of 2^31 leaves has eleven levels
  std::size_t count_ = 0;
};

}  // namespace snug::kernels
