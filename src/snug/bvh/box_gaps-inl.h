// Gaps of eight boxes from another one, for kernels of nodes: read again for each instruction set, no #pragma once, after
// snug/geometry/vector_code-inl.h.
#include <algorithm>
#include <cmath>

#include <snug/bvh/node_kernels.h>

#if defined(SNUG_BVH_BOX_GAPS_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef SNUG_BVH_BOX_GAPS_INL_H
#undef SNUG_BVH_BOX_GAPS_INL_H
#else
#define SNUG_BVH_BOX_GAPS_INL_H
#endif

HWY_BEFORE_NAMESPACE();
namespace snug::kernels::HWY_NAMESPACE {

using Tag = hn::CappedTag<float, 8>;
using V = hn::Vec<Tag>;

template <class D>
HWY_INLINE V dot3(D d, const V* a, const float* b) {
  return hn::Add(hn::Add(hn::Mul(a[0], hn::Set(d, b[0])), hn::Mul(a[1], hn::Set(d, b[1]))),
                 hn::Mul(a[2], hn::Set(d, b[2])));
}

HWY_INLINE V sum3(V a, V b, V c) { return hn::Add(hn::Add(a, b), c); }
HWY_INLINE V max3(V a, V b, V c) { return hn::Max(hn::Max(a, b), c); }

// Squares of shorter lengths lose digits to the end of single precision, or all of them.
constexpr float min_squared = 0x1p-50F;

// Length of the vector of the positive ones of three gaps, or the largest if there are none or squares are
// too small; of two sorts of gaps, by the better one.
HWY_INLINE V outside(const V* one, const V* two) {
  const Tag d;
  const V zero = hn::Zero(d);
  const auto square = [&](V x) {
    const V positive = hn::Max(x, zero);
    return hn::Mul(positive, positive);
  };
  const V largest = hn::Max(max3(one[0], one[1], one[2]), max3(two[0], two[1], two[2]));
  const V length_sq = hn::Max(sum3(square(one[0]), square(one[1]), square(one[2])),
                              sum3(square(two[0]), square(two[1]), square(two[2])));
  const V length = hn::Mul(hn::Sqrt(length_sq), hn::Set(d, 1 - 16 * 0x1p-24F));
  return hn::IfThenElse(hn::Gt(largest, hn::Set(d, min_squared)), length, largest);
}

// Minus infinity for what is not a number, or too large to be one of ours.
HWY_INLINE V computed(V gap) {
  const Tag d;
  return hn::IfThenElse(hn::Lt(gap, hn::Set(d, 1e30F)), gap, hn::Set(d, -INFINITY));
}

// The lanes from `at` on, and what they add to `near`.
HWY_INLINE void store(V gap, float prune_distance, std::size_t at, float* out, Near& near) {
  const Tag d;
  gap = computed(gap);
  hn::StoreU(gap, d, out + at);
  const auto beyond = hn::Gt(gap, hn::Set(d, prune_distance));
  near.places |= bits(d, hn::Not(beyond)) << at;
  near.others = std::min(near.others,
                         hn::GetLane(hn::MinOfLanes(d, hn::IfThenElse(beyond, gap, hn::Set(d, INFINITY)))));
}

// Gaps of the lanes from `at` on. `other`: a row of the other boxes, as in a node.
template <bool euclidean, class Row>
HWY_INLINE V gaps(const float* node, std::size_t at, const Row& other, V all_slack, float prune_distance) {
  const Tag d;
  const V zero = hn::Zero(d);
  const auto row = [&](std::size_t r) { return hn::LoadU(d, node + 8 * r + at); };
  const auto along_axis = [&](const V* v, std::size_t j) {
    return sum3(hn::Mul(v[0], other(6 + 3 * j)), hn::Mul(v[1], other(7 + 3 * j)),
                hn::Mul(v[2], other(8 + 3 * j)));
  };
  V delta[3], half[3];
  V t[3], c[3][3];  // of the offset along the node's axes; cosines
  V own[3], others[3];
  for (std::size_t k = 0; k < 3; ++k) {
    delta[k] = hn::Sub(other(k), row(k));
    others[k] = other(3 + k);
  }
  // An axis of the node at a time, so that all fits the registers.
  for (std::size_t i = 0; i < 3; ++i) {
    const V axis[3] = {row(6 + 3 * i), row(7 + 3 * i), row(8 + 3 * i)};
    half[i] = row(3 + i);
    t[i] = sum3(hn::Mul(axis[0], delta[0]), hn::Mul(axis[1], delta[1]), hn::Mul(axis[2], delta[2]));
    V far = half[i];
    for (std::size_t j = 0; j < 3; ++j) {
      c[i][j] = along_axis(axis, j);
      const V m = hn::Abs(c[i][j]);
      far = hn::Add(far, hn::Mul(other(3 + j), m));
      others[j] = hn::Add(others[j], hn::Mul(half[i], m));
    }
    own[i] = hn::Sub(hn::Sub(hn::Abs(t[i]), far), all_slack);
  }
  V along_other[3];
  for (std::size_t j = 0; j < 3; ++j) {
    along_other[j] = hn::Abs(along_axis(delta, j));
    others[j] = hn::Sub(hn::Sub(along_other[j], others[j]), all_slack);
  }
  V gap = hn::Max(max3(own[0], own[1], own[2]), max3(others[0], others[1], others[2]));
  if constexpr (euclidean) {
    // Along the line of the centres: what both boxes take of it, times its length.
    const V between_sq =
        sum3(hn::Mul(delta[0], delta[0]), hn::Mul(delta[1], delta[1]), hn::Mul(delta[2], delta[2]));
    V taken = sum3(hn::Mul(half[0], hn::Abs(t[0])), hn::Mul(half[1], hn::Abs(t[1])),
                   hn::Mul(half[2], hn::Abs(t[2])));
    for (std::size_t j = 0; j < 3; ++j) taken = hn::Add(taken, hn::Mul(other(3 + j), along_other[j]));
    gap = outside(own, others);
    const V central = hn::Sub(hn::Div(hn::Sub(between_sq, taken), hn::Sqrt(between_sq)), all_slack);
    const auto apart =
        hn::And(hn::Gt(central, zero), hn::Gt(between_sq, hn::Set(d, min_squared * min_squared)));
    gap = hn::IfThenElse(apart, hn::Max(gap, central), gap);
  }
  // Lane by lane, so that it makes no difference how many a vector has.
  const auto pruned = hn::Gt(gap, hn::Set(d, prune_distance));
  if (!hn::AllTrue(d, pruned)) {
    // Cross products of axes are at most 1 long: overlaps along short ones say little, so only gaps count.
    V across = all_slack;
    for (std::size_t i = 0; i < 3; ++i) {
      const std::size_t i1 = (i + 1) % 3, i2 = (i + 2) % 3;
      for (std::size_t j = 0; j < 3; ++j) {
        const std::size_t j1 = (j + 1) % 3, j2 = (j + 2) % 3;
        const V along = hn::Abs(hn::Sub(hn::Mul(t[i2], c[i1][j]), hn::Mul(t[i1], c[i2][j])));
        const V far = hn::Add(
            hn::Add(hn::Mul(half[i1], hn::Abs(c[i2][j])), hn::Mul(half[i2], hn::Abs(c[i1][j]))),
            hn::Add(hn::Mul(other(3 + j1), hn::Abs(c[i][j2])), hn::Mul(other(3 + j2), hn::Abs(c[i][j1]))));
        across = hn::Max(across, hn::Sub(along, far));
      }
    }
    across = hn::Sub(across, all_slack);
    const auto wider = hn::AndNot(pruned, hn::Gt(across, zero));
    gap = hn::IfThenElse(wider, hn::Max(gap, across), gap);
  }
  return gap;
}

}  // namespace snug::kernels::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
