#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include <support/contract.h>
#include <support/ordering.h>

namespace snug {

/// In which order what is open is looked at.
enum class Order : std::uint8_t {
  last_first,     ///< depth first: little memory
  first_first,    ///< breadth first: where a budget ends, what is open is about equally large
  nearest_first,  ///< the least `gap` first: few looks
};

/// Work that is left of a question: nodes, or pairs of them, each with a lower bound `gap` of what is asked for.
template <class Item>
class Frontier {
 public:
  /// Begins anew, with the memory of the last time.
  /// Requires:  items with a gap for nearest_first.
  void start(Order order) {
    SNUG_EXPECT(has_gap || order != Order::nearest_first);
    order_ = order;
    first_ = end_ = 0;
  }
  void start(Order order, const Item& root) {
    start(order);
    add(root);
  }
  [[nodiscard]] bool empty() const { return first_ == end_; }
  [[nodiscard]] std::size_t size() const { return end_ - first_; }
  /// Requires:  not empty.
  Item take() {
    if (order_ == Order::first_first) return items_[first_++];
    if constexpr (has_gap) {
      if (order_ == Order::nearest_first) ordering::pop_heap(items_.data(), end_, farther);
    }
    return items_[--end_];
  }
  [[gnu::always_inline]] void add(Item item) {
    if (end_ == items_.size()) make_room();
    items_[end_++] = item;
    if (order_ == Order::nearest_first) raise_last();
  }
  /// All that is open, in the order in which it was added but for nearest_first. With last_first it may be sorted.
  [[nodiscard]] std::span<Item> items() { return std::span(items_).subspan(first_, size()); }
  [[nodiscard]] std::size_t bytes() const { return items_.capacity() * sizeof(Item); }

 private:
  static constexpr bool has_gap = requires(const Item& item) { item.gap; };
  static bool farther(const Item& x, const Item& y) { return x.gap > y.gap; }
  // Apart from add(), which hot loops call.
  [[gnu::noinline]] void raise_last() {
    if constexpr (has_gap) ordering::push_heap(items_.data(), end_, farther);
  }
  [[gnu::noinline]] void make_room() {
    // Items that were taken make room once they are half of all.
    if (first_ > 0 && 2 * first_ >= end_) {
      std::copy(items_.begin() + static_cast<std::ptrdiff_t>(first_), items_.end(), items_.begin());
      end_ -= first_;
      first_ = 0;
    } else {
      items_.resize(2 * items_.size() + 16);
    }
  }

  Order order_ = Order::last_first;
  std::vector<Item> items_;  // from first_ to before end_
  std::size_t first_ = 0, end_ = 0;
};

/// Decisions about an item that a question has looked at.
enum class Verb : std::uint8_t {
  drop,  ///< all of it is decided
  open,  ///< what it consists of is to be looked at
  stop,  ///< the question is answered, or its budget spent
};

/// The loop of a search: looks at what is open until nothing is, or the question stops.
/// Requires:  Verb question.look_at(item) and void question.open(item). Either may add to the frontier.
template <class Item, class Question>
void search(Frontier<Item>& frontier, Question& question) {
  while (!frontier.empty()) {
    const Item item = frontier.take();
    const Verb verb = question.look_at(item);
    if (verb == Verb::stop) return;
    if (verb == Verb::open) question.open(item);
  }
}

}  // namespace snug
