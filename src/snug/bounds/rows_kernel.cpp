#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "snug/bounds/rows_kernel.cpp"
#include <snug/geometry/vector_code-inl.h>
// After it.
#include <snug/bounds/lanes-inl.h>
#include <snug/bounds/planar_triangle-inl.h>
#include <snug/bounds/rows_lanes-inl.h>
#include <snug/bounds/table_boxes-inl.h>

#include <algorithm>
#include <cmath>
#include <cstdint>

#include <snug/bounds/rows_kernel.h>
#include <snug/geometry/rounding.h>
#include <support/contract.h>

HWY_BEFORE_NAMESPACE();
namespace snug::kernels::HWY_NAMESPACE {
namespace {

// How much tips may add to the radius of the rest, and to its height.
constexpr double max_excess = 0.15;

// Boxes of a tip in the frame, [axis][corner of the table], with all errors, and what these are by axes.
template <class V>
struct TipBoxes {
  V middle[3][3], half[3][3], error[3];
};

// `net_error`: of its points, by axes.
template <class D, class V = hn::Vec<D>, class T = hn::TFromD<D>>
HWY_INLINE TipBoxes<V> boxes_of(D d, const FlatTable<T>& table, const NetLanes<T>& net,
                                const V (&net_error)[3]) {
  const std::size_t count = net.control.size();
  LinearV<V> linear[3];
  begin_linear(d, table, net, linear);
  if (table.first == 0) add_to_linear(d, table, net, 0, count, linear);
  TableSumsV<V> sums[3];
  begin_boxes(d, linear, sums);
  add_to_boxes(d, table, net, 0, count, linear, sums);
  end_boxes(d, table, linear, sums);
  TipBoxes<V> boxes;
  for (std::size_t a = 0; a < 3; ++a) {
    const V own = hn::Add(hn::Mul(above(d, table.error_of_largest), sums[a].largest),
                          hn::Mul(above(d, table.error_of_offset), sums[a].off));
    const V error = boxes.error[a] =
        hn::Add(hn::Add(own, hn::Mul(above(d, table.gain), net_error[a])), above(d, table.error_at_least));
    for (std::size_t k = 0; k < 3; ++k) {
      boxes.middle[a][k] = hn::Add(linear[a].origin, sums[a].middle[k]);
      const V half = hn::Add(sums[a].half[k], error);
      const V size = hn::Add(hn::Abs(boxes.middle[a][k]), half);
      boxes.half[a][k] = hn::Add(half, hn::Mul(number(d, 16 * roundoff_of<T>), size));
    }
  }
  return boxes;
}

template <class D, class V = hn::Vec<D>>
HWY_INLINE V farthest_of(D d, const PlanarTriangle<V>& t, const TipBoxes<V>& boxes, V middle, V margin) {
  V farthest = hn::Zero(d);
  for (std::size_t k = 0; k < 3; ++k) {
    const V height = hn::Add(hn::Abs(hn::Sub(boxes.middle[2][k], middle)), boxes.half[2][k]);
    for (const double side_x : {-1.0, 1.0}) {
      for (const double side_y : {-1.0, 1.0}) {
        const V x = hn::Add(boxes.middle[0][k], hn::Mul(number(d, side_x), boxes.half[0][k]));
        const V y = hn::Add(boxes.middle[1][k], hn::Mul(number(d, side_y), boxes.half[1][k]));
        farthest = hn::Max(farthest, distance_sq(d, t, foot_of(d, t, x, y, height), margin));
      }
    }
  }
  return farthest;
}

// Patches in doubles, before they are bounded: relative to their first control points.
template <class V>
struct PlacedV {
  Vec3<V> origin, corner[3];
  PlanarTriangle<V> triangle;
  V largest;
};

// Bounds of patches in their frames, from their control points there: the middle of their heights, the square of what no point of
// theirs is farther from the base by, but for `height_error`; and whether tips stick out too far. Doubts: how much of it may be
// errors of heights, and of places.
template <class V, class M>
struct BoundedV {
  V middle, farthest_sq, height_error, height_doubt, place_doubt;
  M good;
};

template <class D, class V = hn::Vec<D>, class T = hn::TFromD<D>>
HWY_INLINE BoundedV<V, hn::Mask<D>> bound(D d, const RowsWithTips<T>& rows, unsigned levels,
                                          const RowsMemory<T>& memory, const PlanarTriangle<V>& t,
                                          V largest) {
  const LanesOf<T>& control = memory.control;
  const V zero = hn::Zero(d), infinite = number(d, INFINITY);
  V point_error[3];
  for (std::size_t a = 0; a < 3; ++a) {
    V size = zero;
    for (std::size_t k = 0; k < rows.kind().control_count(); ++k) {
      size = hn::Max(size, hn::Abs(hn::Load(d, control.at(k, a))));
    }
    point_error[a] = hn::Add(hn::Mul(above(d, rows.error_of_points() * 3 * gamma_bound(16)), largest),
                             hn::Mul(above(d, rows.error_of_largest()), size));
  }
  const V margin =
      hn::Add(hn::Add(point_error[0], point_error[1]), hn::Mul(number(d, 24 * roundoff_of<T>), t.longest));

  std::size_t bezier = 0;
  V lower = infinite, upper = hn::Sub(zero, infinite);
  // A step of points that comes to `next`.
  const auto add_step = [&](const typename RowsWithTips<T>::Step& step, const LanesOf<T>& from,
                            const LanesOf<T>& next) HWY_ATTR {
    each_product(d, step.points, from,
                 [&](std::size_t r, const Vec3<V>& p) HWY_ATTR { store(d, p, next, r); });
    each_product(d, step.bezier, next, [&](std::size_t, const Vec3<V>& p) HWY_ATTR {
      store(d, p, memory.bezier, bezier++);
      lower = hn::Min(lower, p.z);
      upper = hn::Max(upper, p.z);
    });
  };
  const auto add_level = [&](const typename RowsWithTips<T>::Level& level, const LanesOf<T>& from,
                             const LanesOf<T>& next) HWY_ATTR {
    add_step(*level.step, from, next);
    if (level.middle != nullptr) add_step(*level.middle, next, memory.middle);
  };
  add_level(rows.first(), control, memory.patch);
  TipBoxes<V> boxes[most_tips];
  for (std::size_t i = 0; i < rows.tips().size(); ++i) {
    const typename RowsWithTips<T>::Tip& tip = rows.tips()[i];
    NetLanes<T> net{memory.patch, tip.control};
    for (unsigned level = 1; level < levels; ++level) {
      const LanesOf<T>& next = memory.tip[level % 2];
      add_level(tip.levels[level], net.points, next);
      net = {next, tip.levels[level].tip_control};
    }
    boxes[i] = boxes_of(d, tip.table, net, point_error);
  }
  const V low = lower, high = upper;
  for (std::size_t i = 0; i < rows.tips().size(); ++i) {
    for (std::size_t k = 0; k < 3; ++k) {
      lower = hn::Min(lower, hn::Sub(boxes[i].middle[2][k], boxes[i].half[2][k]));
      upper = hn::Max(upper, hn::Add(boxes[i].middle[2][k], boxes[i].half[2][k]));
    }
  }
  BoundedV<V, hn::Mask<D>> result;
  // No -0: which of two zeros is the least depends on their order.
  result.middle = hn::Mul(number(d, 0.5), hn::Add(hn::Add(lower, upper), zero));

  V rest = zero, tips = zero;
  for (std::size_t r = 0; r < bezier; ++r) {
    const Vec3<V> p = load(d, memory.bezier, r);
    const V height = hn::Sub(p.z, result.middle);
    rest = hn::Max(rest, distance_sq(d, t, foot_of(d, t, p.x, p.y, height), margin));
  }
  for (std::size_t i = 0; i < rows.tips().size(); ++i) {
    tips = hn::Max(tips, farthest_of(d, t, boxes[i], result.middle, margin));
  }
  result.good = hn::Le(tips, hn::Mul(number(d, (1 + max_excess) * (1 + max_excess)), rest));
  const V sticks_out = hn::Max(hn::Sub(low, lower), hn::Sub(upper, high));
  result.good = hn::And(result.good, hn::Le(sticks_out, hn::Mul(number(d, max_excess), hn::Sub(high, low))));
  result.farthest_sq = hn::Max(rest, tips);
  result.height_error = result.height_doubt = point_error[2];
  result.place_doubt = margin;
  const auto by_tips = hn::Gt(tips, rest);
  for (std::size_t i = 0; i < rows.tips().size(); ++i) {
    const V(&error)[3] = boxes[i].error;
    result.height_doubt = hn::Max(result.height_doubt, hn::Add(point_error[2], error[2]));
    result.place_doubt = hn::Max(result.place_doubt,
                                 hn::IfThenElseZero(by_tips, hn::Add(margin, hn::Add(error[0], error[1]))));
  }
  return result;
}

// `T`: what it was bounded in. Names of errors as in derivations/rounding.md, "Batches".
template <class T, class D, class V = hn::Vec<D>>
HWY_INLINE void finish(D d, PlacedV<V>& placed, const BoundedV<V, hn::Mask<D>>& bounded,
                       std::span<OffsetTriangle> out) {
  const PlanarTriangle<V>& t = placed.triangle;
  const V one = hn::Set(d, 1.0), infinite = hn::Set(d, INFINITY);
  const V far = hn::Add(hn::Mul(hn::Set(d, 1 + 32 * roundoff_of<T>),
                                hn::Sqrt(hn::Add(bounded.farthest_sq, hn::Set(d, 8 * underflow_of<T>)))),
                        bounded.height_error);
  const V moved = hn::Add(t.deviation, hn::Mul(t.stretch, hn::Abs(bounded.middle)));
  const Vec3<V> shift = scaled(bounded.middle, t.n);
  V largest = hn::Zero(d);
  for (Vec3<V>& corner : placed.corner) {
    corner = add(placed.origin, add(corner, shift));
    largest = hn::Max(largest, max3(hn::Abs(corner.x), hn::Abs(corner.y), hn::Abs(corner.z)));
  }
  const V place_error = hn::Add(hn::Add(hn::Mul(hn::Set(d, unit_roundoff * (1 + 0x1p-42)), largest),
                                        hn::Mul(hn::Set(d, gamma_bound(16)), placed.largest)),
                                hn::Set(d, 4096 * underflow_error));
  const V given = hn::Mul(hn::Set(d, spatial_error(1)), place_error);
  const V radius = hn::Add(hn::Mul(hn::Add(far, moved), hn::Add(one, t.stretch)), given);
  const V widened = hn::Add(hn::Mul(radius, hn::Set(d, 1 + 0x1p-42)), hn::Set(d, underflow_error));
  const V rounding =
      hn::Add(hn::Add(hn::Add(moved, given), hn::Add(bounded.height_doubt, bounded.place_doubt)),
              hn::Mul(hn::Set(d, 32 * roundoff_of<T>), far));
  auto good = hn::And(well_shaped(d, t), hn::Lt(placed.largest, infinite));
  good = hn::And(good, hn::And(bounded.good, hn::Lt(widened, infinite)));
  V none = hn::Set(d, -1.0);
  if constexpr (sizeof(T) < sizeof(double)) {
    // Places that are off add to radii in square, where points are beside the triangle.
    auto exact = hn::And(hn::Le(hn::Mul(hn::Set(d, 128.0), bounded.height_doubt), far),
                         hn::Le(hn::Mul(hn::Set(d, 32.0), bounded.place_doubt), far));
    exact = hn::And(exact, hn::And(hn::Ge(t.longest, hn::Set(d, 0x1p-40)), hn::Lt(far, infinite)));
    none = hn::IfThenElse(exact, none, hn::Set(d, needs_digits));
    good = hn::And(good, exact);
  }
  hand_out(d, placed.corner, hn::IfThenElse(good, widened, none), rounding, out);
}

// `control`: room for the control points of a vector of doubles.
template <class B, class T = hn::TFromD<B>>
HWY_INLINE void fit_lanes(B of_bounds, const RowsWithTips<T>& rows, unsigned levels,
                          std::span<const Point3> points, const VertexId* control,
                          const RowsMemory<T>& memory, double* gathered, std::span<OffsetTriangle> out) {
  const hn::ScalableTag<double> d;
  using V = hn::Vec<decltype(d)>;
  const std::size_t some = hn::Lanes(d), all = hn::Lanes(of_bounds), count = rows.kind().control_count();
  PlacedV<V> placed[most_parts<decltype(of_bounds)>];
  HWY_ALIGN T lane[6][HWY_MAX_BYTES / sizeof(T)];
  for (std::size_t l = 0; l < all; l += some) {
    const std::size_t begin = std::min(l, out.size() - 1);
    gather_lanes(points, control + count * begin, count, 0, count, std::min(some, out.size() - begin), some,
                 gathered);
    const Lanes here{gathered, some};
    PlacedV<V>& patches = placed[l / some];
    patches.origin = load(d, here, 0);
    for (std::size_t k = 0; k < count; ++k) store(d, sub(load(d, here, k), patches.origin), here, k);
    for (std::size_t k = 0; k < 3; ++k) {
      patches.corner[k] = product(d, rows.kind().corner_limits(), k, here);
    }
    const PlanarTriangle<V> t = planar_triangle(d, patches.corner[0], patches.corner[1], patches.corner[2]);
    patches.largest = into_frame(d, t, here, count, LanesOf<T>{memory.control.first + l, all});
    patches.triangle = t;
    const V numbers[] = {t.l0, t.xc, t.yc, patches.largest};
    for (std::size_t i = 0; i < 4; ++i) store_as(d, numbers[i], lane[i] + l);
  }
  PlanarTriangle<hn::Vec<decltype(of_bounds)>> t;
  t.l0 = hn::Load(of_bounds, lane[0]);
  t.xc = hn::Load(of_bounds, lane[1]);
  t.yc = hn::Load(of_bounds, lane[2]);
  find_edges(of_bounds, t);
  const auto bounded = bound(of_bounds, rows, levels, memory, t, hn::Load(of_bounds, lane[3]));
  hn::Store(bounded.middle, of_bounds, lane[0]);
  hn::Store(bounded.farthest_sq, of_bounds, lane[1]);
  hn::Store(bounded.height_error, of_bounds, lane[2]);
  hn::Store(bounded.height_doubt, of_bounds, lane[3]);
  hn::Store(bounded.place_doubt, of_bounds, lane[4]);
  hn::Store(hn::IfThenElseZero(bounded.good, number(of_bounds, 1)), of_bounds, lane[5]);
  for (std::size_t l = 0; l < std::min(all, out.size()); l += some) {
    const auto of = [&](std::size_t i) HWY_ATTR { return load_as(d, lane[i] + l); };
    const BoundedV<V, hn::Mask<decltype(d)>> part{of(0), of(1), of(2),
                                                  of(3), of(4), hn::Gt(of(5), hn::Zero(d))};
    finish<T>(d, placed[l / some], part, out.subspan(l, std::min(some, out.size() - l)));
  }
}

template <class T>
HWY_INLINE void fit_all(const RowsWithTips<T>& rows, unsigned levels, std::span<const Point3> points,
                        const VertexId* control, std::span<OffsetTriangle> out) {
  const hn::ScalableTag<double> d;
  const std::size_t lanes = hn::Lanes(hn::ScalableTag<T>()), count = rows.kind().control_count();
  const std::size_t memory_size = lanes * RowsMemory<T>::size(rows, levels);
  // Of doubles together.
  double* const gathered =
      aligned_memory(3 * count * hn::Lanes(d) + (sizeof(T) == sizeof(double) ? memory_size : 0));
  T* at;
  if constexpr (sizeof(T) == sizeof(double)) {
    at = gathered + 3 * count * hn::Lanes(d);
  } else {
    at = aligned_memory<T>(memory_size);
  }
  const auto fit = [&](auto of_bounds, std::size_t begin) HWY_ATTR {
    const std::size_t here = std::min(hn::Lanes(of_bounds), out.size() - begin);
    fit_lanes(of_bounds, rows, levels, points, control + count * begin,
              RowsMemory<T>(at, hn::Lanes(of_bounds), rows), gathered, out.subspan(begin, here));
    return begin + here;
  };
  for (std::size_t begin = 0; begin < out.size();) {
    // Half a vector costs less where there are 512 bits.
    constexpr std::size_t half = 64 / sizeof(T) / 2;
    if constexpr (sizeof(T) < sizeof(double) && hn::MaxLanes(hn::ScalableTag<T>()) == 2 * half) {
      if (out.size() - begin <= half) {
        begin = fit(hn::CappedTag<T, half>(), begin);
        continue;
      }
    }
    begin = fit(hn::ScalableTag<T>(), begin);
  }
}

SNUG_FLAT void FitRows(const RowsWithTips<double>& rows, unsigned levels, std::span<const Point3> points,
                       const VertexId* control, std::span<OffsetTriangle> out) {
  fit_all<double>(rows, levels, points, control, out);
}
SNUG_FLAT void FitRowsInSingle(const RowsWithTips<float>& rows, unsigned levels,
                               std::span<const Point3> points, const VertexId* control,
                               std::span<OffsetTriangle> out) {
  fit_all<float>(rows, levels, points, control, out);
}

}  // namespace
}  // namespace snug::kernels::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace snug::kernels {

HWY_EXPORT(FitRows);
HWY_EXPORT(FitRowsInSingle);

template <>
void fit_rows<double>(const RowsWithTips<double>& rows, unsigned levels, std::span<const Point3> points,
                      std::span<const VertexId> control, std::span<OffsetTriangle> out) {
  SNUG_EXPECT(levels >= least_row_levels && levels <= most_row_levels);
  HWY_DYNAMIC_DISPATCH(FitRows)(rows, levels, points, control.data(), out);
}
template <>
void fit_rows<float>(const RowsWithTips<float>& rows, unsigned levels, std::span<const Point3> points,
                     std::span<const VertexId> control, std::span<OffsetTriangle> out) {
  SNUG_EXPECT(levels >= least_row_levels && levels <= most_row_levels);
  HWY_DYNAMIC_DISPATCH(FitRowsInSingle)(rows, levels, points, control.data(), out);
}

}  // namespace snug::kernels
#endif
