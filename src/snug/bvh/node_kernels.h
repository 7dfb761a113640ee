#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>

/// Eight boxes against one, on the widest vectors that the processor has; others use bvh/wide_nodes.h. Every
/// lane does the same operations in the same order on every instruction set, none of them fused.
namespace snug::kernels {

/// Boxes of a node.
inline constexpr std::size_t node_width = 8;
/// Rows of eight numbers: centre, half sizes, three axes.
inline constexpr std::size_t obb_rows = 15;

/// Another box, relative to the node's origin.
struct OtherBox {
  float centre[3];
  float half[3];
  float axes[3][3];
  [[nodiscard]] float reach() const {
    return std::fabs(centre[0]) + std::fabs(centre[1]) + std::fabs(centre[2]) + (half[0] + half[1] + half[2]);
  }
};
/// The boxes within `prune_distance`, a bit each, and the least distance of the others; infinite without any.
struct Near {
  std::uint32_t places;
  float others;
};
/// `reach`: at least the sum of a box's half sizes and the absolute coordinates of its centre.
Near obb_distances(const float* node, float reach, const OtherBox& other, float slack, float prune_distance,
                   float* out);
void obb_distances(const float* node, const float point[3], float slack, float* out);

/// A node of boxes and what else is known of it.
struct BoxNode {
  const float* rows;
  const float* sizes;  ///< upper bounds of the boxes' diagonals
  std::uint32_t count;
  float reach;
};
/// How another node is seen: x -> rows x + offset, which makes lengths `scale`, a power of two, times as
/// large.
struct SeenNode {
  float rows[3][3];
  float offset[3];
  float scale;
  /// A direction to try first, from the node's boxes to the other one's: of length at most 1, or zero. The
  /// same for the other node: its product with `rows`.
  float direction[3];
  float other_direction[3];
};
/// A box of each of two nodes, and a lower bound of their distance as above.
struct ChildPair {
  std::uint8_t own, other;
  float gap;
};
/// The pairs within `prune_distance`, and the least distance of the others; infinite without any.
struct NearPairs {
  std::array<ChildPair, node_width * node_width> pairs;
  std::size_t count = 0;
  float others = INFINITY;
};
/// Compares all boxes of two nodes.
void obb_pairs(const BoxNode& node, const BoxNode& other, const SeenNode& seen, float slack,
               float prune_distance, NearPairs& near);

}  // namespace snug::kernels
