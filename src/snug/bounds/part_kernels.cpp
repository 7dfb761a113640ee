#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "snug/bounds/part_kernels.cpp"
#include <snug/geometry/vector_code-inl.h>
// After it.
#include <snug/bounds/lanes-inl.h>
#include <snug/bounds/planar_triangle-inl.h>
#include <snug/bounds/quadratic_lanes-inl.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <utility>
#include <vector>

#include <snug/bounds/part_kernels.h>
#include <snug/geometry/rounding.h>

HWY_BEFORE_NAMESPACE();
namespace snug::kernels::HWY_NAMESPACE {
namespace {

// Above losses by underflow; and the roundings of some hundred steps.
constexpr double tiny = 0x1p-500, generous = 1 + 0x1p-40;
// Of quadratics, of their parts, and of differences from these: roundings a coordinate.
constexpr std::size_t quadratic_roundings = 256;
// Of vectors with a smaller square no direction is taken: too much of it may be lost by underflow.
constexpr double least_square = 0x1p-900;
// What axes may lack to be orthonormal.
constexpr double max_stretch = 0x1p-46;

// `each(r, point)` for the products of rows [begin, end) of a matrix by columns; four rows at once.
template <class D, class Each, class V = hn::Vec<D>>
HWY_INLINE void each_product(D d, const BoundingRows& rows, std::size_t begin, std::size_t end,
                             const Lanes& control, const Each& each) {
  const std::size_t count = rows.control_count(), stride = rows.count();
  std::size_t r = begin;
  for (; r + 4 <= end; r += 4) {
    Vec3<V> s0 = zero3(d), s1 = s0, s2 = s0, s3 = s0;
    const double* w = rows.column(0) + r;
    for (std::size_t k = 0; k < count; ++k, w += stride) {
      const Vec3<V> c = load(d, control, k);
      add_scaled(d, w[0], c, s0);
      add_scaled(d, w[1], c, s1);
      add_scaled(d, w[2], c, s2);
      add_scaled(d, w[3], c, s3);
    }
    each(r, s0);
    each(r + 1, s1);
    each(r + 2, s2);
    each(r + 3, s3);
  }
  for (; r < end; ++r) {
    Vec3<V> sum = zero3(d);
    for (std::size_t k = 0; k < count; ++k) add_scaled(d, rows.weight(r, k), load(d, control, k), sum);
    each(r, sum);
  }
}

// The quarter at an extraordinary corner some levels down: its net among the new points of a step, what coordinates of that are
// off by, the quadratic over it.
template <class D, class V = hn::Vec<D>>
struct TipV {
  HWY_INLINE Vec3<V> net(D d, std::size_t i) const { return load(d, points, control[i]); }
  [[nodiscard]] auto name() const {
    return [of = control](std::uint32_t source) { return of[source]; };
  }
  Lanes points;
  const std::uint32_t* control;
  V error;
  QuadraticV<V> quadratic;
};

// Of a tip: how far it and its quadratic are apart, its corners, and how far it is from their triangle.
template <class V>
struct MeasuredTipV {
  ApartV<V> apart;
  Vec3<V> corner[3];
  V from_corners;
};

// As QuadraticRows::distance(); no coordinate is larger than `size`.
template <class D, class V = hn::Vec<D>>
HWY_INLINE MeasuredTipV<V> measure(D d, const PartRows& rows, const Vec3<V>& direction, V size,
                                   const TipV<D>& tip) {
  const QuadraticRows& by = *rows.quadratic;
  MeasuredTipV<V> measured;
  Vec3<V>(&corner)[3] = measured.corner;
  for (std::size_t k = 0; k < 3; ++k) {
    corner[k] = product(d, rows.kind->corner_limits(), k, tip.points, tip.name());
  }
  const Vec3<V> along_u = sub(corner[1], corner[0]), along_v = sub(corner[2], corner[0]);
  const auto on_layout = [&](const LayoutPoint& at) HWY_ATTR {
    return add(scaled(hn::Set(d, at[0]), along_u), scaled(hn::Set(d, at[1]), along_v));
  };
  const V zero = hn::Zero(d);
  Vec3<V> functions = zero3(d);
  V functions_along = zero;
  double reach = 0;
  for (std::size_t i = 0; i < by.layout().size(); ++i) {
    const LayoutPoint& at = by.layout()[i];
    const V weight = hn::Set(d, by.largest()[i]);
    const Vec3<V> off = sub(tip.net(d, i), add(corner[0], on_layout(at)));
    functions = add(functions, scaled(weight, Vec3<V>{hn::Abs(off.x), hn::Abs(off.y), hn::Abs(off.z)}));
    functions_along = hn::Add(functions_along, hn::Mul(weight, hn::Abs(dot(direction, off))));
    reach += by.largest()[i] * (1 + std::fabs(at[0]) + std::fabs(at[1]));
  }
  Vec3<V> linear[6];
  for (std::size_t k = 0; k < 3; ++k) {
    linear[k] = sub(corner[k], tip.quadratic.q[k]);
    linear[3 + k] = sub(scaled(hn::Set(d, 0.5), add(corner[k], corner[(k + 1) % 3])), tip.quadratic.q[3 + k]);
  }
  V layout_sq = zero, rest_sq = zero, rest_along = zero;
  for (const LayoutPoint& offset : by.offsets()) {
    const Vec3<V> by_layout = on_layout(offset);
    layout_sq = hn::Max(layout_sq, dot(by_layout, by_layout));
    for (const Vec3<V>& b : linear) {
      const Vec3<V> off = add(by_layout, b);
      rest_sq = hn::Max(rest_sq, dot(off, off));
      rest_along = hn::Max(rest_along, hn::Abs(dot(direction, off)));
    }
  }
  const double of_error = enlarged(spatial_error(reach));
  const double of_size =
      enlarged(of_error * 16 * unit_roundoff + 8 * (by.offset_error() + gamma_bound(quadratic_roundings)));
  const V doubt =
      hn::Add(hn::Add(hn::Mul(hn::Set(d, of_error), tip.error), hn::Mul(hn::Set(d, of_size), size)),
              hn::Set(d, tiny));
  const V underflow = hn::Set(d, 8 * underflow_error), wide = hn::Set(d, generous);
  const auto root = [&](V square) HWY_ATTR { return hn::Sqrt(hn::Add(square, underflow)); };
  const V by_functions = hn::Add(root(dot(functions, functions)), doubt);
  measured.apart = {hn::Mul(wide, hn::Add(by_functions, root(rest_sq))),
                    hn::Mul(wide, hn::Add(hn::Add(functions_along, rest_along), doubt))};
  measured.from_corners = hn::Mul(wide, hn::Add(by_functions, root(layout_sq)));
  return measured;
}

// Replaces a tip by a level of Bezier points and a smaller tip, of the points that come to `next`. Returns what coordinates of
// Bezier points are off by. `beyond`: the hull has the polynomial on the side that faces the corner.
template <class D, class V = hn::Vec<D>>
HWY_INLINE V refine(D d, const PartRows& rows, bool beyond, V size, const Lanes& next, HullV<D>& hull,
                    TipV<D>& tip) {
  const LevelStep& step = *rows.step;
  const std::size_t points = step.points.row_count(), bezier = beyond ? step.inner : step.bezier.row_count();
  for (std::size_t r = 0; r < points; ++r)
    store(d, product(d, step.points, r, tip.points, tip.name()), next, r);
  for (std::size_t r = 0; r < bezier; ++r) {
    const QuadraticWeights& weights = step.quadratic[r];
    hull.add([&](std::size_t k) { return weights[k]; }, tip.quadratic, product(d, step.bezier, r, next));
  }
  const auto passed_on = [&](const Stencils& by, V error) HWY_ATTR {
    return hn::Mul(hn::Set(d, generous), hn::Add(hn::Mul(hn::Set(d, by.result_error(0, 1)), error),
                                                 hn::Mul(hn::Set(d, by.result_error(1, 0)), size)));
  };
  tip.points = next;
  tip.quadratic = restricted(d, tip.quadratic, rows.quadratic->to_level_nets()[0]);
  tip.error = passed_on(step.points, tip.error);
  return passed_on(step.bezier, tip.error);
}

void ShapeParts(const PartRows& rows, std::span<const Patch* const> parts, PartShape* const* out) {
  const hn::ScalableTag<double> d;
  using V = hn::Vec<decltype(d)>;
  const std::size_t lanes = hn::Lanes(d), count = rows.kind->control_count();
  const Lanes control{aligned_memory(3 * lanes * count), lanes};
  const double* const fit = rows.quadratic->fit();
  for (std::size_t begin = 0; begin < parts.size(); begin += lanes) {
    const std::size_t here = std::min(lanes, parts.size() - begin);
    gather(
        here, [&](std::size_t l) -> const Patch& { return *parts[begin + l]; }, control);
    Vec3<V> quadratic[6];
    for (Vec3<V>& p : quadratic) p = zero3(d);
    for (std::size_t c = 0; c < count; ++c) {
      const Vec3<V> p = load(d, control, c);
      for (std::size_t k = 0; k < 6; ++k) add_scaled(d, fit[6 * c + k], p, quadratic[k]);
    }
    // Corner k of the kind is corner k + first of the part.
    const auto place = [&](std::size_t l, std::size_t k) { return (k + parts[begin + l]->first) % 3; };
    for (std::size_t k = 0; k < 3; ++k) {
      hand_out(d, here, product(d, rows.kind->corner_limits(), k, control),
               [&](std::size_t l) -> Vector3& { return out[begin + l]->corners[place(l, k)]; });
      hand_out(d, here, quadratic[k],
               [&](std::size_t l) -> Vector3& { return out[begin + l]->quadratic[place(l, k)]; });
      hand_out(d, here, quadratic[3 + k],
               [&](std::size_t l) -> Vector3& { return out[begin + l]->quadratic[3 + place(l, k)]; });
    }
  }
}

void MakeFrames(std::span<const PartShape> parts, std::size_t parts_of_each, std::span<PatchFrame> out) {
  const hn::ScalableTag<double> d;
  using V = hn::Vec<decltype(d)>;
  const std::size_t lanes = hn::Lanes(d);
  const V zero = hn::Zero(d), one = hn::Set(d, 1.0);
  const QuarterRows& quarters = quarter_rows();
  for (std::size_t begin = 0; begin < out.size(); begin += lanes) {
    const std::size_t here = std::min(lanes, out.size() - begin);
    const auto part = [&](std::size_t l, std::size_t child) -> const PartShape& {
      return parts[(begin + l) * parts_of_each + child];
    };
    Vec3<V> corner[3];
    for (std::size_t k = 0; k < 3; ++k) {
      const std::size_t child = parts_of_each == 1 ? 0 : k;
      corner[k] =
          lanes3_of(d, here, [&](std::size_t l) -> const Vector3& { return part(l, child).corners[k]; });
    }
    const PlanarTriangle<V> t = planar_triangle(d, corner[0], corner[1], corner[2]);
    QuadraticV<V> whole;
    for (Vec3<V>& p : whole.q) p = zero3(d);
    for (std::size_t child = 0; child < parts_of_each; ++child) {
      for (std::size_t i = 0; i < 6; ++i) {
        Vec3<V> p =
            lanes3_of(d, here, [&](std::size_t l) -> const Vector3& { return part(l, child).quadratic[i]; });
        p = sub(p, t.a);
        const Vec3<V> in_frame{dot(t.t1, p), dot(t.t2, p), dot(t.n, p)};
        if (parts_of_each == 1) {
          whole.q[i] = in_frame;
        } else {
          for (std::size_t k = 0; k < 6; ++k)
            add_scaled(d, quarters.from_child[child][k][i], in_frame, whole.q[k]);
        }
      }
    }
    V size = zero, low = hn::Set(d, INFINITY), high = hn::Set(d, -INFINITY);
    for (const Vec3<V>& p : whole.q) size = hn::Max(size, largest_of(p));
    for (std::size_t child = 0; child < 4; ++child) {
      const QuadraticV<V> over_part = restricted(d, whole, quarters.to_child[child]);
      for (std::size_t k = 0; k < 6; ++k) {
        low = hn::Min(low, over_part.q[k].z);
        high = hn::Max(high, over_part.q[k].z);
        hand_out(d, here, parts_of_each == 1 ? whole.q[k] : over_part.q[k],
                 [&](std::size_t l) -> Vector3& { return out[begin + l].quadratic[child][k]; });
      }
    }
    const Vec3<V> area = cross(sub(whole.q[1], whole.q[0]), sub(whole.q[2], whole.q[0]));
    const auto second = hn::Gt(t.l1, t.l0), third = hn::Gt(t.l2, hn::Max(t.l0, t.l1));
    const auto to = [&](auto field) {
      return [&out, begin, field ](std::size_t l) -> auto& { return out[begin + l].*field; };
    };
    hand_out(d, here, t.a, to(&PatchFrame::a));
    hand_out(d, here, t.t1, to(&PatchFrame::t1));
    hand_out(d, here, t.t2, to(&PatchFrame::t2));
    hand_out(d, here, t.n, to(&PatchFrame::n));
    const V square = dot(area, area);
    const V over_length =
        hn::IfThenElseZero(hn::Ge(square, hn::Set(d, least_square)), hn::Div(one, hn::Sqrt(square)));
    hand_out(d, here, scaled(over_length, area), to(&PatchFrame::direction));
    const std::pair<double PatchFrame::*, V> numbers[] = {
        {&PatchFrame::l0, t.l0},
        {&PatchFrame::l1, t.l1},
        {&PatchFrame::l2, t.l2},
        {&PatchFrame::xc, t.xc},
        {&PatchFrame::yc, t.yc},
        {&PatchFrame::d1x, t.d1x},
        {&PatchFrame::d1y, t.d1y},
        {&PatchFrame::d2x, t.d2x},
        {&PatchFrame::d2y, t.d2y},
        {&PatchFrame::axis_x, hn::IfThenElse(third, t.d2x, hn::IfThenElse(second, t.d1x, one))},
        {&PatchFrame::axis_y, hn::IfThenElse(third, t.d2y, hn::IfThenElse(second, t.d1y, zero))},
        // No -0: which of two zeros is the least depends on their order.
        {&PatchFrame::middle, hn::Mul(hn::Set(d, 0.5), hn::Add(hn::Add(low, high), zero))},
        {&PatchFrame::longest, t.longest},
        {&PatchFrame::deviation, t.deviation},
        {&PatchFrame::amplify, t.amplify},
        {&PatchFrame::stretch, t.stretch},
        {&PatchFrame::quadratic_size, size}};
    for (const auto& [field, v] : numbers) hand_out(d, here, v, to(field));
    auto good = hn::And(well_shaped(d, t), hn::Le(t.stretch, hn::Set(d, max_stretch)));
    good = hn::And(good, hn::Lt(hn::Add(size, square), hn::Set(d, INFINITY)));
    const std::uint32_t mask = bits(d, good);
    for (std::size_t l = 0; l < here; ++l) out[begin + l].good = (mask >> l & 1) != 0;
  }
}

template <class D, class V = hn::Vec<D>>
HWY_INLINE PlanarTriangle<V> triangle_of(D d, std::span<const PlacedPart> parts) {
  const auto v = [&](double PatchFrame::*field) HWY_ATTR {
    return lanes_of(d, parts.size(), [&](std::size_t l) { return parts[l].frame->*field; });
  };
  const auto v3 = [&](Vector3 PatchFrame::*field) HWY_ATTR {
    return lanes3_of(d, parts.size(),
                     [&](std::size_t l) -> const Vector3& { return parts[l].frame->*field; });
  };
  PlanarTriangle<V> t;
  t.a = v3(&PatchFrame::a);
  t.t1 = v3(&PatchFrame::t1);
  t.t2 = v3(&PatchFrame::t2);
  t.n = v3(&PatchFrame::n);
  t.l0 = v(&PatchFrame::l0);
  t.l1 = v(&PatchFrame::l1);
  t.l2 = v(&PatchFrame::l2);
  t.xc = v(&PatchFrame::xc);
  t.yc = v(&PatchFrame::yc);
  t.d1x = v(&PatchFrame::d1x);
  t.d1y = v(&PatchFrame::d1y);
  t.d2x = v(&PatchFrame::d2x);
  t.d2y = v(&PatchFrame::d2y);
  return t;
}

// The parts of one vector.
template <class D, class V = hn::Vec<D>>
class BoundLanes {
 public:
  // `memory`: memory_for() doubles a lane.
  HWY_INLINE BoundLanes(D d, const PartRows& kind, std::span<const PlacedPart> parts, double* memory,
                        PartBounds* const* out)
      : d_(d),
        kind_(kind),
        parts_(parts),
        out_(out),
        t_(triangle_of(d, parts)),
        hull_(d, t_, number(&PatchFrame::axis_x), number(&PatchFrame::axis_y), number(&PatchFrame::middle),
              lanes3_of(d, parts.size(),
                        [&](std::size_t l) -> const Vector3& { return parts[l].frame->direction; }),
              hn::Zero(d)),
        points_{{memory, hn::Lanes(d)}, {memory + 3 * hn::Lanes(d) * count_in(kind), hn::Lanes(d)}} {}

