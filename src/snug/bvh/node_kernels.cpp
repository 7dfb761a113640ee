#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "snug/bvh/node_kernels.cpp"
#include <snug/geometry/vector_code-inl.h>

#include <algorithm>
#include <bit>
#include <cmath>

#include <snug/bvh/node_kernels.h>

HWY_BEFORE_NAMESPACE();
namespace snug::kernels::HWY_NAMESPACE {
namespace {

using Tag = hn::CappedTag<float, 8>;
using V = hn::Vec<Tag>;

// More than what roundings to single precision can do to a gap, as a part of all that is involved.
constexpr float roundings = 64 * 0x1p-24F;
// The same where the other box, too, was placed in single precision.
constexpr float pair_roundings = 256 * 0x1p-24F;

template <class D>
HWY_INLINE V dot3(D d, const V* a, const float* b) {
  return hn::Add(hn::Add(hn::Mul(a[0], hn::Set(d, b[0])), hn::Mul(a[1], hn::Set(d, b[1]))),
                 hn::Mul(a[2], hn::Set(d, b[2])));
}

HWY_INLINE V sum3(V a, V b, V c) { return hn::Add(hn::Add(a, b), c); }
HWY_INLINE V max3(V a, V b, V c) { return hn::Max(hn::Max(a, b), c); }

// Squares of shorter lengths lose digits to the end of single precision, or all of them.
constexpr float least_squared = 0x1p-50F;

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
  return hn::IfThenElse(hn::Gt(largest, hn::Set(d, least_squared)), length, largest);
}

// Minus infinity for what is not a number, or too large to be one of ours.
HWY_INLINE V computed(V gap) {
  const Tag d;
  return hn::IfThenElse(hn::Lt(gap, hn::Set(d, 1e30F)), gap, hn::Set(d, -INFINITY));
}

HWY_INLINE std::uint32_t bits(hn::Mask<Tag> mask) {
  const Tag d;
  std::uint8_t result = 0;
  hn::StoreMaskBits(d, mask, &result);
  return result & ((1u << hn::Lanes(d)) - 1);
}

// The lanes from `at` on, and what they add to `near`.
HWY_INLINE void store(V gap, float prune_distance, std::size_t at, float* out, Near& near) {
  const Tag d;
  gap = computed(gap);
  hn::StoreU(gap, d, out + at);
  const auto beyond = hn::Gt(gap, hn::Set(d, prune_distance));
  near.places |= bits(hn::Not(beyond)) << at;
  near.others = std::min(near.others,
                         hn::GetLane(hn::MinOfLanes(d, hn::IfThenElse(beyond, gap, hn::Set(d, INFINITY)))));
}

// Gaps of the lanes from `at` on. `other`: a row of the other boxes, as in a node.
template <class Row>
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
  // Along the line of the centres: what both boxes take of it, times its length.
  const V between_sq =
      sum3(hn::Mul(delta[0], delta[0]), hn::Mul(delta[1], delta[1]), hn::Mul(delta[2], delta[2]));
  V taken =
      sum3(hn::Mul(half[0], hn::Abs(t[0])), hn::Mul(half[1], hn::Abs(t[1])), hn::Mul(half[2], hn::Abs(t[2])));
  for (std::size_t j = 0; j < 3; ++j) {
    const V along = hn::Abs(along_axis(delta, j));
    taken = hn::Add(taken, hn::Mul(other(3 + j), along));
    others[j] = hn::Sub(hn::Sub(along, others[j]), all_slack);
  }
  V gap = outside(own, others);
  const V central = hn::Sub(hn::Div(hn::Sub(between_sq, taken), hn::Sqrt(between_sq)), all_slack);
  const auto apart =
      hn::And(hn::Gt(central, zero), hn::Gt(between_sq, hn::Set(d, least_squared * least_squared)));
  gap = hn::IfThenElse(apart, hn::Max(gap, central), gap);
  // Lane by lane, so that it makes no difference how many a vector has.
  const auto settled = hn::Gt(gap, hn::Set(d, prune_distance));
  if (!hn::AllTrue(d, settled)) {
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
    const auto wider = hn::AndNot(settled, hn::Gt(across, zero));
    gap = hn::IfThenElse(wider, hn::Max(gap, across), gap);
  }
  return gap;
}

