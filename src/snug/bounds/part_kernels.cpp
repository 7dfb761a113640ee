#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "snug/bounds/part_kernels.cpp"
#include <snug/geometry/vector_code-inl.h>
// After it.
#include <snug/bounds/lanes-inl.h>
#include <snug/bounds/planar_triangle-inl.h>

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

template <class D, class V = hn::Vec<D>>
HWY_INLINE Vec3<V> zero3(D d) {
  return {hn::Zero(d), hn::Zero(d), hn::Zero(d)};
}
template <class V>
HWY_INLINE V largest_of(const Vec3<V>& v) {
  return max3(hn::Abs(v.x), hn::Abs(v.y), hn::Abs(v.z));
}
template <class D, class V = hn::Vec<D>>
HWY_INLINE void add_scaled(D d, double weight, const Vec3<V>& p, Vec3<V>& sum) {
  sum = add(sum, scaled(hn::Set(d, weight), p));
}

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

template <class D, class V = hn::Vec<D>>
HWY_INLINE Vec3<V> product(D d, const Stencils& rows, std::size_t r, const Lanes& control) {
  Vec3<V> sum = zero3(d);
  const Stencils::Row row = rows.row(r);
  for (std::size_t i = 0; i < row.sources.size(); ++i) {
    add_scaled(d, row.weights[i], load(d, control, row.sources[i]), sum);
  }
  return sum;
}

// Corners and middles of edges in the frame.
template <class V>
struct QuadraticV {
  Vec3<V> q[6];
};
template <class D, class V = hn::Vec<D>>
HWY_INLINE QuadraticV<V> restricted(D d, const QuadraticV<V>& whole,
                                    const QuadraticRows::Restriction& weights) {
  QuadraticV<V> part;
  for (std::size_t k = 0; k < 6; ++k) {
    part.q[k] = zero3(d);
    for (std::size_t i = 0; i < 6; ++i) add_scaled(d, weights[k][i], whole.q[i], part.q[k]);
  }
  return part;
}

// Bounds of differences: whatever the direction, and along the one across the quadratic.
template <class V>
struct ApartV {
  V any, along;
};

// Numbers of parts or patches as lanes; lanes beyond them repeat the last.
template <class D, class Of, class V = hn::Vec<D>>
HWY_INLINE V lanes_of(D d, std::size_t here, const Of& of) {
  HWY_ALIGN double lane[HWY_MAX_BYTES / sizeof(double)];
  for (std::size_t l = 0; l < hn::Lanes(d); ++l) lane[l] = of(std::min(l, here - 1));
  return hn::Load(d, lane);
}
template <class D, class Of, class V = hn::Vec<D>>
HWY_INLINE Vec3<V> lanes3_of(D d, std::size_t here, const Of& of) {
  HWY_ALIGN double lane[3 * HWY_MAX_BYTES / sizeof(double)];
  const std::size_t lanes = hn::Lanes(d);
  for (std::size_t l = 0; l < lanes; ++l) {
    const Vector3& v = of(std::min(l, here - 1));
    lane[l] = v.x;
    lane[lanes + l] = v.y;
    lane[2 * lanes + l] = v.z;
  }
  return {hn::Load(d, lane), hn::Load(d, lane + lanes), hn::Load(d, lane + 2 * lanes)};
}
template <class D, class To, class V = hn::Vec<D>>
HWY_INLINE void hand_out(D d, std::size_t here, V v, const To& to) {
  HWY_ALIGN double lane[HWY_MAX_BYTES / sizeof(double)];
  hn::Store(v, d, lane);
  for (std::size_t l = 0; l < here; ++l) to(l) = lane[l];
}
template <class D, class To, class V = hn::Vec<D>>
HWY_INLINE void hand_out(D d, std::size_t here, const Vec3<V>& v, const To& to) {
  HWY_ALIGN double lane[3 * HWY_MAX_BYTES / sizeof(double)];
  const std::size_t lanes = hn::Lanes(d);
  hn::Store(v.x, d, lane);
  hn::Store(v.y, d, lane + lanes);
  hn::Store(v.z, d, lane + 2 * lanes);
  for (std::size_t l = 0; l < here; ++l) to(l) = {lane[l], lane[lanes + l], lane[2 * lanes + l]};
}

