#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "snug/bounds/table_kernel.cpp"
#include <snug/geometry/vector_code-inl.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include <snug/base/contract.h>
#include <snug/bounds/bound_table.h>
#include <snug/bounds/fit_kernels.h>
#include <snug/bounds/lanes.h>
#include <snug/geometry/rounding.h>

#ifndef SNUG_ENCLOSE_TABLE_KERNEL_ONCE
#define SNUG_ENCLOSE_TABLE_KERNEL_ONCE
namespace snug::kernels {
namespace {

// A control point beyond the third in a table: its place, and the planes around its function at the table's
// corners as middle and half width.
struct TableColumn {
  double u, v;
  std::array<double, 3> middle, half;
};

struct FlatTable {
  std::span<const TableColumn> columns;
  const std::array<LayoutPoint, 3>* triangle;
  double error_of_largest;  // times the largest |c - c_0| of a patch
  double error_at_least;
};

double reach(const LayoutPoint& u) { return 1 + std::fabs(u[0]) + std::fabs(u[1]); }

// The half width covers the rounding of both. The error bounds that of centre and half width together:
// control points relative to the first, the linear function, the sums; derivations/rounding.md, "Batches".
FlatTable flatten(const BoundTable& table, std::vector<TableColumn>& memory) {
  const std::size_t count = table.control_count();
  memory.clear();
  std::array<double, 3> gain;
  for (std::size_t k = 0; k < 3; ++k) gain[k] = reach(table.triangle[k]);
  for (std::size_t i = 3; i < count; ++i) {
    TableColumn column{table.layout[i][0], table.layout[i][1], {}, {}};
    for (std::size_t k = 0; k < 3; ++k) {
      const double low = table.lower[i - 3][k], high = table.upper[i - 3][k];
      const double most = std::max(std::fabs(low), std::fabs(high));
      column.middle[k] = 0.5 * (low + high);
      column.half[k] = enlarged(0.5 * (high - low) + 2 * unit_roundoff * most);
      gain[k] += reach(table.layout[i]) * (most + column.half[k]);
    }
    memory.push_back(column);
  }
  const double most = *std::max_element(gain.begin(), gain.end());
  const double terms = 12 * unit_roundoff + gamma_bound(count + 4);
  return {memory, &table.triangle, enlarged(2 * most * terms),
          enlarged((16 * most + 8 * static_cast<double>(count)) * underflow_error)};
}

}  // namespace
}  // namespace snug::kernels
#endif