Near boxes(const float* node, float reach, const OtherBox& other, float slack, float prune_distance,
           float* out) {
  const Tag d;
  Near near{0, INFINITY};
  const V all_slack = hn::Set(d, roundings * reach + slack);
  const auto row = [&](std::size_t r) {
    return hn::Set(d, r < 3 ? other.centre[r] : r < 6 ? other.half[r - 3] : other.axes[(r - 6) / 3][r % 3]);
  };
  for (std::size_t at = 0; at < 8; at += hn::Lanes(d)) {
    store(gaps(node, at, row, all_slack, prune_distance), prune_distance, at, out, near);
  }
  return near;
}

// Centres of a node's boxes in the coordinates of another node.
HWY_INLINE void place_centres(const BoxNode& node, const SeenNode& seen, float* out) {
  const Tag d;
  for (std::size_t at = 0; at < 8; at += hn::Lanes(d)) {
    const auto row = [&](std::size_t r) { return hn::LoadU(d, node.rows + 8 * r + at); };
    const V x[3] = {row(0), row(1), row(2)};
    for (std::size_t i = 0; i < 3; ++i) {
      hn::Store(hn::Add(dot3(d, x, seen.rows[i]), hn::Set(d, seen.offset[i])), d, out + 8 * i + at);
    }
  }
}

// Their half sizes and axes, in the rows after these.
HWY_INLINE void place_axes(const BoxNode& node, const SeenNode& seen, float* out) {
  const Tag d;
  const V scale = hn::Set(d, seen.scale), inverse = hn::Set(d, 1 / seen.scale);
  for (std::size_t at = 0; at < 8; at += hn::Lanes(d)) {
    const auto row = [&](std::size_t r) { return hn::LoadU(d, node.rows + 8 * r + at); };
    for (std::size_t k = 3; k < 6; ++k) hn::Store(hn::Mul(scale, row(k)), d, out + 8 * k + at);
    for (std::size_t k = 6; k < obb_rows; k += 3) {
      const V x[3] = {row(k), row(k + 1), row(k + 2)};
      for (std::size_t i = 0; i < 3; ++i) {
        hn::Store(hn::Mul(inverse, dot3(d, x, seen.rows[i])), d, out + 8 * (k + i) + at);
      }
    }
  }
}

// Eight columns of a node's rows in another order.
HWY_INLINE void pick(const float* rows, const std::int32_t* order, float* out) {
  const Tag d;
  const hn::RebindToSigned<Tag> di;
  for (std::size_t at = 0; at < 8; at += hn::Lanes(d)) {
    const auto places = hn::LoadU(di, order + at);
    for (std::size_t r = 0; r < obb_rows; ++r) {
#if HWY_MAX_BYTES >= 32
      const V row = hn::TableLookupLanes(hn::LoadU(d, rows + 8 * r), hn::IndicesFromVec(d, places));
#else
      const V row = hn::GatherIndex(d, rows + 8 * r, places);
#endif
      hn::Store(row, d, out + 8 * r + at);
    }
  }
}

// Half of what boxes extend along a direction.
HWY_INLINE V half_extents(const BoxNode& node, std::size_t at, const float* direction) {
  const Tag d;
  const auto row = [&](std::size_t r) { return hn::LoadU(d, node.rows + 8 * r + at); };
  V sum = hn::Zero(d);
  for (std::size_t k = 0; k < 3; ++k) {
    const V axis[3] = {row(6 + 3 * k), row(7 + 3 * k), row(8 + 3 * k)};
    sum = hn::Add(sum, hn::Mul(row(3 + k), hn::Abs(dot3(d, axis, direction))));
  }
  return sum;
}