// The control points of parts.
template <class PatchOf>
HWY_INLINE void gather(std::size_t here, const PatchOf& patch_of, const Lanes& to) {
  for (std::size_t l = 0; l < to.lanes; ++l) {
    double* at = to.first + l;
    for (const Vector3& p : patch_of(std::min(l, here - 1)).points) {
      at[0] = p.x;
      at[to.lanes] = p.y;
      at[2 * to.lanes] = p.z;
      at += 3 * to.lanes;
    }
  }
}

// What is known of the points whose hull contains a part, in its patch's frame.
template <class D, class V = hn::Vec<D>>
class HullV {
 public:
  HWY_INLINE HullV(D d, const PlanarTriangle<V>& t, V axis_x, V axis_y, V middle, const Vec3<V>& across)
      : direction(across), d_(d), t_(t), axis_x_(axis_x), axis_y_(axis_y), middle_(middle) {
    far_sq = most_sq = most_along = hn::Zero(d);
    for (std::size_t a = 0; a < 3; ++a) {
      lower[a] = hn::Set(d, INFINITY);
      upper[a] = hn::Set(d, -INFINITY);
    }
  }
  // A Bezier point, that of a row.
  HWY_INLINE void add(const BoundingRows& rows, std::size_t r, const QuadraticV<V>& quadratic,
                      const Vec3<V>& p) {
    place(p, hn::Zero(d_));
    far_sq = hn::Max(far_sq, distance_sq_of(p));
    Vec3<V> rest = p;
    for (std::size_t k = 0; k < 6; ++k) {
      rest = sub(rest, scaled(hn::Set(d_, rows.quadratic(k)[r]), quadratic.q[k]));
    }
    most_sq = hn::Max(most_sq, dot(rest, rest));
    most_along = hn::Max(most_along, hn::Abs(dot(direction, rest)));
  }
  // What is within a distance of a triangle; how far from the base that may be.
  HWY_INLINE V add(const Vec3<V> (&corner)[3], V distance) {
    V farthest_sq = hn::Zero(d_);
    for (const Vec3<V>& p : corner) {
      place(p, distance);
      farthest_sq = hn::Max(farthest_sq, distance_sq_of(p));
    }
    return hn::Add(hn::Sqrt(hn::Add(farthest_sq, hn::Set(d_, 8 * underflow_error))), distance);
  }

  const Vec3<V> direction;
  V lower[3], upper[3];  // along an axis in the plane, across it, along the normal
  V far_sq;              // from the base
  V most_sq, most_along;

 private:
  HWY_INLINE V distance_sq_of(const Vec3<V>& p) const {
    return distance_sq(d_, t_, foot_of(d_, t_, p.x, p.y, hn::Sub(p.z, middle_)));
  }
  HWY_INLINE void place(const Vec3<V>& p, V reach) {
    const V at[3] = {hn::Add(hn::Mul(axis_x_, p.x), hn::Mul(axis_y_, p.y)),
                     hn::Sub(hn::Mul(axis_x_, p.y), hn::Mul(axis_y_, p.x)), p.z};
    for (std::size_t a = 0; a < 3; ++a) {
      lower[a] = hn::Min(lower[a], hn::Sub(at[a], reach));
      upper[a] = hn::Max(upper[a], hn::Add(at[a], reach));
    }
  }
  D d_;
  const PlanarTriangle<V>& t_;
  V axis_x_, axis_y_, middle_;
};

// The quarter at an extraordinary corner some levels down: its net, what coordinates of that are off by, the quadratic over it;
// how far both are apart, its corners, and how far the quarter is from their triangle.
template <class V>
struct TipV {
  Lanes net;
  V error;
  QuadraticV<V> quadratic;
  ApartV<V> apart;
  Vec3<V> corner[3];
  V from_corners;
};