HWY_BEFORE_NAMESPACE();
namespace snug::kernels::HWY_NAMESPACE {
namespace {

constexpr std::size_t block = 16;  // control points gathered at once

// Linear function of a coordinate through the first three control points, relative to the first.
template <class V>
struct LinearV {
  V along_one, along_two;
};

template <class D, class V = hn::Vec<D>>
HWY_INLINE V at(D d, const LinearV<V>& l, double u, double v) {
  return hn::Add(hn::Mul(hn::Set(d, u), l.along_one), hn::Mul(hn::Set(d, v), l.along_two));
}

template <class D, class V = hn::Vec<D>>
HWY_INLINE void fit_lanes(D d, const FlatTable& table, std::span<const Point3> points,
                          const VertexId* control, std::span<OffsetTriangle> out) {
  const std::size_t lanes = hn::Lanes(d), count = table.columns.size() + 3;
  HWY_ALIGN double gathered[3 * block * HWY_MAX_BYTES / sizeof(double)];
  V origin[3], middle[3][3], half[3][3];  // [axis][corner]
  LinearV<V> linear[3];
  V largest = hn::Zero(d);
  for (std::size_t from = 0; from < count; from += block) {
    const std::size_t to = std::min(count, from + block);
    gather_lanes(points, control, count, from, to, out.size(), lanes, gathered);
    for (std::size_t a = 0; a < 3; ++a) {
      const auto load = [&](std::size_t i)
                            HWY_ATTR { return hn::Load(d, gathered + (3 * (i - from) + a) * lanes); };
      std::size_t i = from;
      if (from == 0) {
        origin[a] = load(0);
        linear[a] = {hn::Sub(load(1), origin[a]), hn::Sub(load(2), origin[a])};
        largest = hn::Max(largest, hn::Max(hn::Abs(linear[a].along_one), hn::Abs(linear[a].along_two)));
        for (std::size_t k = 0; k < 3; ++k) {
          middle[a][k] = at(d, linear[a], (*table.triangle)[k][0], (*table.triangle)[k][1]);
          half[a][k] = hn::Zero(d);
        }
        i = 3;
      }
      const V o = origin[a];
      const LinearV<V> l = linear[a];
      V m0 = middle[a][0], m1 = middle[a][1], m2 = middle[a][2];
      V h0 = half[a][0], h1 = half[a][1], h2 = half[a][2];
      for (; i < to; ++i) {
        const TableColumn& column = table.columns[i - 3];
        const V c = hn::Sub(load(i), o);
        largest = hn::Max(largest, hn::Abs(c));
        const V off = hn::Sub(c, at(d, l, column.u, column.v));
        const V size = hn::Abs(off);
        m0 = hn::Add(m0, hn::Mul(off, hn::Set(d, column.middle[0])));
        m1 = hn::Add(m1, hn::Mul(off, hn::Set(d, column.middle[1])));
        m2 = hn::Add(m2, hn::Mul(off, hn::Set(d, column.middle[2])));
        h0 = hn::Add(h0, hn::Mul(size, hn::Set(d, column.half[0])));
        h1 = hn::Add(h1, hn::Mul(size, hn::Set(d, column.half[1])));
        h2 = hn::Add(h2, hn::Mul(size, hn::Set(d, column.half[2])));
      }
      middle[a][0] = m0;
      middle[a][1] = m1;
      middle[a][2] = m2;
      half[a][0] = h0;
      half[a][1] = h1;
      half[a][2] = h2;
    }
  }

  V placed = hn::Zero(d), probe = hn::Zero(d);
  for (std::size_t a = 0; a < 3; ++a) {
    for (V& m : middle[a]) {
      m = hn::Add(origin[a], m);
      placed = hn::Max(placed, hn::Abs(m));
      probe =
          hn::Add(probe, hn::Sub(m, m));  // stays 0 unless one is not finite, whatever maxima make of that
    }
  }
  const V given =
      hn::Add(hn::Mul(hn::Set(d, table.error_of_largest), largest), hn::Set(d, table.error_at_least));
  const V error = hn::Add(given, hn::Mul(hn::Set(d, unit_roundoff * (1 + 0x1p-42)), placed));
  V farthest_sq = hn::Zero(d);
  for (std::size_t k = 0; k < 3; ++k) {
    V sum = hn::Zero(d);
    for (std::size_t a = 0; a < 3; ++a) {
      const V h = hn::Add(half[a][k], error);
      sum = hn::Add(sum, hn::Mul(h, h));
    }
    farthest_sq = hn::Max(farthest_sq, sum);
  }
  const V root = hn::Sqrt(hn::Add(farthest_sq, hn::Set(d, 8 * underflow_error)));
  const V radius = hn::Add(hn::Mul(root, hn::Set(d, 1 + 0x1p-42)), hn::Set(d, underflow_error));
  const auto finite = hn::And(hn::Lt(radius, hn::Set(d, INFINITY)), hn::Eq(probe, hn::Zero(d)));
  const V answer = hn::IfThenElse(finite, radius, hn::Set(d, INFINITY));

  HWY_ALIGN double lane[11 * HWY_MAX_BYTES / sizeof(double)];
  for (std::size_t k = 0; k < 3; ++k) {
    for (std::size_t a = 0; a < 3; ++a) hn::Store(middle[a][k], d, lane + (3 * k + a) * lanes);
  }
  hn::Store(answer, d, lane + 9 * lanes);
  hn::Store(hn::Mul(hn::Set(d, spatial_error(1)), error), d, lane + 10 * lanes);
  scatter_lanes(lane, lanes, out);
}

void FitTable(const FlatTable& table, std::span<const Point3> points, const VertexId* control,
              std::span<OffsetTriangle> out) {
  const hn::ScalableTag<double> d;
  const std::size_t lanes = hn::Lanes(d), count = table.columns.size() + 3;
  for (std::size_t begin = 0; begin < out.size(); begin += lanes) {
    fit_lanes(d, table, points, control + count * begin,
              out.subspan(begin, std::min(lanes, out.size() - begin)));
  }
}

}  // namespace
}  // namespace snug::kernels::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace snug::kernels {

HWY_EXPORT(FitTable);

void fit_table(const BoundTable& table, std::span<const Point3> points, std::span<const VertexId> control,
               std::span<OffsetTriangle> out) {
  SNUG_EXPECT(table.first_bounded() == 3);
  thread_local std::vector<TableColumn> memory;
  HWY_DYNAMIC_DISPATCH(FitTable)(flatten(table, memory), points, control.data(), out);
}

}  // namespace snug::kernels
#endif
