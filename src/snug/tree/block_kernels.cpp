// Compiled once for each instruction set: this file includes itself through foreach_target.h.
#define HWY_DISABLED_TARGETS (HWY_SSSE3 | HWY_AVX3_DL)
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "snug/tree/block_kernels.cpp"
#include <hwy/foreach_target.h>
// After it, as the library wants it.
#include <hwy/highway.h>

#include <cmath>

#include <snug/tree/block_kernels.h>

HWY_BEFORE_NAMESPACE();
namespace snug::kernels::HWY_NAMESPACE {
namespace {

namespace hn = hwy::HWY_NAMESPACE;

using Tag = hn::CappedTag<float, 8>;
using V = hn::Vec<Tag>;

// More than what roundings to single precision can do to any of the gaps, in units of 2^-24 of all that is involved.
constexpr float roundings = 64 * 0x1p-24F;

template <class D>
HWY_INLINE V dot3(D d, const V* a, const float* b) {
  return hn::Add(hn::Add(hn::Mul(a[0], hn::Set(d, b[0])), hn::Mul(a[1], hn::Set(d, b[1]))),
                 hn::Mul(a[2], hn::Set(d, b[2])));
}

HWY_INLINE V sum3(V a, V b, V c) { return hn::Add(hn::Add(a, b), c); }
HWY_INLINE V max3(V a, V b, V c) { return hn::Max(hn::Max(a, b), c); }

// Length of the vector of the positive ones of three gaps, or the largest if there are none.
template <class D>
HWY_INLINE V outside(D d, V x, V y, V z) {
  const V zero = hn::Zero(d), largest = max3(x, y, z);
  const V px = hn::Max(x, zero), py = hn::Max(y, zero), pz = hn::Max(z, zero);
  const V length = hn::Mul(hn::Sqrt(sum3(hn::Mul(px, px), hn::Mul(py, py), hn::Mul(pz, pz))),
                           hn::Set(d, 1 - 16 * 0x1p-24F));
  return hn::IfThenElse(hn::Gt(largest, zero), length, largest);
}

template <class D>
HWY_INLINE void store(D d, V gap, float* out) {
  // Comparisons with a NaN are false.
  hn::StoreU(hn::IfThenElse(hn::Lt(gap, hn::Set(d, 1e30F)), gap, hn::Set(d, -INFINITY)), d, out);
}

void boxes(const float* block, const OtherBox& other, float slack, float enough, float* out) {
  const Tag d;
  const std::size_t n = hn::Lanes(d);
  for (std::size_t at = 0; at < 8; at += n) {
    const auto row = [&](std::size_t r) { return hn::LoadU(d, block + 8 * r + at); };
    V delta[3], half[3], axis[3][3];
    for (std::size_t k = 0; k < 3; ++k) {
      delta[k] = hn::Sub(hn::Set(d, other.centre[k]), row(k));
      half[k] = row(3 + k);
      for (std::size_t i = 0; i < 3; ++i) axis[k][i] = row(6 + 3 * k + i);
    }
    V t[3], c[3][3], m[3][3];  // of the offset along the block's axes; cosines and their absolute values
    for (std::size_t i = 0; i < 3; ++i) {
      t[i] =
          sum3(hn::Mul(axis[i][0], delta[0]), hn::Mul(axis[i][1], delta[1]), hn::Mul(axis[i][2], delta[2]));
      for (std::size_t j = 0; j < 3; ++j) {
        c[i][j] = dot3(d, axis[i], other.axes[j]);
        m[i][j] = hn::Abs(c[i][j]);
      }
    }
    V h[3];
    for (std::size_t j = 0; j < 3; ++j) h[j] = hn::Set(d, other.half[j]);
    const V reach = hn::Add(hn::Add(sum3(hn::Abs(delta[0]), hn::Abs(delta[1]), hn::Abs(delta[2])),
                                    sum3(half[0], half[1], half[2])),
                            sum3(h[0], h[1], h[2]));
    const V all_slack = hn::Add(hn::Mul(hn::Set(d, roundings), reach), hn::Set(d, slack));
    V own[3], others[3];
    for (std::size_t i = 0; i < 3; ++i) {
      const V far = sum3(hn::Mul(h[0], m[i][0]), hn::Mul(h[1], m[i][1]), hn::Mul(h[2], m[i][2]));
      own[i] = hn::Sub(hn::Sub(hn::Abs(t[i]), hn::Add(half[i], far)), all_slack);
    }
    for (std::size_t j = 0; j < 3; ++j) {
      const V along = hn::Abs(dot3(d, delta, other.axes[j]));
      const V far = sum3(hn::Mul(half[0], m[0][j]), hn::Mul(half[1], m[1][j]), hn::Mul(half[2], m[2][j]));
      others[j] = hn::Sub(hn::Sub(along, hn::Add(h[j], far)), all_slack);
    }
    V gap = hn::Max(outside(d, own[0], own[1], own[2]), outside(d, others[0], others[1], others[2]));
    // A NaN may have been lost in a maximum.
    const auto computed = hn::Lt(reach, hn::Set(d, 1e18F));
    gap = hn::IfThenElse(computed, gap, hn::Set(d, -INFINITY));
    // Lane by lane, so that it makes no difference how many a vector has.
    const auto settled = hn::Gt(gap, hn::Set(d, enough));
    if (hn::AllTrue(d, settled)) {
      store(d, gap, out + at);
      continue;
    }
    // Cross products of axes are at most 1 long: an overlap along a short one says little, so only gaps count.
    V across = hn::Set(d, -INFINITY);
    for (std::size_t i = 0; i < 3; ++i) {
      const std::size_t i1 = (i + 1) % 3, i2 = (i + 2) % 3;
      for (std::size_t j = 0; j < 3; ++j) {
        const std::size_t j1 = (j + 1) % 3, j2 = (j + 2) % 3;
        const V along = hn::Abs(hn::Sub(hn::Mul(t[i2], c[i1][j]), hn::Mul(t[i1], c[i2][j])));
        const V far = hn::Add(hn::Add(hn::Mul(half[i1], m[i2][j]), hn::Mul(half[i2], m[i1][j])),
                              hn::Add(hn::Mul(h[j1], m[i][j2]), hn::Mul(h[j2], m[i][j1])));
        across = hn::Max(across, hn::Sub(along, far));
      }
    }
    across = hn::Sub(across, all_slack);
    const auto wider = hn::And(hn::AndNot(settled, hn::Gt(across, hn::Zero(d))), computed);
    store(d, hn::IfThenElse(wider, hn::Max(gap, across), gap), out + at);
  }
}

void boxes_to_point(const float* block, const float* point, float slack, float* out) {
  const Tag d;
  const std::size_t n = hn::Lanes(d);
  for (std::size_t at = 0; at < 8; at += n) {
    const auto row = [&](std::size_t r) { return hn::LoadU(d, block + 8 * r + at); };
    V delta[3], gap[3];
    V reach = hn::Zero(d);
    for (std::size_t k = 0; k < 3; ++k) {
      delta[k] = hn::Sub(hn::Set(d, point[k]), row(k));
      reach = hn::Add(reach, hn::Add(hn::Abs(delta[k]), row(3 + k)));
    }
    const V all_slack = hn::Add(hn::Mul(hn::Set(d, roundings), reach), hn::Set(d, slack));
    for (std::size_t i = 0; i < 3; ++i) {
      const V along = hn::Abs(sum3(hn::Mul(row(6 + 3 * i), delta[0]), hn::Mul(row(7 + 3 * i), delta[1]),
                                   hn::Mul(row(8 + 3 * i), delta[2])));
      gap[i] = hn::Sub(hn::Sub(along, row(3 + i)), all_slack);
    }
    store(d,
          hn::IfThenElse(hn::Lt(reach, hn::Set(d, 1e18F)), outside(d, gap[0], gap[1], gap[2]),
                         hn::Set(d, -INFINITY)),
          out + at);
  }
}

void dops(const float* block, std::size_t directions, const OtherIntervals& other, float slack, float* out) {
  const Tag d;
  const std::size_t n = hn::Lanes(d);
  for (std::size_t at = 0; at < 8; at += n) {
    const auto gap_along = [&](std::size_t i) {
      const V lower = hn::LoadU(d, block + 16 * i + at), upper = hn::LoadU(d, block + 16 * i + 8 + at);
      const V other_lower = hn::Set(d, other.lower[i]), other_upper = hn::Set(d, other.upper[i]);
      const V reach = hn::Add(hn::Add(hn::Abs(lower), hn::Abs(upper)),
                              hn::Add(hn::Abs(other_lower), hn::Abs(other_upper)));
      const V own = hn::Add(hn::Mul(hn::Set(d, roundings), reach), hn::Set(d, slack * other.length[i]));
      const V gap = hn::Max(hn::Sub(other_lower, upper), hn::Sub(lower, other_upper));
      return hn::IfThenElse(hn::Lt(reach, hn::Set(d, 1e18F)), hn::Sub(gap, own), hn::Set(d, -INFINITY));
    };
    V gap = outside(d, gap_along(0), gap_along(1), gap_along(2));
    for (std::size_t i = 3; i < directions; ++i) {
      gap = hn::Max(gap, hn::Mul(gap_along(i), hn::Set(d, 1 / other.length[i])));
    }
    store(d, gap, out + at);
  }
}

}  // namespace
}  // namespace snug::kernels::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace snug::kernels {

HWY_EXPORT(boxes);
HWY_EXPORT(boxes_to_point);
HWY_EXPORT(dops);

void obb_distances(const float* block, const OtherBox& other, float slack, float enough, float* out) {
  HWY_DYNAMIC_DISPATCH(boxes)(block, other, slack, enough, out);
}

void obb_distances(const float* block, const float point[3], float slack, float* out) {
  HWY_DYNAMIC_DISPATCH(boxes_to_point)(block, point, slack, out);
}

void dop_distances(const float* block, std::size_t directions, const OtherIntervals& other, float slack,
                   float* out) {
  HWY_DYNAMIC_DISPATCH(dops)(block, directions, other, slack, out);
}

}  // namespace snug::kernels
#endif