// As QuadraticRows::distance(); no coordinate is larger than `size`.
template <class D, class V = hn::Vec<D>>
HWY_INLINE void measure(D d, const PartRows& rows, const Vec3<V>& direction, V size, TipV<V>& tip) {
  const QuadraticRows& by = *rows.quadratic;
  Vec3<V>(&corner)[3] = tip.corner;
  for (std::size_t k = 0; k < 3; ++k) corner[k] = product(d, rows.kind->corner_limits(), k, tip.net);
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
    const Vec3<V> off = sub(load(d, tip.net, i), add(corner[0], on_layout(at)));
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
  tip.apart = {hn::Mul(wide, hn::Add(by_functions, root(rest_sq))),
               hn::Mul(wide, hn::Add(hn::Add(functions_along, rest_along), doubt))};
  tip.from_corners = hn::Mul(wide, hn::Add(by_functions, root(layout_sq)));
}

// Replaces a tip by a level of Bezier points and a smaller tip, whose net comes to `next`.
template <class D, class V = hn::Vec<D>>
HWY_INLINE void refine(D d, const PartRows& rows, V size, const Lanes& next, HullV<D>& hull, TipV<V>& tip) {
  const BoundingRows& level = *rows.rows;
  each_product(d, level, 0, level.count(), tip.net, [&](std::size_t r, const Vec3<V>& p) HWY_ATTR {
    if (r < level.bezier_count()) {
      hull.add(level, r, tip.quadratic, p);
    } else {
      store(d, p, next, r - level.bezier_count());
    }
  });
  tip.net = next;
  tip.quadratic = restricted(d, tip.quadratic, rows.quadratic->to_level_nets()[0]);
  tip.error = hn::Mul(hn::Set(d, generous), hn::Add(hn::Mul(hn::Set(d, level.result_error(0, 1)), tip.error),
                                                    hn::Mul(hn::Set(d, level.result_error(1, 0)), size)));
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

// Names of errors are those of derivations/quadratics.md, "Many patches at once".
template <class D, class V = hn::Vec<D>>
HWY_INLINE void bound_lanes(D d, const PartRows& kind, std::span<const PlacedPart> parts, unsigned levels,
                            double* memory, PartBounds* const* out) {
  const BoundingRows& rows = *kind.rows;
  const std::size_t lanes = hn::Lanes(d), count = rows.control_count(), here = parts.size();
  const V zero = hn::Zero(d);
  const PlanarTriangle<V> t = triangle_of(d, parts);
  const auto number = [&](double PatchFrame::*field) HWY_ATTR {
    return lanes_of(d, here, [&](std::size_t l) { return parts[l].frame->*field; });
  };
  TipV<V> part;
  part.apart = {zero, zero};
  part.net = Lanes{memory, lanes};
  const Lanes nets[2] = {{memory + 3 * lanes * count, lanes}, part.net};
  for (std::size_t k = 0; k < 6; ++k) {
    part.quadratic.q[k] = lanes3_of(d, here, [&](std::size_t l) -> const Vector3& {
      // Corner k of the kind is corner k + first of the part.
      return parts[l].frame->quadratic[parts[l].child][k < 3 ? (k + parts[l].patch->first) % 3
                                                             : 3 + (k + parts[l].patch->first) % 3];
    });
  }
  gather(
      here, [&](std::size_t l) -> const Patch& { return *parts[l].patch; }, part.net);
  V largest = zero, probe = zero;
  for (std::size_t k = 0; k < count; ++k) {
    const Vec3<V> r = sub(load(d, part.net, k), t.a);
    largest = hn::Max(largest, largest_of(r));
    probe = hn::Add(probe, hn::Add(hn::Sub(r.x, r.x), hn::Add(hn::Sub(r.y, r.y), hn::Sub(r.z, r.z))));
    store(d, Vec3<V>{dot(t.t1, r), dot(t.t2, r), dot(t.n, r)}, part.net, k);
  }
  largest = hn::Add(largest, probe);

  const double sum = std::max(1.0, rows.abs_sum());
  double growth = sum;
  if (kind.tip()) {
    growth = std::max(1.0, kind.kind->corner_limits().max_abs_sum());
    for (unsigned i = 0; i < levels; ++i) growth *= sum;
  }
  const double of_largest = enlarged(3 * (gamma_bound(count + 16) * sum + rows.entry_error()));
  const V given = lanes_of(d, here, [&](std::size_t l) { return parts[l].patch->error; });
  V error = hn::Add(hn::Mul(hn::Set(d, of_largest), largest), hn::Mul(hn::Set(d, 2 * generous * sum), given));
  // Not a number where a point is not finite, whatever a maximum makes of that.
  const V size = hn::Add(
      hn::Max(number(&PatchFrame::quadratic_size), hn::Mul(hn::Set(d, 2 * generous * growth), largest)),
      hn::Sub(largest, largest));

  HullV<D> hull(
      d, t, number(&PatchFrame::axis_x), number(&PatchFrame::axis_y), number(&PatchFrame::middle),
      lanes3_of(d, here, [&](std::size_t l) -> const Vector3& { return parts[l].frame->direction; }));
  part.error = error;
  V tip_base = zero;
  if (kind.tip()) {
    for (unsigned level = 0; level < levels; ++level) refine(d, kind, size, nets[level % 2], hull, part);
    measure(d, kind, hull.direction, size, part);
    tip_base = hull.add(part.corner, part.from_corners);
  } else {
    each_product(d, rows, 0, rows.bezier_count(), part.net,
                 [&](std::size_t r, const Vec3<V>& p) HWY_ATTR { hull.add(rows, r, part.quadratic, p); });
  }
  error = hn::Max(error, part.error);
  const V of_points = hn::Add(hn::Add(hn::Mul(hn::Set(d, spatial_error(1)), error),
                                      hn::Mul(hn::Set(d, 2 * gamma_bound(quadratic_roundings)), size)),
                              hn::Set(d, tiny));
  const auto root = [&](V square)
                        HWY_ATTR { return hn::Sqrt(hn::Add(square, hn::Set(d, 8 * underflow_error))); };
  const V any = hn::Add(root(hull.most_sq), of_points);
  const V along = hn::Add(hn::Add(hull.most_along, of_points), hn::Mul(hn::Set(d, 16 * unit_roundoff), any));
  for (std::size_t a = 0; a < 3; ++a) {
    hand_out(d, here, hull.lower[a], [&](std::size_t l) -> double& { return out[l]->lower[a]; });
    hand_out(d, here, hull.upper[a], [&](std::size_t l) -> double& { return out[l]->upper[a]; });
  }
  const std::pair<PartBounds::Distances PartBounds::*, std::array<V, 3>> distances[] = {
      {&PartBounds::points, {root(hull.far_sq), any, along}},
      {&PartBounds::tip, {tip_base, part.apart.any, part.apart.along}}};
  for (const auto& [of, v] : distances) {
    hand_out(d, here, v[0], [&, of = of](std::size_t l) -> double& { return (out[l]->*of).base; });
    hand_out(d, here, v[1], [&, of = of](std::size_t l) -> double& { return (out[l]->*of).quadratic; });
    hand_out(d, here, v[2], [&, of = of](std::size_t l) -> double& { return (out[l]->*of).along; });
  }
  hand_out(d, here, error, [&](std::size_t l) -> double& { return out[l]->error; });
  hand_out(d, here, size, [&](std::size_t l) -> double& { return out[l]->size; });
}

SNUG_FLAT void BoundParts(const PartRows& kind, std::span<const PlacedPart> parts, unsigned levels,
                          PartBounds* const* out) {
  const hn::ScalableTag<double> d;
  const std::size_t lanes = hn::Lanes(d);
  double* const memory = aligned_memory(6 * lanes * kind.kind->control_count());
  for (std::size_t begin = 0; begin < parts.size(); begin += lanes) {
    const std::size_t here = std::min(lanes, parts.size() - begin);
    bound_lanes(d, kind, parts.subspan(begin, here), levels, memory, out + begin);
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
    return PartRows{&kind, unsplit ? &library.rows(kind) : library.direct_rows(kind), &quadratic};
  }
  const BoundingRows& rows = library.level_rows(kind);
  const bool lasts = rows.nets().size() == 1 && rows.nets()[0].kind == &kind;
  if (quadratic.layout().empty() || !lasts) return {};
  return PartRows{&kind, &rows, &quadratic};
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
void bound_parts(const PartRows& rows, std::span<const PlacedPart> parts, unsigned levels,
                 std::span<PartBounds* const> out) {
  HWY_DYNAMIC_DISPATCH(BoundParts)(rows, parts, levels, out.data());
}

}  // namespace kernels
}  // namespace snug
#endif
