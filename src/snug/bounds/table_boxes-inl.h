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
HWY_INLINE V from_origin(D d, const LinearV<V>& l, double u, double v) {
  return hn::Add(hn::Mul(hn::Set(d, u), l.along_one), hn::Mul(hn::Set(d, v), l.along_two));
}

// Below, `control.at(i, axis)` is where a coordinate of control point i is, a lane a patch.

/// Begins a table's linear function: it is done unless the table goes by limits.
template <class D, class Control, class V = hn::Vec<D>>
HWY_INLINE void begin_linear(D d, const FlatTable& table, const Control& control, LinearV<V>* linear) {
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
HWY_INLINE void add_to_linear(D d, const FlatTable& table, const Control& control, std::size_t from,
                              std::size_t to, LinearV<V>* linear) {
  for (std::size_t a = 0; a < 3; ++a) {
    LinearV<V> l = linear[a];
    for (std::size_t i = from; i < to; ++i) {
      const std::array<double, 3>& weight = table.columns[i].linear;
      const V c = hn::Load(d, control.at(i, a));
      l.origin = hn::Add(l.origin, hn::Mul(c, hn::Set(d, weight[0])));
      l.along_one = hn::Add(l.along_one, hn::Mul(c, hn::Set(d, weight[1])));
      l.along_two = hn::Add(l.along_two, hn::Mul(c, hn::Set(d, weight[2])));
    }
    linear[a] = l;
  }
}

/// Middles and half widths at the table's corners, [axis][corner], before any control point; the middles
/// relative to the linear function's origin.
template <class D, class V = hn::Vec<D>>
HWY_INLINE void begin_boxes(D d, const FlatTable& table, const LinearV<V>* linear, V (&middle)[3][3],
                            V (&half)[3][3], V& largest) {
  largest = hn::Zero(d);
  for (std::size_t a = 0; a < 3; ++a) {
    const LinearV<V>& l = linear[a];
    largest = hn::Max(largest, hn::Max(hn::Abs(l.along_one), hn::Abs(l.along_two)));
    for (std::size_t k = 0; k < 3; ++k) {
      middle[a][k] = from_origin(d, l, table.triangle[k][0], table.triangle[k][1]);
      half[a][k] = hn::Zero(d);
    }
  }
}

/// Adds control points [from, to) to them.
template <class D, class Control, class V = hn::Vec<D>>
HWY_INLINE void add_to_boxes(D d, const FlatTable& table, const Control& control, std::size_t from,
                             std::size_t to, const LinearV<V>* linear, V (&middle)[3][3], V (&half)[3][3],
                             V& largest) {
  for (std::size_t a = 0; a < 3; ++a) {
    const LinearV<V> l = linear[a];
    V m0 = middle[a][0], m1 = middle[a][1], m2 = middle[a][2];
    V h0 = half[a][0], h1 = half[a][1], h2 = half[a][2];
    for (std::size_t i = std::max(from, table.first); i < to; ++i) {
      const TableColumn& column = table.columns[i - table.first];
      const V c = hn::Sub(hn::Load(d, control.at(i, a)), l.origin);
      largest = hn::Max(largest, hn::Abs(c));
      const V off = hn::Sub(c, from_origin(d, l, column.u, column.v));
      const V size = hn::Abs(off);
      m0 = hn::Add(m0, hn::Mul(off, hn::Set(d, column.middle[0])));
      m1 = hn::Add(m1, hn::Mul(off, hn::Set(d, column.middle[1])));
      m2 = hn::Add(m2, hn::Mul(off, hn::Set(d, column.middle[2])));
      h0 = hn::Add(h0, hn::Mul(size, hn::Set(d, column.half[0])));
      h1 = hn::Add(h1, hn::Mul(size, hn::Set(d, column.half[1])));
      h2 = hn::Add(h2, hn::Mul(size, hn::Set(d, column.half[2])));
    }
    middle[a][0] = m0, middle[a][1] = m1, middle[a][2] = m2;
    half[a][0] = h0, half[a][1] = h1, half[a][2] = h2;
  }
}

}  // namespace snug::kernels::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
