#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "snug/bounds/rows_kernel.cpp"
#include <snug/geometry/vector_code-inl.h>
// After it.
#include <snug/bounds/lanes-inl.h>
#include <snug/bounds/planar_triangle-inl.h>
#include <snug/bounds/table_boxes-inl.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

#include <snug/bounds/rows_kernel.h>
#include <snug/geometry/rounding.h>

HWY_BEFORE_NAMESPACE();
namespace snug::kernels::HWY_NAMESPACE {
namespace {

// How much tips may add to the radius of the rest, and to its height.
constexpr double max_excess = 0.03;

// Two rows at once: control points are loaded once for both.
template <class D, class V = hn::Vec<D>>
HWY_INLINE void apply_two(D d, const double* one, const double* two, const Lanes& control, std::size_t count,
                          Vec3<V>& first, Vec3<V>& second) {
  const V zero = hn::Zero(d);
  first = second = {zero, zero, zero};
  for (std::size_t k = 0; k < count; ++k) {
    const Vec3<V> c = load(d, control, k);
    first = add(first, scaled(hn::Set(d, one[k]), c));
    second = add(second, scaled(hn::Set(d, two[k]), c));
  }
}

template <class V>
struct Extent {
  V lower, upper;
};

// Boxes of a tip in the frame, [axis][corner of the table], with all errors.
template <class V>
struct TipBoxes {
  V middle[3][3], half[3][3];
};

template <class D, class V = hn::Vec<D>>
HWY_INLINE TipBoxes<V> boxes_of(D d, const RowsWithTips::Tip& tip, const Lanes& net, V net_error) {
  const FlatTable& table = tip.table;
  LinearV<V> linear[3];
  begin_linear(d, table, net, linear);
  if (table.first == 0) add_to_linear(d, table, net, 0, tip.count, linear);
  TipBoxes<V> boxes;
  V largest;
  begin_boxes(d, table, linear, boxes.middle, boxes.half, largest);
  add_to_boxes(d, table, net, 0, tip.count, linear, boxes.middle, boxes.half, largest);
  const V error = hn::Add(hn::Add(hn::Mul(hn::Set(d, table.error_of_largest), largest),
                                  hn::Mul(hn::Set(d, table.gain), net_error)),
                          hn::Set(d, table.error_at_least));
  for (std::size_t a = 0; a < 3; ++a) {
    for (std::size_t k = 0; k < 3; ++k) {
      boxes.middle[a][k] = hn::Add(linear[a].origin, boxes.middle[a][k]);
      const V half = hn::Add(boxes.half[a][k], error);
      const V size = hn::Add(hn::Abs(boxes.middle[a][k]), half);
      boxes.half[a][k] = hn::Add(half, hn::Mul(hn::Set(d, 8 * unit_roundoff), size));
    }
  }
  return boxes;
}

template <class D, class V = hn::Vec<D>>
HWY_INLINE V farthest_of(D d, const PlanarTriangle<V>& t, const TipBoxes<V>& boxes, V middle) {
  V farthest = hn::Zero(d);
  for (std::size_t k = 0; k < 3; ++k) {
    const V height = hn::Add(hn::Abs(hn::Sub(boxes.middle[2][k], middle)), boxes.half[2][k]);
    for (const double side_x : {-1.0, 1.0}) {
      for (const double side_y : {-1.0, 1.0}) {
        const V x = hn::Add(boxes.middle[0][k], hn::Mul(hn::Set(d, side_x), boxes.half[0][k]));
        const V y = hn::Add(boxes.middle[1][k], hn::Mul(hn::Set(d, side_y), boxes.half[1][k]));
        farthest = hn::Max(farthest, distance_sq(d, t, foot_of(d, t, x, y, height)));
      }
    }
  }
  return farthest;
}

// Control points relative to the first, then in the frame. The largest |coordinate| relative to the first
// corner; not a number where a point is not finite.
template <class D, class V = hn::Vec<D>>
HWY_INLINE V into_frame(D d, const PlanarTriangle<V>& t, const Lanes& control, std::size_t count) {
  V largest = hn::Zero(d), probe = hn::Zero(d);
  for (std::size_t k = 0; k < count; ++k) {
    const Vec3<V> r = sub(load(d, control, k), t.a);
    largest = hn::Max(largest, max3(hn::Abs(r.x), hn::Abs(r.y), hn::Abs(r.z)));
    probe = hn::Add(probe, hn::Add(hn::Sub(r.x, r.x), hn::Add(hn::Sub(r.y, r.y), hn::Sub(r.z, r.z))));
    store(d, Vec3<V>{dot(t.t1, r), dot(t.t2, r), dot(t.n, r)}, control, k);
  }
  return hn::Add(largest, probe);
}

template <class D, class V = hn::Vec<D>>
HWY_INLINE void fit_lanes(D d, const RowsWithTips& rows, const Lanes& control, const Lanes& points,
                          std::span<OffsetTriangle> out) {
  const std::size_t count = rows.control_count();
  const V zero = hn::Zero(d), infinite = hn::Set(d, INFINITY);
  const Vec3<V> origin = load(d, control, 0);
  for (std::size_t k = 0; k < count; ++k) store(d, sub(load(d, control, k), origin), control, k);
  Vec3<V> corner[4];
  apply_two(d, rows.row(0), rows.row(1), control, count, corner[0], corner[1]);
  apply_two(d, rows.row(2), rows.row(2), control, count, corner[2], corner[3]);
  const PlanarTriangle<V> t = planar_triangle(d, corner[0], corner[1], corner[2]);
  const V largest = into_frame(d, t, control, count);
  const V point_error = hn::Mul(hn::Set(d, rows.error_of_largest()), largest);

  const std::size_t end = rows.count(), tips_begin = rows.tips_begin();
  V lower = infinite, upper = hn::Sub(zero, infinite);
  for (std::size_t r = 3; r < end; r += 2) {
    Vec3<V> p[2];
    apply_two(d, rows.row(r), rows.row(std::min(r + 1, end - 1)), control, count, p[0], p[1]);
    for (std::size_t i = 0; i < 2 && r + i < end; ++i) {
      store(d, p[i], points, r + i);
      if (r + i >= tips_begin) continue;
      lower = hn::Min(lower, p[i].z);
      upper = hn::Max(upper, p[i].z);
    }
  }
  TipBoxes<V> boxes[3];
  const V low = lower, high = upper;
  for (std::size_t i = 0; i < rows.tips().size(); ++i) {
    const RowsWithTips::Tip& tip = rows.tips()[i];
    boxes[i] = boxes_of(d, tip, Lanes{points.at(tip.begin, 0), points.lanes}, point_error);
    for (std::size_t k = 0; k < 3; ++k) {
      lower = hn::Min(lower, hn::Sub(boxes[i].middle[2][k], boxes[i].half[2][k]));
      upper = hn::Max(upper, hn::Add(boxes[i].middle[2][k], boxes[i].half[2][k]));
    }
  }
  // No -0: which of two zeros is the least depends on their order.
  const V middle = hn::Mul(hn::Set(d, 0.5), hn::Add(hn::Add(lower, upper), zero));

  V rest = zero, tips = zero;
  for (std::size_t r = 3; r < tips_begin; ++r) {
    const Vec3<V> p = load(d, points, r);
    rest = hn::Max(rest, distance_sq(d, t, foot_of(d, t, p.x, p.y, hn::Sub(p.z, middle))));
  }
  for (std::size_t i = 0; i < rows.tips().size(); ++i) {
    tips = hn::Max(tips, farthest_of(d, t, boxes[i], middle));
  }
  auto good = hn::And(well_shaped(d, t), hn::Lt(largest, infinite));
  good = hn::And(good, hn::Le(tips, hn::Mul(hn::Set(d, (1 + max_excess) * (1 + max_excess)), rest)));
  const V sticks_out = hn::Max(hn::Sub(low, lower), hn::Sub(upper, high));
  good = hn::And(good, hn::Le(sticks_out, hn::Mul(hn::Set(d, max_excess), hn::Sub(high, low))));

  const ReachV<V> reach = reach_of(d, t, hn::Max(rest, tips), hn::Mul(t.stretch, hn::Abs(middle)));
  const Vec3<V> shift = scaled(middle, t.n);
  V placed = zero;
  for (std::size_t k = 0; k < 3; ++k) {
    corner[k] = add(origin, add(corner[k], shift));
    placed = hn::Max(placed, max3(hn::Abs(corner[k].x), hn::Abs(corner[k].y), hn::Abs(corner[k].z)));
  }
  const V place_error =
      hn::Add(hn::Mul(hn::Set(d, unit_roundoff * (1 + 0x1p-42)), placed), hn::Set(d, 4096 * underflow_error));
  const V given = hn::Mul(hn::Set(d, spatial_error(1)), hn::Add(point_error, place_error));
  const V radius = hn::Add(reach.distance, given);
  const V widened = hn::Add(hn::Mul(radius, hn::Set(d, 1 + 0x1p-42)), hn::Set(d, underflow_error));
  good = hn::And(good, hn::Lt(widened, infinite));
  hand_out(d, corner, hn::IfThenElse(good, widened, hn::Set(d, -1.0)), hn::Add(reach.rounding, given), out);
}

void FitRows(const RowsWithTips& rows, std::span<const Point3> points, const VertexId* control,
             std::span<OffsetTriangle> out) {
  const hn::ScalableTag<double> d;
  const std::size_t lanes = hn::Lanes(d), count = rows.control_count();
  double* const aligned = aligned_memory(3 * lanes * (count + rows.count()));
  const Lanes gathered{aligned, lanes}, results{aligned + 3 * lanes * count, lanes};
  for (std::size_t begin = 0; begin < out.size(); begin += lanes) {
    const std::size_t here = std::min(lanes, out.size() - begin);
    gather_lanes(points, control + count * begin, count, 0, count, here, lanes, aligned);
    fit_lanes(d, rows, gathered, results, out.subspan(begin, here));
  }
}

}  // namespace
}  // namespace snug::kernels::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace snug::kernels {

