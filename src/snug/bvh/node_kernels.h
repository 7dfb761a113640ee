#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>

/// Eight boxes against one, on the widest vectors that the processor has; others use bvh/wide_node.h. Every
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
Near obb_distances(const float* node, const float point[3], float slack, float prune_distance, float* out);
/// How far the boxes reach along a direction.
void obb_extents(const float* node, float reach, const float direction[3], float* out);

/// How boxes of another frame are seen: x -> columns x, which makes lengths `scale`, a power of two, times as
/// large.
struct Turn {
  alignas(16) float columns[3][4];
  float scale, inverse_scale;
  /// A direction from the node's boxes to the other one, of length at most 1, or zero: the node's and the
  /// other's coordinates of it.
  float direction[3], other_direction[3];
};
/// A box of another node there.
struct SeenBox {
  const float* rows;  ///< its column in the other node's rows
  float reach;        ///< of the other node
  float offset[3];    ///< of the other node's origin from this one's, here
};
/// Names of children: another node, or a leaf with this bit set.
inline constexpr std::uint32_t leaf_bit = 0x80000000u;
/// The boxes of a node, the point they are relative to, and what they are called in a tree, or by the owner of its leaves.
struct alignas(64) NodeBoxes {
  float rows[obb_rows * node_width] = {};
  float sizes[node_width] = {};
  std::array<std::uint32_t, node_width> names{};
  double reference[3] = {};
  float reach = 0;  ///< of the largest, as in obb_distances()
  std::uint32_t box_count = 0;
};
static_assert(sizeof(NodeBoxes) == 576);
/// Which gaps are looked for: across fifteen axes, or along the line of the centres and Turn::direction,
/// which are sharper for boxes that are far apart.
enum class Gaps : std::uint8_t { axes, lines };
/// The same for such a box.
Near obb_distances(const float* node, float reach, const SeenBox& other, const Turn& turn, float slack,
                   float prune_distance, Gaps which, float* out);

}  // namespace snug::kernels