// Extents along the first direction to try: upper ones of the node's boxes, lower ones of the others.
struct Extents {
  HWY_ALIGN float own[8];
  HWY_ALIGN float other[8];
};
HWY_INLINE void extents_along(const BoxNode& node, const BoxNode& other, const SeenNode& seen,
                              const float* placed, Extents& out) {
  const Tag d;
  const float* const n = seen.direction;
  const bool directed = n[0] != 0 || n[1] != 0 || n[2] != 0;
  for (std::size_t at = 0; at < 8; at += hn::Lanes(d)) {
    V extent = hn::Set(d, INFINITY), other_extent = hn::Zero(d);
    if (directed) {
      const auto row = [&](std::size_t r) { return hn::LoadU(d, node.rows + 8 * r + at); };
      const auto other_row = [&](std::size_t r) { return hn::Load(d, placed + 8 * r + at); };
      const V centre[3] = {row(0), row(1), row(2)};
      const V other_centre[3] = {other_row(0), other_row(1), other_row(2)};
      extent = hn::Add(dot3(d, centre, n), half_extents(node, at, n));
      other_extent = hn::Sub(dot3(d, other_centre, n), half_extents(other, at, seen.other_direction));
    }
    hn::Store(extent, d, out.own + at);
    hn::Store(other_extent, d, out.other + at);
  }
}

// Pairs of boxes that are left, by their places; eight at a time are read.
struct Left {
  std::int32_t own[64 + 8], other[64 + 8];
  std::size_t count = 0;
  HWY_ALIGN float gaps[8][8];  // that are known, by place in the other node
};

// Balls and the first direction: the pairs that they leave, and what they add to the least gap of the others.
HWY_INLINE void compare_balls(const BoxNode& node, const BoxNode& other, const SeenNode& seen,
                              const float* placed, V all_slack, V beyond, Left& left, V& others) {
  const Tag d;
  Extents extents;
  extents_along(node, other, seen, placed, extents);
  for (std::uint32_t j = 0; j < other.count; ++j) {
    const V radius = hn::Set(d, 0.5F * seen.scale * other.sizes[j]);
    std::uint32_t near_bits = 0;
    for (std::size_t at = 0; at < 8; at += hn::Lanes(d)) {
      V between_sq = hn::Zero(d);
      for (std::size_t k = 0; k < 3; ++k) {
        const V delta = hn::Sub(hn::Set(d, placed[8 * k + j]), hn::LoadU(d, node.rows + 8 * k + at));
        between_sq = hn::Add(between_sq, hn::Mul(delta, delta));
      }
      const V radii = hn::Add(hn::Mul(hn::Set(d, 0.5F), hn::LoadU(d, node.sizes + at)), radius);
      const V along = hn::Sub(hn::Set(d, extents.other[j]), hn::Load(d, extents.own + at));
      const V gap = hn::Sub(hn::Max(hn::Sub(hn::Sqrt(between_sq), radii), along), all_slack);
      const auto apart = hn::Gt(gap, beyond);
      hn::Store(gap, d, left.gaps[j] + at);
      others = hn::Min(others, hn::IfThenElse(apart, gap, hn::Set(d, INFINITY)));
      near_bits |= bits(hn::Not(apart)) << at;
    }
    for (near_bits &= (1u << node.count) - 1; near_bits != 0; near_bits &= near_bits - 1) {
      left.own[left.count] = std::countr_zero(near_bits);
      left.other[left.count++] = static_cast<std::int32_t>(j);
    }
  }
}

// Axes of eight of these pairs from `begin` on: those that are left go to `out`.
HWY_INLINE void compare_axes(const float* rows, const float* placed, Left& left, std::size_t begin,
                             V all_slack, float prune_distance, ChildPair* out, std::size_t& found_count,
                             V& others) {
  const Tag d;
  const std::size_t count = std::min<std::size_t>(8, left.count - begin);
  std::int32_t* const own = left.own + begin;
  std::int32_t* const other = left.other + begin;
  std::fill(own + count, own + 8, own[0]);
  std::fill(other + count, other + 8, other[0]);
  HWY_ALIGN float own_rows[obb_rows * 8];
  HWY_ALIGN float other_rows[obb_rows * 8];
  HWY_ALIGN float found[8];
  pick(rows, own, own_rows);
  pick(placed, other, other_rows);
  for (std::size_t l = 0; l < 8; ++l) found[l] = left.gaps[other[l]][own[l]];
  std::uint32_t near_bits = 0;
  for (std::size_t at = 0; at < 8; at += hn::Lanes(d)) {
    const auto row = [&](std::size_t r) { return hn::Load(d, other_rows + 8 * r + at); };
    // How deep balls overlap says little.
    const V first = hn::Load(d, found + at),
            by_axes = computed(gaps(own_rows, at, row, all_slack, prune_distance));
    const V gap = hn::IfThenElse(hn::Gt(first, hn::Zero(d)), hn::Max(by_axes, first), by_axes);
    const auto apart = hn::Gt(gap, hn::Set(d, prune_distance));
    hn::Store(gap, d, found + at);
    others = hn::Min(others, hn::IfThenElse(apart, gap, hn::Set(d, INFINITY)));
    near_bits |= bits(hn::Not(apart)) << at;
  }
  for (near_bits &= (1u << count) - 1; near_bits != 0; near_bits &= near_bits - 1) {
    const auto l = static_cast<std::size_t>(std::countr_zero(near_bits));
    out[found_count++] = {static_cast<std::uint8_t>(own[l]), static_cast<std::uint8_t>(other[l]), found[l]};
  }
}

