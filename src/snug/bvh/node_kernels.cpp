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

// `doubt`: more than what roundings do to a gap.
template <bool euclidean>
HWY_INLINE Near compare(const float* node, const OtherBox& other, float doubt, float prune_distance,
                        float* out) {
  const Tag d;
  Near near{0, INFINITY};
  const V all_slack = hn::Set(d, doubt);
  const auto row = [&](std::size_t r) {
    return hn::Set(d, r < 3 ? other.centre[r] : r < 6 ? other.half[r - 3] : other.axes[(r - 6) / 3][r % 3]);
  };
  for (std::size_t at = 0; at < 8; at += hn::Lanes(d)) {
    store(gaps<euclidean>(node, at, row, all_slack, prune_distance), prune_distance, at, out, near);
  }
  return near;
}

Near boxes(const float* node, float reach, const OtherBox& other, float slack, float prune_distance,
           float* out) {
  return compare<true>(node, other, roundings * reach + slack, prune_distance, out);
}

// The product of the turn with a column of three rows, from row r on, plus `add`.
HWY_INLINE void turned(const Turn& turn, const float* rows, std::size_t r, float factor, const float* add,
                       float* out) {
  const hn::CappedTag<float, 4> d;
  const auto x = hn::Set(d, rows[8 * r]), y = hn::Set(d, rows[8 * (r + 1)]),
             z = hn::Set(d, rows[8 * (r + 2)]);
  for (std::size_t at = 0; at < 4; at += hn::Lanes(d)) {
    const auto column = [&](std::size_t j) { return hn::Load(d, turn.columns[j] + at); };
    const auto sum = hn::Add(hn::Add(hn::Mul(column(0), x), hn::Mul(column(1), y)), hn::Mul(column(2), z));
    hn::Store(hn::Add(hn::Mul(sum, hn::Set(d, factor)), hn::Load(d, add + at)), d, out + at);
  }
}

// Places another node's box; false where nothing can be said. `doubt` becomes what roundings do to a gap.
HWY_INLINE bool place(float reach, const SeenBox& other, const Turn& turn, OtherBox& box, float& doubt) {
  reach += 2 * turn.scale * other.reach + std::fabs(other.offset[0]) + std::fabs(other.offset[1]) +
           std::fabs(other.offset[2]);
  doubt = pair_roundings * reach;
  if (!(reach < 1e18F)) return false;
  HWY_ALIGN const float offset[4] = {other.offset[0], other.offset[1], other.offset[2], 0};
  HWY_ALIGN const float none[4] = {};
  HWY_ALIGN float placed[4][4];
  turned(turn, other.rows, 0, 1, offset, placed[3]);
  for (std::size_t k = 0; k < 3; ++k)
    turned(turn, other.rows, 6 + 3 * k, turn.inverse_scale, none, placed[k]);
  for (std::size_t k = 0; k < 3; ++k) {
    box.centre[k] = placed[3][k];
    box.half[k] = turn.scale * other.rows[8 * (3 + k)];
    for (std::size_t i = 0; i < 3; ++i) box.axes[k][i] = placed[k][i];
  }
  return true;
}

Near nothing_known(float* out) {
  std::fill(out, out + 8, -INFINITY);
  return {0xff, INFINITY};
}

Near seen_box(const float* node, float reach, const SeenBox& other, const Turn& turn, float slack,
              float prune_distance, float* out) {
  OtherBox box;
  float doubt;
  if (!place(reach, other, turn, box, doubt)) return nothing_known(out);
  return compare<false>(node, box, doubt + slack, prune_distance, out);
}