  // Points beside control points, twice.
  [[nodiscard]] static std::size_t memory_for(const PartRows& kind) { return 6 * count_in(kind); }

  HWY_INLINE void bound_polynomial() {
    const BoundingRows& rows = *kind_.rows;
    const double sum = std::max(1.0, rows.abs_sum());
    begin(sum, sum, rows.entry_error(), [](std::size_t i) { return i; });
    const QuadraticV<V> quadratic = quadratic_over_part();
    each_product(d_, rows, 0, rows.bezier_count(), points_[0], [&](std::size_t r, const Vec3<V>& p) HWY_ATTR {
      hull_.add([&](std::size_t k) { return rows.quadratic(k)[r]; }, quadratic, p);
    });
    put_out(false);
  }

  HWY_INLINE void bound_tip(const TipLevels& levels) {
    const LevelStep& step = *kind_.step;
    const std::vector<std::uint32_t>& control = step.nets[0].control;
    TipV<D> tip{points_[0], control.data(), hn::Zero(d_), {}};
    if (levels.first == 0) {
      double growth = std::max({1.0, kind_.kind->corner_limits().max_abs_sum(), step.bezier.max_abs_sum()});
      for (unsigned i = 0; i < deepest_part_tip; ++i) growth *= std::max(1.0, step.points.max_abs_sum());
      begin(1, growth, 0, [&](std::size_t i) { return control[i]; });
      tip.quadratic = quadratic_over_part();
      tip.error = error_;
    } else {
      go_on(tip);
    }
    for (unsigned level = levels.first; level < levels.last; ++level) {
      error_ = hn::Max(
          error_, refine(d_, kind_, level > 0, size_, points_[1 - (level - levels.first) % 2], hull_, tip));
    }
    put_out(levels.first > 0);
    const MeasuredTipV<V> measured = measure(d_, kind_, hull_.direction, size_, tip);
    put_out_tip(measured);
    for (std::size_t i = 0; i < control.size(); ++i) {
      hand_out(d_, parts_.size(), tip.net(d_, i),
               [&](std::size_t l) -> Vector3& { return parts_[l].tip->net[i]; });
    }
    for (std::size_t k = 0; k < 6; ++k) {
      hand_out(d_, parts_.size(), tip.quadratic.q[k],
               [&](std::size_t l) -> Vector3& { return parts_[l].tip->quadratic[k]; });
    }
    hand_out(d_, parts_.size(), tip.error, [&](std::size_t l) -> double& { return parts_[l].tip->error; });
  }

