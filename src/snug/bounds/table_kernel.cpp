#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "snug/bounds/table_kernel.cpp"
#include <snug/geometry/vector_code-inl.h>
// After it.
#include <snug/bounds/lanes-inl.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include <snug/base/contract.h>
#include <snug/bounds/bound_table.h>
#include <snug/bounds/fit_kernels.h>
#include <snug/geometry/rounding.h>

#ifndef SNUG_ENCLOSE_TABLE_KERNEL_ONCE
#define SNUG_ENCLOSE_TABLE_KERNEL_ONCE
namespace snug::kernels {
namespace {

// A bounded control point of a table: its place, its weights in the linear function, and the planes around
// its function at the table's corners as middle and half width.
struct TableColumn {
  double u, v;
  std::array<double, 3> linear, middle, half;
};

struct FlatTable {
  std::span<const TableColumn> columns;
  std::size_t first;  // bounded
  const std::array<LayoutPoint, 3>* triangle;
  double error_of_largest;  // times the largest |c - origin| of a patch
  double error_at_least;
};

double reach(const LayoutPoint& u) { return 1 + std::fabs(u[0]) + std::fabs(u[1]); }

// The half width covers the rounding of both. The error bounds that of centre and half width together:
// control points relative to the origin, the linear function, the sums; derivations/rounding.md, "Batches".
FlatTable flatten(const BoundTable& table, const Stencils* limits, std::vector<TableColumn>& memory) {
  const std::size_t count = table.control_count(), first = table.first_bounded();
  memory.clear();
  std::array<double, 3> gain;
  for (std::size_t k = 0; k < 3; ++k) gain[k] = reach(table.triangle[k]);
  for (std::size_t i = first; i < count; ++i) {
    TableColumn column{table.layout[i][0], table.layout[i][1], {}, {}, {}};
    for (std::size_t k = 0; k < 3; ++k) {
      const double low = table.lower[i - first][k], high = table.upper[i - first][k];
      const double most = std::max(std::fabs(low), std::fabs(high));
      column.middle[k] = 0.5 * (low + high);
      column.half[k] = enlarged(0.5 * (high - low) + 2 * unit_roundoff * most);
      gain[k] += reach(table.layout[i]) * (most + column.half[k]);
    }
    memory.push_back(column);
  }
  for (std::size_t k = 0; limits && k < 3; ++k) {
    const Stencils::Row row = limits->row(k);
    for (std::size_t i = 0; i < row.sources.size(); ++i) {
      std::array<double, 3>& linear = memory[row.sources[i]].linear;
      linear[k] += row.weights[i];
      if (k == 0) linear[1] -= row.weights[i], linear[2] -= row.weights[i];
    }
  }
  const double most = *std::max_element(gain.begin(), gain.end());
  const double terms = 12 * unit_roundoff + gamma_bound(count + 4);
  return {memory, first, &table.triangle, enlarged(2 * most * terms),
          enlarged((16 * most + 8 * static_cast<double>(count)) * underflow_error)};
}

}  // namespace
}  // namespace snug::kernels
#endif

HWY_BEFORE_NAMESPACE();
namespace snug::kernels::HWY_NAMESPACE {
namespace {

constexpr std::size_t block = 32;  // control points gathered at once

// Control points of a patch a lane, block by block; all of them stay where there is one block.
class GatheredControl {
 public:
  GatheredControl(std::span<const Point3> points, const VertexId* control, std::size_t count,
                  std::size_t here, std::size_t lanes)
      : points_(points), control_(control), count_(count), here_(here), lanes_(lanes) {
    take(0, std::min(count, block));
  }
  void take(std::size_t from, std::size_t to) {
    if (from == from_ && to == to_) return;
    gather_lanes(points_, control_, count_, from, to, here_, lanes_, gathered_);
    from_ = from;
    to_ = to;
  }
  [[nodiscard]] const double* at(std::size_t i, std::size_t axis) const {
    return gathered_ + (3 * (i - from_) + axis) * lanes_;
  }

