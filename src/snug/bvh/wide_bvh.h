#pragma once

#include <atomic>
#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <vector>

#include <snug/bvh/dop26.h>
#include <snug/bvh/wide_node.h>
#include <snug/run.h>

namespace snug {

/// A tree of oriented boxes over items, eight children a node; its leaves are up to eight items that lie near
/// each other. Knows boxes and numbers only: what a leaf opens to is its owner's business. Made at once, or
/// where node() first comes; may be read by many threads.
/// Guarantee: each box contains the items of all leaves below it. Same tree for any number of threads.
class WideBvh {
 public:
  static constexpr std::size_t leaf_size = WideNode::width;
  /// Name of a child: another node, or a leaf with this bit set.
  static constexpr std::uint32_t leaf_bit = kernels::leaf_bit;

  /// Makes the boxes that together hold the items of a leaf: one, or one an item.
  using Fit =
      std::function<void(std::size_t leaf, std::span<const std::uint32_t> items, std::vector<Obb>& boxes)>;
  /// A whole tree. `fit` is called from several threads. All boxes above are fitted to what it makes.
  /// Requires:  at least one item, fewer than 2^31; `centres` finite.
  WideBvh(std::span<const Point3> centres, int threads, const Fit& fit);

  /// The same of sets that are known, which lie together so that number times surface of the boxes above them is small. All
  /// boxes are fitted to the sets below them.
  /// Requires:  at least one set, fewer than 2^31.
  /// Cost:      about half a microsecond a set.
  explicit WideBvh(std::span<const FittedSet> sets, const WorkMonitor& monitor = {});

  /// A tree made where queries come: from balls around the items down to subtrees of `part_level` levels, 512
  /// items, which are fitted to their leaves as above. `fit` is kept.
  /// Requires:  the same of the balls' centres; radii finite; part_level >= 1.
  /// Cost:      about 0.05 microseconds an item at once, 0.6 an item of a part.
  WideBvh(std::span<const Ball> items, Fit fit, unsigned part_level = 2);

  /// Which items lie together, and no boxes yet: refit() makes them.
  /// Requires:  as for a whole tree.
  [[nodiscard]] static WideBvh in_order(std::span<const Point3> centres, int threads);
  /// The same order, without boxes.
  [[nodiscard]] static WideBvh in_order_of(const WideBvh& other);
  /// Makes all boxes anew, around these boxes of the leaves, along given axes: one triple for each node by
  /// its name, for the box around all of it. Without axes they are chosen as for a whole tree. Memory is
  /// taken the first time only. Not while others read.
  /// Guarantee: that of a new tree. Axes need only be orthonormal up to a few roundings.
  /// Requires:  made by in_order() or in_order_of(); leaf_count() boxes; node_count() axes or none.
  void refit(std::span<const Obb> leaves, std::span<const Axes> axes = {});
  [[nodiscard]] std::size_t node_count() const { return nodes_.size(); }
  /// Boxes made by refit(): one around all of each node, by name.
  [[nodiscard]] std::span<const Obb> node_boxes() const { return node_boxes_; }
  /// The leaves below a node: from `begin` to before `end`.
  struct LeafRange {
    std::size_t begin, end;
  };
  [[nodiscard]] LeafRange leaves_of(std::uint32_t name) const;

  WideBvh(WideBvh&&) noexcept;
  WideBvh& operator=(WideBvh&&) noexcept;
  ~WideBvh();

  /// All items lie in the convex hull of these points, too: what is known of all of them together, root(), ball(),
  /// box() and dop(), is narrowed to it. Not while others read.
  /// Requires:  that of Dop26::narrow().
  /// Cost:      some 20 ns a point.
  void narrow(std::span<const Point3> hull);

  /// The root is the one box of this node.
  [[nodiscard]] const WideNode& root() const { return root_; }
  /// A child that a node names.
  [[nodiscard]] const WideNode& node(std::uint32_t name) const {
    if (!made_[name].load(std::memory_order_acquire)) make(name);
    return nodes_[name];
  }
  /// Its nodes for a walk, without leaves.
  [[nodiscard]] kernels::WalkedTree walked() const {
    kernels::WalkedTree tree;
    tree.nodes = nodes_.data();
    tree.made = made_.data();
    return tree;
  }
  /// A ball around everything.
  [[nodiscard]] const Ball& ball() const { return ball_; }
  /// A box around everything.
  [[nodiscard]] const Obb& box() const { return box_; }
  /// A k-DOP around everything.
  [[nodiscard]] const Dop26& dop() const { return dop_; }
  [[nodiscard]] std::size_t leaf_count() const { return (items_.size() + leaf_size - 1) / leaf_size; }
  /// The items of a leaf that a node names.
  [[nodiscard]] std::span<const std::uint32_t> leaf(std::size_t i) const;
  [[nodiscard]] std::size_t bytes() const;

 private:
  class Builder;
  struct Item;
  struct Unmade;
  // Nodes lie level by level. Leaves are level 0; below node i of level l are those from i 8^l on.
  struct Subtree {
    unsigned level;
    std::size_t number;
  };
  struct Fitted {
    std::vector<Obb> leaves, below;  // a box a leaf, and all that fit() made
  };
  explicit WideBvh(std::size_t item_count);
  [[nodiscard]] static std::vector<Item> items_at(std::span<const Point3> centres);
  [[nodiscard]] Subtree whole() const { return {static_cast<unsigned>(begins_.size() - 1), 0}; }
  [[nodiscard]] Subtree subtree(std::uint32_t name) const;
  [[nodiscard]] std::uint32_t name_of(Subtree of) const;
  [[nodiscard]] std::size_t leaves_below(Subtree of) const;
  [[nodiscard]] std::span<Item> items_below(Subtree of, std::span<Item> all) const;
  void sort(Subtree of, std::span<Item> all, int threads) const;
  Fitted fit_upwards(Subtree of, int threads, const Fit& fit) const;
  std::vector<Obb> open(Subtree of) const;
  void make(std::uint32_t name) const;
  void keep(Subtree of, std::span<const Obb> boxes) const;
  void finish(const Obb& box, const Ball& ball, std::span<const Obb> parts);
  void set_root();
  void finish_refit(std::span<const Obb> leaves);

  std::uint32_t whole_ = 0;            // name of all
  std::vector<std::uint32_t> begins_;  // name of the first node of each level; of leaves 0
  // Written before `made_` is set.
  mutable std::vector<std::uint32_t> items_;
  mutable std::vector<WideNode> nodes_;
  mutable std::vector<std::atomic<bool>> made_;
  std::vector<Obb> node_boxes_;  // of trees that are refitted
  std::unique_ptr<Unmade> unmade_;
  WideNode root_;
  Obb box_;
  Ball ball_;
  Dop26 dop_;
};

}  // namespace snug
