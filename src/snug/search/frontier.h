#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include <support/ordering.h>

namespace snug {

/// In which order what is open is looked at.
enum class Order : std::uint8_t {
  last_first,     ///< depth first: little memory
  first_first,    ///< breadth first: where a budget ends, what is open is about equally large
  nearest_first,  ///< the least `gap` first: few looks
};

/// What a question has still to look at: nodes, or pairs of them, each with a lower bound `gap` of what is asked for.
template <class Item>
class Frontier {
 public:
  /// Begins anew, with the memory of the last time.
  void start(Order order, const Item& root) {
    start(order);
    items_.push_back(root);
  }
  void start(Order order) {
    order_ = order;
    items_.clear();
    taken_ = 0;
  }
  [[nodiscard]] bool empty() const { return taken_ == items_.size(); }
  [[nodiscard]] std::size_t size() const { return items_.size() - taken_; }
  /// Of the nearest, in its order.
  /// Requires:  not empty; so does take().
  [[nodiscard]] const Item& nearest() const { return items_.front(); }
  Item take() {
    if (order_ == Order::first_first) return take_first();
    if constexpr (has_gap) {
      if (order_ == Order::nearest_first) ordering::pop_heap(items_.data(), items_.size(), farther);
    }
    const Item item = items_.back();
    items_.pop_back();
    return item;
  }
  void add(const Item& item) {
    items_.push_back(item);
    if constexpr (has_gap) {
      if (order_ == Order::nearest_first) ordering::push_heap(items_.data(), items_.size(), farther);
    }
  }
  /// All that is open, the one to be taken next the last; more may be added there.
  /// Requires:  last_first.
  [[nodiscard]] std::vector<Item>& items() { return items_; }
  /// Calls visit(item) for all that is open.
  template <class Visit>
  void for_each(const Visit& visit) const {
    for (std::size_t i = taken_; i < items_.size(); ++i) visit(items_[i]);
  }
  [[nodiscard]] std::size_t bytes() const { return items_.capacity() * sizeof(Item); }

 private:
  static constexpr bool has_gap = requires(const Item& item) { item.gap; };
  static bool farther(const Item& x, const Item& y) { return x.gap > y.gap; }
  Item take_first() {
    const Item item = items_[taken_++];
    // Memory stays within twice of what is open.
    if (2 * taken_ > items_.size()) {
      items_.erase(items_.begin(), items_.begin() + static_cast<std::ptrdiff_t>(taken_));
      taken_ = 0;
    }
    return item;
  }

  Order order_ = Order::last_first;
  std::vector<Item> items_;
  std::size_t taken_ = 0;  // of the first ones
};

/// What becomes of an item that a question has looked at.
enum class Verb : std::uint8_t {
  drop,  ///< all of it is decided
  open,  ///< what it consists of is to be looked at
  stop,  ///< the question is answered, or its budget spent
};

/// Every search of this library: looks at what is open until nothing is, or the question stops.
/// Requires:  Verb question.look_at(item); void question.open(item), which adds to the frontier. Both may look at what is open.
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