 private:
  [[nodiscard]] static std::size_t count_in(const PartRows& kind) {
    return std::max(kind.kind->control_count(), kind.tip() ? kind.step->points.row_count() : 0);
  }
  HWY_INLINE V number(double PatchFrame::*field) const {
    return lanes_of(d_, parts_.size(), [&](std::size_t l) { return parts_[l].frame->*field; });
  }
  HWY_INLINE QuadraticV<V> quadratic_over_part() const {
    QuadraticV<V> quadratic;
    for (std::size_t k = 0; k < 6; ++k) {
      quadratic.q[k] = lanes3_of(d_, parts_.size(), [&](std::size_t l) -> const Vector3& {
        // Corner k of the kind is corner k + first of the part.
        return parts_[l].frame->quadratic[parts_[l].child][k < 3 ? (k + parts_[l].patch->first) % 3
                                                                 : 3 + (k + parts_[l].patch->first) % 3];
      });
    }
    return quadratic;
  }

  // Control points in the frame, at the places `to`, before rows with these sums and errors, whose products, and theirs, are `growth`
  // times as large at most. Names of errors are those of derivations/quadratics.md, "Many patches at once".
  template <class To>
  HWY_INLINE void begin(double sum, double growth, double entry_error, const To& to) {
    const std::size_t count = kind_.kind->control_count();
    gather(
        parts_.size(), [&](std::size_t l) -> const Patch& { return *parts_[l].patch; }, points_[1]);
    V largest = hn::Zero(d_), probe = largest;
    for (std::size_t k = 0; k < count; ++k) {
      const Vec3<V> r = sub(load(d_, points_[1], k), t_.a);
      largest = hn::Max(largest, largest_of(r));
      probe = hn::Add(probe, hn::Add(hn::Sub(r.x, r.x), hn::Add(hn::Sub(r.y, r.y), hn::Sub(r.z, r.z))));
      store(d_, Vec3<V>{dot(t_.t1, r), dot(t_.t2, r), dot(t_.n, r)}, points_[0], to(k));
    }
    largest = hn::Add(largest, probe);
    const double of_largest = enlarged(3 * (gamma_bound(count + 16) * sum + entry_error));
    const V given = lanes_of(d_, parts_.size(), [&](std::size_t l) { return parts_[l].patch->error; });
    error_ =
        hn::Add(hn::Mul(hn::Set(d_, of_largest), largest), hn::Mul(hn::Set(d_, 2 * generous * sum), given));
    // Not a number where a point is not finite, whatever a maximum makes of that.
    size_ = hn::Add(
        hn::Max(number(&PatchFrame::quadratic_size), hn::Mul(hn::Set(d_, 2 * generous * growth), largest)),
        hn::Sub(largest, largest));
  }

