#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include <snug/bvh/dop26.h>
#include <snug/bvh/wide_nodes.h>

namespace snug {

/// A tree of oriented boxes over items, eight children a node; its leaves are up to eight items that lie near
/// each other. Knows boxes and numbers only: what a leaf opens to is its owner's business.
/// Guarantee: a child's box contains those of all leaves below it. Same tree for any number of threads.
class WideBvh {
 public:
  static constexpr std::size_t leaf_size = WideNodes::width;
  /// Name of a child: another node, or a leaf with this bit set.
  static constexpr std::uint32_t leaf_bit = 0x80000000u;

  /// `fit` makes the box of some items; it is called from several threads.
  /// Requires:  at least one item, fewer than 2^31; `centres` finite.
  WideBvh(std::span<const Point3> centres, int threads,
          const std::function<Obb(std::span<const std::uint32_t>)>& fit);

  [[nodiscard]] const WideNodes& nodes() const { return nodes_; }
  /// The root is the one child of this node.
  [[nodiscard]] Child root() const { return {static_cast<std::uint32_t>(nodes_.size() - 1), 0}; }
  [[nodiscard]] Ball ball() const { return ball_around(box_); }
  /// A box around everything.
  [[nodiscard]] const Obb& box() const { return box_; }
  /// A k-DOP around all leaves' boxes, relative to the centre of box().
  [[nodiscard]] const Dop26& dop() const { return dop_; }
  [[nodiscard]] std::size_t leaf_count() const { return (items_.size() + leaf_size - 1) / leaf_size; }
  [[nodiscard]] std::span<const std::uint32_t> leaf(std::size_t i) const;
  [[nodiscard]] std::size_t bytes() const;

 private:
  std::vector<std::uint32_t> items_;
  WideNodes nodes_;
  Obb box_;
  Dop26 dop_;
};

}  // namespace snug
