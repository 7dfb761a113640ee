#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "snug/bvh/node_kernels.cpp"
#include <snug/geometry/vector_code-inl.h>

#include <algorithm>
#include <bit>
#include <cmath>

#include <snug/bvh/box_gaps-inl.h>
#include <snug/bvh/node_kernels.h>

HWY_BEFORE_NAMESPACE();
namespace snug::kernels::HWY_NAMESPACE {
namespace {

// More than what roundings to single precision can do to a gap, as a part of all that is involved.
constexpr float roundings = 64 * 0x1p-24F;
// The same where the other box, too, was placed in single precision.
constexpr float pair_roundings = 256 * 0x1p-24F;

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
HWY_INLINE bool place_box(float reach, const SeenBox& other, const Turn& turn, OtherBox& box, float& doubt) {
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
  if (!place_box(reach, other, turn, box, doubt)) return nothing_known(out);
  return compare<false>(node, box, doubt + slack, prune_distance, out);
}

// Along the line of the centres and along the direction. The former decides overlaps.
Near seen_along(const float* node, float reach, const SeenBox& other, const Turn& turn, float slack,
                float prune_distance, float* out) {
  OtherBox box;
  float doubt;
  if (!place_box(reach, other, turn, box, doubt)) return nothing_known(out);
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

void obb_extents(const float* node, float reach, const float direction[3], float* out) {
  if (!(reach < 1e18F)) {
    std::fill(out, out + 8, INFINITY);
    return;
  }
  HWY_DYNAMIC_DISPATCH(extents)(node, reach, direction, out);
}

}  // namespace snug::kernels
#endif