  // Where a call before ended.
  HWY_INLINE void go_on(TipV<D>& tip) {
    const std::size_t here = parts_.size();
    for (std::size_t i = 0; i < kind_.kind->control_count(); ++i) {
      const Vec3<V> p =
          lanes3_of(d_, here, [&](std::size_t l) -> const Vector3& { return parts_[l].tip->net[i]; });
      store(d_, p, tip.points, tip.control[i]);
    }
    for (std::size_t k = 0; k < 6; ++k) {
      tip.quadratic.q[k] =
          lanes3_of(d_, here, [&](std::size_t l) -> const Vector3& { return parts_[l].tip->quadratic[k]; });
    }
    tip.error = lanes_of(d_, here, [&](std::size_t l) { return parts_[l].tip->error; });
    error_ = lanes_of(d_, here, [&](std::size_t l) { return out_[l]->error; });
    size_ = lanes_of(d_, here, [&](std::size_t l) { return out_[l]->size; });
  }

  HWY_INLINE V root(V square) const { return hn::Sqrt(hn::Add(square, hn::Set(d_, 8 * underflow_error))); }
  // `more`: beside what is there.
  HWY_INLINE void put_out(bool more) {
    const V of_points = hn::Add(hn::Add(hn::Mul(hn::Set(d_, spatial_error(1)), error_),
                                        hn::Mul(hn::Set(d_, 2 * gamma_bound(quadratic_roundings)), size_)),
                                hn::Set(d_, tiny));
    const V any = hn::Add(root(hull_.most_sq), of_points);
    const V along =
        hn::Add(hn::Add(hull_.most_along, of_points), hn::Mul(hn::Set(d_, 16 * unit_roundoff), any));
    put_out(&PartBounds::points, more, hull_.lower, hull_.upper, {root(hull_.far_sq), any, along});
    hand_out(d_, parts_.size(), error_, [&](std::size_t l) -> double& { return out_[l]->error; });
    hand_out(d_, parts_.size(), size_, [&](std::size_t l) -> double& { return out_[l]->size; });
  }
  HWY_INLINE void put_out_tip(const MeasuredTipV<V>& tip) {
    V farthest_sq = hn::Zero(d_), lower[3], upper[3];
    for (std::size_t k = 0; k < 3; ++k) {
      const Vec3<V> at = hull_.along_axes(tip.corner[k]);
      const V height[3] = {at.x, at.y, at.z};
      for (std::size_t a = 0; a < 3; ++a) {
        lower[a] = k == 0 ? height[a] : hn::Min(lower[a], height[a]);
        upper[a] = k == 0 ? height[a] : hn::Max(upper[a], height[a]);
      }
      farthest_sq = hn::Max(farthest_sq, hull_.distance_sq_of(tip.corner[k]));
    }
    for (std::size_t a = 0; a < 3; ++a) {
      lower[a] = hn::Sub(lower[a], tip.from_corners);
      upper[a] = hn::Add(upper[a], tip.from_corners);
    }
    put_out(&PartBounds::tip, false, lower, upper,
            {hn::Add(root(farthest_sq), tip.from_corners), tip.apart.any, tip.apart.along});
  }
  HWY_INLINE void put_out(PartBounds::Reach PartBounds::*which, bool more, const V (&lower)[3],
                          const V (&upper)[3], const std::array<V, 3>& distances) {
    HWY_ALIGN double lane[9 * HWY_MAX_BYTES / sizeof(double)];
    const std::size_t lanes = hn::Lanes(d_);
    for (std::size_t a = 0; a < 3; ++a) {
      hn::Store(lower[a], d_, lane + a * lanes);
      hn::Store(upper[a], d_, lane + (3 + a) * lanes);
      hn::Store(distances[a], d_, lane + (6 + a) * lanes);
    }
    for (std::size_t l = 0; l < parts_.size(); ++l) {
      const auto at = [&](std::size_t i) { return lane[i * lanes + l]; };
      const PartBounds::Reach reach{{at(0), at(1), at(2)}, {at(3), at(4), at(5)}, at(6), at(7), at(8)};
      if (more) {
        (out_[l]->*which).add(reach);
      } else {
        out_[l]->*which = reach;
      }
    }
  }

