#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "snug/bounds/table_kernel.cpp"
#include <snug/geometry/vector_code-inl.h>
// After it.
#include <snug/bounds/lanes-inl.h>
#include <snug/bounds/table_boxes-inl.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include <snug/bounds/bound_table.h>
#include <snug/bounds/fit_kernels.h>
#include <snug/bounds/flat_table.h>
#include <snug/geometry/rounding.h>

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

// From sums to answers.
template <class D, class V = hn::Vec<D>>
HWY_INLINE void finish_lanes(D d, const FlatTable<double>& table, const LinearV<V>* linear,
                             TableSumsV<V>* sums, std::span<OffsetTriangle> out) {
  V placed = hn::Zero(d), probe = hn::Zero(d), largest = hn::Zero(d), off = hn::Zero(d);
  for (std::size_t a = 0; a < 3; ++a) {
    for (V& m : sums[a].middle) {
      m = hn::Add(linear[a].origin, m);
      placed = hn::Max(placed, hn::Abs(m));
      probe =
          hn::Add(probe, hn::Sub(m, m));  // stays 0 unless one is not finite, whatever maxima make of that
    }
    largest = hn::Max(largest, sums[a].largest);
    off = hn::Max(off, sums[a].off);
  }
  const V given = hn::Add(hn::Add(hn::Mul(hn::Set(d, table.error_of_largest), largest),
                                  hn::Mul(hn::Set(d, table.error_of_offset), off)),
                          hn::Set(d, table.error_at_least));
  const V error = hn::Add(given, hn::Mul(hn::Set(d, unit_roundoff * (1 + 0x1p-42)), placed));
  V farthest_sq = hn::Zero(d);
  for (std::size_t k = 0; k < 3; ++k) {
    V sum = hn::Zero(d);
    for (std::size_t a = 0; a < 3; ++a) {
      const V h = hn::Add(sums[a].half[k], error);
      sum = hn::Add(sum, hn::Mul(h, h));
    }
    farthest_sq = hn::Max(farthest_sq, sum);
  }
  const V root = hn::Sqrt(hn::Add(farthest_sq, hn::Set(d, 8 * underflow_error)));
  const V radius = hn::Add(hn::Mul(root, hn::Set(d, 1 + 0x1p-42)), hn::Set(d, underflow_error));
  const auto finite = hn::And(hn::Lt(radius, hn::Set(d, INFINITY)), hn::Eq(probe, hn::Zero(d)));
  const V answer = hn::IfThenElse(finite, radius, hn::Set(d, INFINITY));

  Vec3<V> corner[3];
  for (std::size_t k = 0; k < 3; ++k) corner[k] = {sums[0].middle[k], sums[1].middle[k], sums[2].middle[k]};
  hand_out(d, corner, answer, hn::Mul(hn::Set(d, spatial_error(1)), error), out);
}

template <class D, class V = hn::Vec<D>>
HWY_INLINE void fit_lanes(D d, const FlatTable<double>& table, std::span<const Point3> points,
                          const VertexId* which, std::span<OffsetTriangle> out) {
  const std::size_t count = table.columns.size() + table.first;
  GatheredControl control(points, which, count, out.size(), hn::Lanes(d));
  LinearV<V> linear[3];
  begin_linear(d, table, control, linear);
  for (std::size_t from = 0; table.first == 0 && from < count; from += block) {
    const std::size_t to = std::min(count, from + block);
    control.take(from, to);
    add_to_linear(d, table, control, from, to, linear);
  }
  TableSumsV<V> sums[3];
  begin_boxes(d, linear, sums);
  for (std::size_t from = 0; from < count; from += block) {
    const std::size_t to = std::min(count, from + block);
    control.take(from, to);
    add_to_boxes(d, table, control, from, to, linear, sums);
  }
  end_boxes(d, table, linear, sums);
  finish_lanes(d, table, linear, sums, out);
}

void FitTable(const FlatTable<double>& table, std::span<const Point3> points, const VertexId* control,
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
  thread_local std::vector<TableColumn<double>> memory;
  HWY_DYNAMIC_DISPATCH(FitTable)(flatten(table, kind, memory), points, control.data(), out);
}

}  // namespace snug::kernels
#endif
