#pragma once

#include <algorithm>
#include <vector>

#include <snug/search/workspace.h>

namespace snug {

/// A node, and a lower bound of how far it is.
struct NodeGap {
  Node node;
  float gap;
};

/// What is still to be opened, by a lower bound `gap` of its distance: the nearest comes first.
template <class Item>
class NearestFirst {
 public:
  /// Begins anew, with memory kept.
  void start(const Item& root) { items_.assign(1, root); }
  [[nodiscard]] bool empty() const { return items_.empty(); }
  /// Requires:  not empty; so does take().
  [[nodiscard]] const Item& nearest() const { return items_.front(); }
  Item take() {
    std::pop_heap(items_.begin(), items_.end(), farther);
    const Item item = items_.back();
    items_.pop_back();
    return item;
  }
  void add(const Item& item) {
    items_.push_back(item);
    std::push_heap(items_.begin(), items_.end(), farther);
  }

 private:
  static bool farther(const Item& x, const Item& y) { return x.gap > y.gap; }
  std::vector<Item> items_;
};

}  // namespace snug