  const D d_;
  const PartRows& kind_;
  std::span<const PlacedPart> parts_;
  PartBounds* const* out_;
  const PlanarTriangle<V> t_;
  HullV<D> hull_;
  const Lanes points_[2];
  V error_, size_;
};

SNUG_FLAT void BoundParts(const PartRows& kind, std::span<const PlacedPart> parts, const TipLevels& levels,
                          PartBounds* const* out) {
  const hn::ScalableTag<double> d;
  using Bounds = BoundLanes<std::remove_const_t<decltype(d)>>;
  const std::size_t lanes = hn::Lanes(d);
  double* const memory = aligned_memory(lanes * Bounds::memory_for(kind));
  for (std::size_t begin = 0; begin < parts.size(); begin += lanes) {
    Bounds bounds(d, kind, parts.subspan(begin, std::min(lanes, parts.size() - begin)), memory, out + begin);
    if (kind.tip()) {
      bounds.bound_tip(levels);
    } else {
      bounds.bound_polynomial();
    }
  }
}

}  // namespace
}  // namespace snug::kernels::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace snug {

std::optional<PartRows> PartRows::of(BoundsCache& library, const Kind& kind, bool unsplit) {
  if (!kind.cacheable() || (kind.polynomial() ? kind.form().degree == 1 : !has_self_similar_tips(kind))) {
    return {};
  }
  const QuadraticRows& quadratic = library.quadratic_rows(kind);
  if (kind.polynomial()) {
    return PartRows{&kind, unsplit ? &library.rows(kind) : library.direct_rows(kind), nullptr, &quadratic};
  }
  const LevelStep& step = library.level_step(kind);
  const bool lasts = step.nets.size() == 1 && step.nets[0].kind == &kind && step.goes_to(step.nets[0].own);
  if (quadratic.layout().empty() || !lasts) return {};
  return PartRows{&kind, nullptr, &step, &quadratic};
}

