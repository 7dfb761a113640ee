#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>

/// Eight sets against one, on the widest vectors that the processor has; chosen at run time. See bvh/blocks.h, which
/// is what others use.
///
/// Guarantee: every lane does the same operations in the same order on every instruction set, none of them fused.
namespace snug::kernels {

/// Rows of eight numbers: centre, half sizes, three axes.
inline constexpr std::size_t obb_rows = 15;

/// Another box, relative to the block's origin.
struct OtherBox {
  float centre[3];
  float half[3];
  float axes[3][3];
  [[nodiscard]] float reach() const {
    return std::fabs(centre[0]) + std::fabs(centre[1]) + std::fabs(centre[2]) + (half[0] + half[1] + half[2]);
  }
};
/// Which lanes have a distance of at most `enough`, a bit each, and the least of the others; infinite if there are none.
struct Near {
  std::uint32_t lanes;
  float others;
};
/// `reach`: at least the sum of a box's half sizes and the absolute coordinates of its centre. Cross products of axes are
/// tried only where the others show no gap above `enough`.
Near obb_distances(const float* block, float reach, const OtherBox& other, float slack, float enough,
                   float* out);
void obb_distances(const float* block, const float point[3], float slack, float* out);

/// A block of boxes and what else is known of it.
struct BoxBlock {
  const float* rows;
  const float* sizes;  ///< upper bounds of the boxes' diagonals
  std::uint32_t count;
  float reach;
};
/// How another block's coordinates are seen from a block: x -> rows x + offset, which makes lengths `scale`, a power of two,
/// times as large.
struct SeenBlock {
  float rows[3][3];
  float offset[3];
  float scale;
  /// A direction to try first, from the block's sets to the other one's: of length at most 1, or zero. The same for the other
  /// block: its product with `rows`.
  float direction[3];
  float other_direction[3];
};
/// Two lanes, and a lower bound of their distance as above.
struct LanePair {
  std::uint8_t own, other;
  float gap;
};
/// Compares all boxes of two blocks; `out` gets the pairs with at most `enough`, of which there may be 64.
/// Returns:   how many there are, and the least gap of the others.
Near obb_pairs(const BoxBlock& block, const BoxBlock& other, const SeenBlock& seen, float slack, float enough,
               LanePair* out);

/// Rows: lower and upper of each direction in turn. `length`: upper bounds of the directions' lengths; the first three
/// directions are the coordinate axes.
struct OtherIntervals {
  float lower[13], upper[13];
  float length[13];
};
Near dop_distances(const float* block, std::size_t directions, const OtherIntervals& other, float slack,
                   float enough, float* out);

}  // namespace snug::kernels
