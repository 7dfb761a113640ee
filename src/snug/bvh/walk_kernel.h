#pragma once

#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>

#include <snug/bvh/node_kernels.h>

/// The walk down two trees at once, compiled once for each instruction set like the comparisons of node_kernels.h. Others use
/// search/near_pairs.h.
namespace snug::kernels {

/// How another tree is seen: x -> columns x + translation, in single precision; lengths become `scale` times as large.
struct TreeView {
  alignas(16) float columns[3][4];
  alignas(16) float translation[4];
  float scale, inverse_scale;
  float slack;  ///< taken off from gaps, besides what roundings do to them
  float reach;  ///< of the translation: the sum of its sizes
};
/// The most that roundings of a walk change a gap by, as a part of all that is involved.
inline constexpr float walk_roundings = 80 * 0x1p-24F;

/// A tree that is walked down.
struct WalkedTree {
  const NodeBoxes* nodes = nullptr;                 ///< by name
  const std::atomic<bool>* made = nullptr;          ///< of them
  const std::atomic<NodeBoxes*>* leaves = nullptr;  ///< by number; null where not made
  TreeView view{};                                  ///< of the other tree
  float distance = 0;  ///< boxes farther apart than this are passed over, in its own units
  float to_query = 1;  ///< the query's units, rounded down, over its own
};
/// A box of a node: its place, and the number of the leaf if it is a patch.
struct WalkedBox {
  static constexpr std::uint32_t not_patch = UINT32_MAX;
  const NodeBoxes* boxes;
  std::uint32_t place;
  std::uint32_t leaf;
  [[nodiscard]] bool is_patch() const { return leaf != not_patch; }
};
/// A box of either tree.
using WalkedPair = std::array<WalkedBox, 2>;

/// Where a walk is: a pair at hand, and others that wait.
struct Walk {
  std::array<WalkedTree, 2> trees;
  WalkedPair at_hand;
  bool has_pair = false;  ///< else at_hand is to be taken from the others
  WalkedPair* waiting = nullptr;
  std::size_t waiting_count = 0, capacity = 0;  ///< room for node_width pairs at least
  float others = INFINITY;  ///< least gap of boxes that were passed over, in the query's units
  std::uint64_t box_tests = 0;
  /// Why it halted.
  enum class Halt : std::uint8_t {
    end,       ///< nothing is left
    patches,   ///< at_hand are two patches
    not_made,  ///< the node or leaf `name` of tree `side` is to be made
    full,      ///< `waiting` is to be made larger
  };
  std::size_t side = 0;    ///< of what is not made
  std::uint32_t name = 0;  ///< likewise
};
/// Goes on with a walk until it halts: depth first, what overlaps most deeply first, the larger box of a pair opened first.
Walk::Halt go_on(Walk& walk);

}  // namespace snug::kernels