// Along the line of the centres and along the direction. The former decides overlaps.
Near seen_along(const float* node, float reach, const SeenBox& other, const Turn& turn, float slack,
                float prune_distance, float* out) {
  OtherBox box;
  float doubt;
  if (!place(reach, other, turn, box, doubt)) return nothing_known(out);
  const Tag d;
  Near near{0, INFINITY};
  const V all_slack = hn::Set(d, doubt + slack);
  const float* const n = turn.direction;
  float other_extent = 0;
  for (std::size_t k = 0; k < 3; ++k) {
    const float* const axis = other.rows + 8 * (6 + 3 * k);
    const float* const m = turn.other_direction;
    other_extent += box.half[k] * std::fabs(axis[0] * m[0] + axis[8] * m[1] + axis[16] * m[2]);
  }
  for (std::size_t at = 0; at < 8; at += hn::Lanes(d)) {
    const auto row = [&](std::size_t r) { return hn::LoadU(d, node + 8 * r + at); };
    V delta[3];
    for (std::size_t k = 0; k < 3; ++k) delta[k] = hn::Sub(hn::Set(d, box.centre[k]), row(k));
    const V between_sq =
        sum3(hn::Mul(delta[0], delta[0]), hn::Mul(delta[1], delta[1]), hn::Mul(delta[2], delta[2]));
    V taken = hn::Zero(d), extent = hn::Set(d, other_extent);
    for (std::size_t k = 0; k < 3; ++k) {
      const V axis[3] = {row(6 + 3 * k), row(7 + 3 * k), row(8 + 3 * k)}, half = row(3 + k);
      const V own =
          hn::Abs(sum3(hn::Mul(axis[0], delta[0]), hn::Mul(axis[1], delta[1]), hn::Mul(axis[2], delta[2])));
      const V others = hn::Abs(dot3(d, delta, box.axes[k]));
      taken = hn::Add(taken, hn::Add(hn::Mul(half, own), hn::Mul(hn::Set(d, box.half[k]), others)));
      extent = hn::Add(extent, hn::Mul(half, hn::Abs(dot3(d, axis, n))));
    }
    const V between = hn::Sqrt(between_sq);
    const V central = hn::Div(hn::Sub(between_sq, taken), between);
    // Of centres that coincide nothing is known, but for the direction.
    const V known =
        hn::IfThenElse(hn::Gt(between_sq, hn::Set(d, min_squared * min_squared)), central, hn::Neg(taken));
    const V along = hn::Sub(dot3(d, delta, n), extent);
    store(hn::Sub(hn::Max(known, along), all_slack), prune_distance, at, out, near);
  }
  return near;
}

Deepest walk_step(const NodeBoxes& node, const NodeBoxes& other, std::size_t place, const TreeView& view,
                  float prune_distance) {
  const std::uint32_t count = node.count;
  const float* const column = other.rows + place;
  const float from[3] = {static_cast<float>(node.origin[0]), static_cast<float>(node.origin[1]),
                         static_cast<float>(node.origin[2])};
  const float to[3] = {static_cast<float>(other.origin[0]), static_cast<float>(other.origin[1]),
                       static_cast<float>(other.origin[2])};
  // The box of the other node, less this one's origin.
  const hn::CappedTag<float, 4> d4;
  HWY_ALIGN float placed[4][4];
  for (std::size_t at = 0; at < 4; at += hn::Lanes(d4)) {
    const auto turned = [&](float x, float y, float z) HWY_ATTR {
      return hn::Add(hn::Add(hn::Mul(hn::Load(d4, view.columns[0] + at), hn::Set(d4, x)),
                             hn::Mul(hn::Load(d4, view.columns[1] + at), hn::Set(d4, y))),
                     hn::Mul(hn::Load(d4, view.columns[2] + at), hn::Set(d4, z)));
    };
    hn::Store(hn::Add(turned(column[0] + to[0], column[8] + to[1], column[16] + to[2]),
                      hn::Load(d4, view.translation + at)),
              d4, placed[3] + at);
    for (std::size_t k = 0; k < 3; ++k) {
      const float* const axis = column + 8 * (6 + 3 * k);
      hn::Store(hn::Mul(turned(axis[0], axis[8], axis[16]), hn::Set(d4, view.inverse_scale)), d4,
                placed[k] + at);
    }
  }
  OtherBox box;
  float own = node.reach, others = other.reach;
  for (std::size_t k = 0; k < 3; ++k) {
    own += std::fabs(from[k]);
    others += std::fabs(to[k]);
    box.centre[k] = placed[3][k] - from[k];
    box.half[k] = view.scale * column[8 * (3 + k)];
    for (std::size_t i = 0; i < 3; ++i) box.axes[k][i] = placed[k][i];
  }
  const float size = own + 2 * view.scale * others + view.reach;
  // What is not a number is near.
  if (!(size < 1e18F)) return {(1u << count) - 1, 0, INFINITY};
  const float doubt = walk_roundings * size + view.slack, limit = prune_distance + doubt;
  const Tag d;
  const auto row = [&](std::size_t r) {
    return hn::Set(d, r < 3 ? box.centre[r] : r < 6 ? box.half[r - 3] : box.axes[(r - 6) / 3][r % 3]);
  };
  HWY_ALIGN float found[8];
  Near near{0, INFINITY};
  for (std::size_t at = 0; at < 8; at += hn::Lanes(d)) {
    store(gaps<false>(node.rows, at, row, hn::Zero(d), limit), limit, at, found, near);
  }
  const std::uint32_t places = near.places & ((1u << count) - 1);
  // The least of no gaps is not the same on every instruction set.
  Deepest result{places, 0, places + 1 == 1u << count ? INFINITY : near.others - doubt};
  float least = INFINITY;
  for (std::uint32_t rest = places; rest != 0; rest &= rest - 1) {
    const auto p = static_cast<std::uint32_t>(std::countr_zero(rest));
    if (found[p] < least) least = found[p], result.deepest = p;
  }
  return result;
}

