// Included after bounds/planar_triangle-inl.h: no #pragma once, since each instruction set reads it again.
#include <cstddef>
#include <cstdint>
#include <span>

#include <snug/bounds/rows_kernel.h>

#if defined(SNUG_BOUNDS_ROWS_LANES_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef SNUG_BOUNDS_ROWS_LANES_INL_H
#undef SNUG_BOUNDS_ROWS_LANES_INL_H
#else
#define SNUG_BOUNDS_ROWS_LANES_INL_H
#endif

HWY_BEFORE_NAMESPACE();
namespace snug::kernels::HWY_NAMESPACE {

// each(r, product) for the rows, of `points`; two at once.
template <class D, class Each, class V = hn::Vec<D>, class T = hn::TFromD<D>>
HWY_INLINE void each_product(D d, const SparseRows<T>& rows, const LanesOf<T>& points, const Each& each) {
  const std::uint32_t* place = rows.places.data();
  const std::uint32_t* source = rows.sources.data();
  const T* weight = rows.weights.data();
  const std::size_t stride = hn::Lanes(d);
  const auto point = [&](std::uint32_t i) HWY_ATTR {
    const T* const at = points.first + 3 * stride * i;
    return Vec3<V>{hn::Load(d, at), hn::Load(d, at + stride), hn::Load(d, at + 2 * stride)};
  };
  for (const auto& [count, length] : rows.runs) {
    std::size_t r = 0;
    for (; r + 2 <= count; r += 2) {
      Vec3<V> one = scaled(hn::Set(d, weight[0]), point(source[0])),
              two = scaled(hn::Set(d, weight[length]), point(source[length]));
      for (std::size_t i = 1; i < length; ++i) {
        add_scaled(d, weight[i], point(source[i]), one);
        add_scaled(d, weight[length + i], point(source[length + i]), two);
      }
      each(place[0], one);
      each(place[1], two);
      place += 2;
      weight += 2 * length;
      source += 2 * length;
    }
    if (r == count) continue;
    Vec3<V> sum = scaled(hn::Set(d, weight[0]), point(source[0]));
    for (std::size_t i = 1; i < length; ++i) add_scaled(d, weight[i], point(source[i]), sum);
    each(*place++, sum);
    weight += length;
    source += length;
  }
}

// Vectors of doubles that hold as many numbers as one of D: one, or two.
template <class D>
constexpr std::size_t most_parts = sizeof(double) / sizeof(hn::TFromD<D>);

// A control net among the points of a step.
template <class T>
struct NetLanes {
  LanesOf<T> points;
  std::span<const std::uint32_t> control;
  [[nodiscard]] const T* at(std::size_t i, std::size_t axis) const { return points.at(control[i], axis); }
};

// Control points relative to the first, then in the frame, as numbers of `to`. The largest |coordinate| relative to the
// first corner; not a number where a point is not finite.
template <class D, class T, class V = hn::Vec<D>>
HWY_INLINE V into_frame(D d, const PlanarTriangle<V>& t, const Lanes& control, std::size_t count,
                        const LanesOf<T>& to) {
  V largest = hn::Zero(d), probe = hn::Zero(d);
  for (std::size_t k = 0; k < count; ++k) {
    const Vec3<V> r = sub(load(d, control, k), t.a);
    largest = hn::Max(largest, max3(hn::Abs(r.x), hn::Abs(r.y), hn::Abs(r.z)));
    probe = hn::Add(probe, hn::Add(hn::Sub(r.x, r.x), hn::Add(hn::Sub(r.y, r.y), hn::Sub(r.z, r.z))));
    store_as(d, dot(t.t1, r), to.at(k, 0));
    store_as(d, dot(t.t2, r), to.at(k, 1));
    store_as(d, dot(t.n, r), to.at(k, 2));
  }
  return hn::Add(largest, probe);
}

// Points of patches as they come to be, level by level.
template <class T>
struct RowsMemory {
  LanesOf<T> control, patch, tip[2], middle, bezier;
  RowsMemory(T* at, std::size_t lanes, const RowsWithTips<T>& rows) {
    for (LanesOf<T>* const part : {&control, &patch, &tip[0], &tip[1], &middle, &bezier}) {
      *part = {at, lanes};
      at += 3 * lanes * (part == &control ? rows.kind().control_count() : rows.most_points());
    }
  }
  [[nodiscard]] static std::size_t size(const RowsWithTips<T>& rows, unsigned levels) {
    return 3 * (rows.kind().control_count() + 4 * rows.most_points() + rows.bezier_count(levels));
  }
};

}  // namespace snug::kernels::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