void PartBounds::Reach::add(const Reach& other) {
  for (std::size_t a = 0; a < 3; ++a) {
    lower[a] = std::min(lower[a], other.lower[a]);
    upper[a] = std::max(upper[a], other.upper[a]);
  }
  base = std::max(base, other.base);
  quadratic = std::max(quadratic, other.quadratic);
  along = std::max(along, other.along);
}

namespace kernels {

HWY_EXPORT(ShapeParts);
HWY_EXPORT(MakeFrames);
HWY_EXPORT(BoundParts);

void shape_parts(const PartRows& rows, std::span<const Patch* const> parts, std::span<PartShape* const> out) {
  HWY_DYNAMIC_DISPATCH(ShapeParts)(rows, parts, out.data());
}
void make_frames(std::span<const PartShape> parts, std::size_t parts_of_each, std::span<PatchFrame> out) {
  HWY_DYNAMIC_DISPATCH(MakeFrames)(parts, parts_of_each, out);
}
void bound_parts(const PartRows& rows, std::span<const PlacedPart> parts, TipLevels levels,
                 std::span<PartBounds* const> out) {
  if (rows.tip()) {
    for (const PlacedPart& part : parts) part.tip->net.resize(rows.kind->control_count());
  }
  HWY_DYNAMIC_DISPATCH(BoundParts)(rows, parts, levels, out.data());
}

}  // namespace kernels
}  // namespace snug
#endif
