#pragma once

#include <cstddef>

/// Eight sets against one, on the widest vectors that the processor has; chosen at run time. See tree/blocks.h, which
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
};
/// Cross products of axes are tried only where the others show no gap above `enough`.
void obb_distances(const float* block, const OtherBox& other, float slack, float enough, float* out);
void obb_distances(const float* block, const float point[3], float slack, float* out);

/// Rows: lower and upper of each direction in turn. `length`: upper bounds of the directions' lengths; the first three
/// directions are the coordinate axes.
struct OtherIntervals {
  float lower[13], upper[13];
  float length[13];
};
void dop_distances(const float* block, std::size_t directions, const OtherIntervals& other, float slack,
                   float* out);

}  // namespace snug::kernels