HWY_EXPORT(FitRows);

bool RowsWithTips::fit(const Kind& kind) {
  return kind.cacheable() && !kind.polynomial() && has_self_similar_tips(kind);
}

RowsWithTips::RowsWithTips(BoundsCache& library, const Kind& kind, unsigned levels)
    : control_count_(kind.control_count()) {
  const BoundingRows rows = make_bounding_rows(kind, levels);
  const Stencils& limits = kind.corner_limits();
  weights_.assign((3 + rows.count()) * control_count_, 0.0);
  for (std::size_t k = 0; k < 3; ++k) {
    const Stencils::Row row = limits.row(k);
    for (std::size_t i = 0; i < row.sources.size(); ++i) {
      weights_[k * control_count_ + row.sources[i]] += row.weights[i];
    }
  }
  for (std::size_t r = 0; r < rows.count(); ++r) {
    for (std::size_t c = 0; c < control_count_; ++c) {
      weights_[(3 + r) * control_count_ + c] = rows.weight(r, c);
    }
  }
  for (const BoundingRows::Net& net : rows.nets()) {
    Tip& own = tips_.emplace_back(Tip{3 + net.begin, net.kind->control_count(), {}, {}});
    own.table = flatten(library.tip_table(*net.kind), *net.kind, own.columns);
  }
  // Derivations/rounding.md, "Batches".
  const double most = std::max(1.0, rows.abs_sum());
  error_of_largest_ = enlarged(3 * (gamma_bound(control_count_ + 16) * most + rows.entry_error()));
}

void fit_rows(const RowsWithTips& rows, std::span<const Point3> points, std::span<const VertexId> control,
              std::span<OffsetTriangle> out) {
  HWY_DYNAMIC_DISPATCH(FitRows)(rows, points, control.data(), out);
}

}  // namespace snug::kernels
#endif