Near boxes_to_point(const float* node, const float* point, float slack, float prune_distance, float* out) {
  const Tag d;
  Near near{0, INFINITY};
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
    store(known, prune_distance, at, out, near);
  }
  return near;
}

void extents(const float* node, float reach, const float* direction, float* out) {
  const Tag d;
  const V doubt = hn::Set(d, roundings * reach);
  for (std::size_t at = 0; at < 8; at += hn::Lanes(d)) {
    const auto row = [&](std::size_t r) { return hn::LoadU(d, node + 8 * r + at); };
    const V centre[3] = {row(0), row(1), row(2)};
    V extent = hn::Add(dot3(d, centre, direction), doubt);
    for (std::size_t k = 0; k < 3; ++k) {
      const V axis[3] = {row(6 + 3 * k), row(7 + 3 * k), row(8 + 3 * k)};
      extent = hn::Add(extent, hn::Mul(row(3 + k), hn::Abs(dot3(d, axis, direction))));
    }
    hn::StoreU(extent, d, out + at);
  }
}

}  // namespace
}  // namespace snug::kernels::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace snug::kernels {

HWY_EXPORT(boxes);
HWY_EXPORT(seen_box);
HWY_EXPORT(seen_along);
HWY_EXPORT(boxes_to_point);
HWY_EXPORT(walk_step);
HWY_EXPORT(extents);

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

Near obb_distances(const float* node, float reach, const SeenBox& other, const Turn& turn, float slack,
                   float prune_distance, Gaps which, float* out) {
  if (which == Gaps::lines) {
    return HWY_DYNAMIC_DISPATCH(seen_along)(node, reach, other, turn, slack, prune_distance, out);
  }
  return HWY_DYNAMIC_DISPATCH(seen_box)(node, reach, other, turn, slack, prune_distance, out);
}

Near obb_distances(const float* node, const float point[3], float slack, float prune_distance, float* out) {
  return HWY_DYNAMIC_DISPATCH(boxes_to_point)(node, point, slack, prune_distance, out);
}

Deepest near_boxes(const NodeBoxes& node, const NodeBoxes& other, std::size_t place, const TreeView& view,
                   float prune_distance) {
  return HWY_DYNAMIC_DISPATCH(walk_step)(node, other, place, view, prune_distance);
}

void obb_extents(const float* node, float reach, const float direction[3], float* out) {
  if (!(reach < 1e18F)) {
    std::fill(out, out + 8, INFINITY);
    return;
  }
  HWY_DYNAMIC_DISPATCH(extents)(node, reach, direction, out);
}

}  // namespace snug::kernels
#endif