 private:
  std::span<const Point3> points_;
  const VertexId* control_;
  std::size_t count_, here_, lanes_, from_ = 0, to_ = 0;
  HWY_ALIGN double gathered_[3 * block * HWY_MAX_BYTES / sizeof(double)];
};

// Linear function of a coordinate: through the first three control points, or about the limits of the corners.
template <class V>
struct LinearV {
  V origin, along_one, along_two;
};

template <class D, class V = hn::Vec<D>>
HWY_INLINE V from_origin(D d, const LinearV<V>& l, double u, double v) {
  return hn::Add(hn::Mul(hn::Set(d, u), l.along_one), hn::Mul(hn::Set(d, v), l.along_two));
}

template <class D, class V = hn::Vec<D>>
HWY_INLINE void through_first(D d, const GatheredControl& control, LinearV<V>* linear) {
  for (std::size_t a = 0; a < 3; ++a) {
    const V origin = hn::Load(d, control.at(0, a));
    linear[a] = {origin, hn::Sub(hn::Load(d, control.at(1, a)), origin),
                 hn::Sub(hn::Load(d, control.at(2, a)), origin)};
  }
}

// Whatever comes out is the linear function: it has no error.
template <class D, class V = hn::Vec<D>>
HWY_INLINE void through_limits(D d, const FlatTable& table, GatheredControl& control, LinearV<V>* linear) {
  for (std::size_t a = 0; a < 3; ++a) linear[a] = {hn::Zero(d), hn::Zero(d), hn::Zero(d)};
  for (std::size_t from = 0; from < table.columns.size(); from += block) {
    const std::size_t to = std::min(table.columns.size(), from + block);
    control.take(from, to);
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
}

// From sums to answers.
template <class D, class V = hn::Vec<D>>
HWY_INLINE void finish_lanes(D d, const FlatTable& table, const LinearV<V>* linear, V (&middle)[3][3],
                             const V (&half)[3][3], V largest, std::span<OffsetTriangle> out) {
  const std::size_t lanes = hn::Lanes(d);
  V placed = hn::Zero(d), probe = hn::Zero(d);
  for (std::size_t a = 0; a < 3; ++a) {
    for (V& m : middle[a]) {
      m = hn::Add(linear[a].origin, m);
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

template <class D, class V = hn::Vec<D>>
HWY_INLINE void fit_lanes(D d, const FlatTable& table, std::span<const Point3> points, const VertexId* which,
                          std::span<OffsetTriangle> out) {
  const std::size_t first = table.first, count = table.columns.size() + first;
  GatheredControl control(points, which, count, out.size(), hn::Lanes(d));
  LinearV<V> linear[3];
  if (first == 0) {
    through_limits(d, table, control, linear);
  } else {
    through_first(d, control, linear);
  }
  V middle[3][3], half[3][3];  // [axis][corner]
  V largest = hn::Zero(d);
  for (std::size_t a = 0; a < 3; ++a) {
    const LinearV<V>& l = linear[a];
    largest = hn::Max(largest, hn::Max(hn::Abs(l.along_one), hn::Abs(l.along_two)));
    for (std::size_t k = 0; k < 3; ++k) {
      middle[a][k] = from_origin(d, l, (*table.triangle)[k][0], (*table.triangle)[k][1]);
      half[a][k] = hn::Zero(d);
    }
  }
  for (std::size_t from = 0; from < count; from += block) {
    const std::size_t to = std::min(count, from + block);
    control.take(from, to);
    for (std::size_t a = 0; a < 3; ++a) {
      const LinearV<V> l = linear[a];
      V m0 = middle[a][0], m1 = middle[a][1], m2 = middle[a][2];
      V h0 = half[a][0], h1 = half[a][1], h2 = half[a][2];
      for (std::size_t i = std::max(from, first); i < to; ++i) {
        const TableColumn& column = table.columns[i - first];
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
      middle[a][0] = m0;
      middle[a][1] = m1;
      middle[a][2] = m2;
      half[a][0] = h0;
      half[a][1] = h1;
      half[a][2] = h2;
    }
  }
  finish_lanes(d, table, linear, middle, half, largest, out);
}

void FitTable(const FlatTable& table, std::span<const Point3> points, const VertexId* control,
              std::span<OffsetTriangle> out) {
  const hn::ScalableTag<double> d;
  const std::size_t lanes = hn::Lanes(d), count = table.columns.size() + table.first;
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

void fit_table(const BoundTable& table, const Kind& kind, std::span<const Point3> points,
               std::span<const VertexId> control, std::span<OffsetTriangle> out) {
  const std::size_t first = table.first_bounded();
  SNUG_EXPECT(first == 0 || first == 3);
  thread_local std::vector<TableColumn> memory;
  const FlatTable flat = flatten(table, first == 0 ? &kind.corner_limits() : nullptr, memory);
  HWY_DYNAMIC_DISPATCH(FitTable)(flat, points, control.data(), out);
}

}  // namespace snug::kernels
#endif
