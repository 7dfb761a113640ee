#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include <snug/bvh/blocks.h>
#include <snug/bvh/dop26.h>

namespace snug {

/// A tree of volumes over items, eight to a block; its leaves are clusters of up to eight items that lie near each other.
/// Knows sets and ids only: what a cluster opens to is its owner's business.
///
/// Guarantee: a node's volume contains those of all clusters below it. Same tree for any number of threads.
/// Cost:      n log n for sorting items by position, one fit a cluster.
class WideBvh {
 public:
  static constexpr std::size_t cluster_size = Blocks::lanes;

  /// Name of a lane: another block, or a cluster with this bit set.
  static constexpr std::uint32_t cluster_bit = 0x80000000u;

  /// `fit` makes the volume of some items; it is called from several threads.
  /// Requires:  at least one item, fewer than 2^31; `centres` finite.
  WideBvh(Volume volume, std::span<const Point3> centres, int threads,
          const std::function<BoundingVolume(std::span<const std::uint32_t>)>& fit);

  [[nodiscard]] const Blocks& blocks() const { return blocks_; }
  /// The root is the one lane of this block.
  [[nodiscard]] Lane root() const { return {static_cast<std::uint32_t>(blocks_.size() - 1), 0}; }
  [[nodiscard]] const Ball& ball() const { return ball_; }
  /// A box around everything.
  [[nodiscard]] const Obb& box() const { return box_; }
  /// A polytope around all clusters' volumes, relative to the box's centre.
  [[nodiscard]] const Dop26& dop() const { return dop_; }
  [[nodiscard]] std::size_t cluster_count() const {
    return (items_.size() + cluster_size - 1) / cluster_size;
  }
  [[nodiscard]] std::span<const std::uint32_t> cluster(std::size_t i) const;
  [[nodiscard]] std::size_t bytes() const;

 private:
  std::vector<std::uint32_t> items_;
  Blocks blocks_;
  Ball ball_;
  Obb box_;
  Dop26 dop_;
};

}  // namespace snug
