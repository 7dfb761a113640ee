// Included after geometry/vector_code-inl.h: no #pragma once, since each instruction set reads it again.
#include <algorithm>
#include <cstddef>

#include <snug/bounds/flat_table.h>

#if defined(SNUG_BOUNDS_TABLE_BOXES_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef SNUG_BOUNDS_TABLE_BOXES_INL_H
#undef SNUG_BOUNDS_TABLE_BOXES_INL_H
#else
#define SNUG_BOUNDS_TABLE_BOXES_INL_H
#endif

HWY_BEFORE_NAMESPACE();
namespace snug::kernels::HWY_NAMESPACE {

// Linear function of a coordinate: through the first three control points, or about the limits of the corners.
template <class V>
struct LinearV {
  V origin, along_one, along_two;
};

template <class D, class V = hn::Vec<D>>
HWY_INLINE V from_origin(D d, const LinearV<V>& l, hn::TFromD<D> u, hn::TFromD<D> v) {
  return hn::Add(hn::Mul(hn::Set(d, u), l.along_one), hn::Mul(hn::Set(d, v), l.along_two));
}

// Below, `control.at(i, axis)` is where a coordinate of control point i is, a lane a patch.

/// Begins a table's linear function: it is done unless the table goes by limits.
template <class D, class Control, class V = hn::Vec<D>>
HWY_INLINE void begin_linear(D d, const FlatTable<hn::TFromD<D>>& table, const Control& control,
                             LinearV<V>* linear) {
  for (std::size_t a = 0; a < 3; ++a) {
    linear[a] = {hn::Zero(d), hn::Zero(d), hn::Zero(d)};
    if (table.first == 0) continue;
    const V origin = hn::Load(d, control.at(0, a));
    linear[a] = {origin, hn::Sub(hn::Load(d, control.at(1, a)), origin),
                 hn::Sub(hn::Load(d, control.at(2, a)), origin)};
  }
}

/// Adds what control points [from, to) bring to the limits. Whatever comes out is the linear function: it has
/// no error.
template <class D, class Control, class V = hn::Vec<D>>
HWY_INLINE void add_to_linear(D d, const FlatTable<hn::TFromD<D>>& table, const Control& control,
                              std::size_t from, std::size_t to, LinearV<V>* linear) {
  for (std::size_t a = 0; a < 3; ++a) {
    LinearV<V> l = linear[a];
    for (std::size_t i = from; i < to; ++i) {
      const auto& weight = table.columns[i].linear;
      const V c = hn::Load(d, control.at(i, a));
      l.origin = hn::Add(l.origin, hn::Mul(c, hn::Set(d, weight[0])));
      l.along_one = hn::Add(l.along_one, hn::Mul(c, hn::Set(d, weight[1])));
      l.along_two = hn::Add(l.along_two, hn::Mul(c, hn::Set(d, weight[2])));
    }
    linear[a] = l;
  }
}

/// A coordinate of what bounds a patch: middles, relative to the linear function's origin, and half widths at the table's
/// corners; the largest |c - origin|, and the largest difference from the linear function.
template <class V>
struct TableSumsV {
  V middle[3], half[3], largest, off;
};

template <class D, class V = hn::Vec<D>>
HWY_INLINE void begin_boxes(D d, const LinearV<V>* linear, TableSumsV<V>* sums) {
  for (std::size_t a = 0; a < 3; ++a) {
    sums[a].largest = hn::Max(hn::Abs(linear[a].along_one), hn::Abs(linear[a].along_two));
    sums[a].off = hn::Zero(d);
    for (std::size_t k = 0; k < 3; ++k) sums[a].middle[k] = sums[a].half[k] = hn::Zero(d);
  }
}

/// Adds control points [from, to) to them.
template <class D, class Control, class V = hn::Vec<D>>
HWY_INLINE void add_to_boxes(D d, const FlatTable<hn::TFromD<D>>& table, const Control& control,
                             std::size_t from, std::size_t to, const LinearV<V>* linear,
                             TableSumsV<V>* sums) {
  for (std::size_t a = 0; a < 3; ++a) {
    const LinearV<V> l = linear[a];
    TableSumsV<V> s = sums[a];
    for (std::size_t i = std::max(from, table.first); i < to; ++i) {
      const auto& column = table.columns[i - table.first];
      const V c = hn::Sub(hn::Load(d, control.at(i, a)), l.origin);
      s.largest = hn::Max(s.largest, hn::Abs(c));
      const V off = hn::Sub(c, from_origin(d, l, column.u, column.v));
      const V size = hn::Abs(off);
      s.off = hn::Max(s.off, size);
      for (std::size_t k = 0; k < 3; ++k) {
        s.middle[k] = hn::Add(s.middle[k], hn::Mul(off, hn::Set(d, column.middle[k])));
        s.half[k] = hn::Add(s.half[k], hn::Mul(size, hn::Set(d, column.half[k])));
      }
    }
    sums[a] = s;
  }
}

/// Adds the linear function to the middles.
template <class D, class V = hn::Vec<D>>
HWY_INLINE void end_boxes(D d, const FlatTable<hn::TFromD<D>>& table, const LinearV<V>* linear,
                          TableSumsV<V>* sums) {
  for (std::size_t a = 0; a < 3; ++a) {
    for (std::size_t k = 0; k < 3; ++k) {
      const V there = from_origin(d, linear[a], table.triangle[k][0], table.triangle[k][1]);
      sums[a].middle[k] = hn::Add(there, sums[a].middle[k]);
    }
  }
}

}  // namespace snug::kernels::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