void box_pairs(const BoxNode& node, const BoxNode& other, const SeenNode& seen, float slack,
               float prune_distance, NearPairs& near) {
  const Tag d;
  const float offset = std::fabs(seen.offset[0]) + std::fabs(seen.offset[1]) + std::fabs(seen.offset[2]);
  const float reach = node.reach + 2 * seen.scale * other.reach + offset;
  near.count = 0;
  near.others = INFINITY;
  if (!(reach < 1e18F)) {  // nor a NaN
    for (std::uint32_t j = 0; j < other.count; ++j) {
      for (std::uint32_t i = 0; i < node.count; ++i) {
        near.pairs[near.count++] = {static_cast<std::uint8_t>(i), static_cast<std::uint8_t>(j), -INFINITY};
      }
    }
    return;
  }
  const V all_slack = hn::Set(d, pair_roundings * reach + slack);
  V others = hn::Set(d, INFINITY);
  HWY_ALIGN float placed[obb_rows * 8];
  place_centres(other, seen, placed);
  Left left;
  compare_balls(node, other, seen, placed, all_slack, hn::Set(d, prune_distance), left, others);
  if (left.count != 0) place_axes(other, seen, placed);
  std::size_t count = 0;  // not near.count, which what is written may be for all that a compiler knows
  for (std::size_t begin = 0; begin < left.count; begin += 8) {
    compare_axes(node.rows, placed, left, begin, all_slack, prune_distance, near.pairs.data(), count, others);
  }
  near.count = count;
  near.others = hn::GetLane(hn::MinOfLanes(d, others));
}

void boxes_to_point(const float* node, const float* point, float slack, float* out) {
  const Tag d;
  const std::size_t n = hn::Lanes(d);
  for (std::size_t at = 0; at < 8; at += n) {
    const auto row = [&](std::size_t r) { return hn::LoadU(d, node + 8 * r + at); };
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
    const V gap_of_all = outside(gap, gap);
    const V known = hn::IfThenElse(hn::Lt(reach, hn::Set(d, 1e18F)), gap_of_all, hn::Set(d, -INFINITY));
    hn::StoreU(computed(known), d, out + at);
  }
}

}  // namespace
}  // namespace snug::kernels::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace snug::kernels {

HWY_EXPORT(boxes);
HWY_EXPORT(box_pairs);
HWY_EXPORT(boxes_to_point);

Near obb_distances(const float* node, float reach, const OtherBox& other, float slack, float prune_distance,
                   float* out) {
  reach += other.reach();
  // A NaN may be lost in a maximum.
  if (!(reach < 1e18F)) {
    std::fill(out, out + 8, -INFINITY);
    return {0xff, INFINITY};
  }
  return HWY_DYNAMIC_DISPATCH(boxes)(node, reach, other, slack, prune_distance, out);
}

void obb_pairs(const BoxNode& node, const BoxNode& other, const SeenNode& seen, float slack,
               float prune_distance, NearPairs& near) {
  HWY_DYNAMIC_DISPATCH(box_pairs)(node, other, seen, slack, prune_distance, near);
}

void obb_distances(const float* node, const float point[3], float slack, float* out) {
  HWY_DYNAMIC_DISPATCH(boxes_to_point)(node, point, slack, out);
}

}  // namespace snug::kernels
#endif
