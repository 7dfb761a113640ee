#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include <snug/bvh/dop26.h>
#include <snug/bvh/wide_node.h>

namespace snug {

/// A node of a tree, and what its boxes are called there.
struct alignas(64) TreeNode : WideNode {
  TreeNode() = default;
  TreeNode(std::span<const Obb> boxes, std::span<const std::uint32_t> of_boxes);
  std::array<std::uint32_t, width> names{};
};

/// A tree of oriented boxes over items, eight children a node; its leaves are up to eight items that lie near
/// each other. Knows boxes and numbers only: what a leaf opens to is its owner's business.
/// Guarantee: each box contains the items of all leaves below it. Same tree for any number of threads.
class WideBvh {
 public:
  static constexpr std::size_t leaf_size = WideNode::width;
  /// Name of a child: another node, or a leaf with this bit set.
  static constexpr std::uint32_t leaf_bit = 0x80000000u;

  /// Makes the boxes that together hold the items of a leaf: one, or one an item.
  using Fit =
      std::function<void(std::size_t leaf, std::span<const std::uint32_t> items, std::vector<Obb>& boxes)>;
  /// `fit` is called from several threads. All boxes above are fitted to what it makes.
  /// Requires:  at least one item, fewer than 2^31; `centres` finite.
  WideBvh(std::span<const Point3> centres, int threads, const Fit& fit);

  /// The root is the one box of this node.
  [[nodiscard]] const TreeNode& root() const { return nodes_.back(); }
  [[nodiscard]] const TreeNode& node(std::uint32_t name) const { return nodes_[name]; }
  /// A ball around everything.
  [[nodiscard]] const Ball& ball() const { return ball_; }
  /// A box around everything.
  [[nodiscard]] const Obb& box() const { return box_; }
  /// A k-DOP around all leaves' boxes, relative to the centre of box().
  [[nodiscard]] const Dop26& dop() const { return dop_; }
  [[nodiscard]] std::size_t leaf_count() const { return (items_.size() + leaf_size - 1) / leaf_size; }
  [[nodiscard]] std::span<const std::uint32_t> leaf(std::size_t i) const;
  [[nodiscard]] std::size_t bytes() const;

 private:
  std::vector<std::uint32_t> items_;
  std::vector<TreeNode> nodes_;
  Obb box_;
  Ball ball_;
  Dop26 dop_;
};

}  // namespace snug
