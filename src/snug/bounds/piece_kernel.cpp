#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "snug/bounds/piece_kernel.cpp"
#include <snug/geometry/vector_code-inl.h>
// After it.
#include <snug/bounds/lanes-inl.h>
#include <snug/bounds/planar_triangle-inl.h>
#include <snug/bounds/quadratic_lanes-inl.h>
#include <snug/bounds/rows_lanes-inl.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>

#include <snug/bounds/piece_kernel.h>
#include <snug/geometry/rounding.h>
#include <support/contract.h>

HWY_BEFORE_NAMESPACE();
namespace snug::kernels::HWY_NAMESPACE {
namespace {

// How much tips may add to what the rest needs.
constexpr double max_tip_excess = 0.2;
// Roundings of quadratics, of their restrictions, and of differences from these, a coordinate.
constexpr std::size_t single_roundings = 96;
// Above what all operations lose by underflow.
constexpr double lost_to_underflow = 0x1p-100;
// Twice the area of the quadratic's corners, over the longest edge squared: no direction is taken of less.
constexpr double least_area_sq = 0x1p-60;
// Of larger triangles alone, and frames as in derivations/quadratics.md.
constexpr double least_longest = 0x1p-40, max_frame_stretch = 0x1p-46;
// How much of a bound may be rounding: a part of it.
constexpr double part_of_rounding = 64;

// Results for patches, in their frames: rows of lanes.
struct FoundLanes {
  float* first;
  std::size_t lanes;
  static constexpr std::size_t quadratic = 0, direction = 18, lower = 21, upper = 24, base = 27, apart = 28,
                               along = 29, middle = 30, size = 31, doubt = 32, good = 33, count = 34;
  [[nodiscard]] float* at(std::size_t row) const { return first + row * lanes; }
};

template <class D, class V = hn::Vec<D>>
class PieceLanes {
  using Rows = RowsWithTips<float>;

 public:
  // `given`: what coordinates of control points are off by.
  HWY_INLINE PieceLanes(D d, const Rows& rows, const RowsMemory<float>& memory, const PlanarTriangle<V>& t,
                        V axis_x, V axis_y, V largest, V given)
      : d_(d), rows_(rows), memory_(memory), t_(t), axis_x_(axis_x), axis_y_(axis_y) {
    const LanesOf<float>& control = memory.control;
    const std::size_t count = rows.kind().control_count();
    for (Vec3<V>& p : whole_.q) p = zero3(d);
    V largest_of[3] = {hn::Zero(d), hn::Zero(d), hn::Zero(d)};
    for (std::size_t c = 0; c < count; ++c) {
      const Vec3<V> p = load(d, control, c);
      take_size(p, largest_of);
      for (std::size_t k = 0; k < 6; ++k) add_scaled(d, rows.fit()[6 * c + k], p, whole_.q[k]);
    }
    V of_quadratic[3] = {hn::Zero(d), hn::Zero(d), hn::Zero(d)};
    for (const Vec3<V>& p : whole_.q) take_size(p, of_quadratic);
    const double passed_on = rows.error_of_points();
    const V of_points = hn::Add(hn::Mul(above(d, passed_on * 3 * gamma_bound(16)), largest),
                                hn::Mul(above(d, 2 * passed_on), given));
    for (std::size_t a = 0; a < 3; ++a) {
      error_[a] = hn::Add(hn::Add(of_points, hn::Mul(above(d, rows.error_of_largest()), largest_of[a])),
                          number(d, lost_to_underflow));
      size_[a] = hn::Max(of_quadratic[a], hn::Mul(above(d, rows.growth()), largest_of[a]));
    }
    const Vec3<V> edges[2] = {sub(whole_.q[1], whole_.q[0]), sub(whole_.q[2], whole_.q[0])};
    const V scale = hn::Div(number(d, 1), t.longest);
    const Vec3<V> area = cross(scaled(scale, edges[0]), scaled(scale, edges[1]));
    const V square = dot(area, area);
    // Of a length that is not above 1.
    const V over_length = hn::Div(number(d, 1 - 8 * roundoff_of<float>), hn::Sqrt(square));
    direction_ = scaled(hn::IfThenElseZero(hn::Ge(square, number(d, least_area_sq)), over_length), area);
    // Bezier points of its quarters, those that are no means of others.
    const Vec3<V>(&q)[6] = whole_.q;
    V low = hn::Min(q[0].z, hn::Min(q[1].z, q[2].z)), high = max3(q[0].z, q[1].z, q[2].z);
    const V inner = hn::Add(q[3].z, hn::Add(q[4].z, q[5].z)), half = number(d, 0.5),
            quarter = number(d, 0.25);
    for (std::size_t k = 0; k < 3; ++k) {
      const V inside = hn::Mul(quarter, hn::Add(q[k].z, inner)), next = q[(k + 1) % 3].z;
      low = hn::Min(low, hn::Min(inside, hn::Mul(half, hn::Add(hn::Min(q[k].z, next), q[3 + k].z))));
      high = hn::Max(high, hn::Max(inside, hn::Mul(half, hn::Add(hn::Max(q[k].z, next), q[3 + k].z))));
    }
    // No -0: which of two zeros is the least depends on their order.
    middle_ = hn::Mul(half, hn::Add(hn::Add(low, high), hn::Zero(d)));
    margin_ = hn::Add(hn::Add(error_[0], error_[1]), hn::Mul(number(d, 24 * roundoff_of<float>), t.longest));
  }

  HWY_INLINE void bound(unsigned levels, const FoundLanes& out) const {
    HullV<D> hull(d_, t_, axis_x_, axis_y_, middle_, direction_, margin_);
    Reach tips = nothing();
    add_level(rows_.first(), memory_.control, memory_.patch, whole_, hull);
    for (const Rows::Tip& tip : rows_.tips()) {
      NetLanes<float> net{memory_.patch, tip.control};
      QuadraticV<V> quadratic = restricted_to(tip.from_patch, whole_);
      for (unsigned level = 1; level < levels; ++level) {
        const LanesOf<float>& next = memory_.tip[level % 2];
        add_level(tip.levels[level], net.points, next, quadratic, hull);
        net = {next, tip.levels[level].tip_control};
        quadratic = restricted_to(tip.levels[level].to_tip, quadratic);
      }
      add_tip(tip.layout, net, quadratic, hull, tips);
    }
    put_out(bounds_of(hull), tips, out);
  }

 private:
  // As PartBounds::Reach, all errors included but that of heights above the base.
  struct Reach {
    V lower[3], upper[3], base, apart, along;
  };

  HWY_INLINE static void take_size(const Vec3<V>& p, V (&size)[3]) {
    size[0] = hn::Max(size[0], hn::Abs(p.x));
    size[1] = hn::Max(size[1], hn::Abs(p.y));
    size[2] = hn::Max(size[2], hn::Abs(p.z));
  }
  HWY_INLINE Reach nothing() const {
    const V zero = hn::Zero(d_), low = number(d_, INFINITY), high = number(d_, -INFINITY);
    return {{low, low, low}, {high, high, high}, zero, zero, zero};
  }
  HWY_INLINE V times(double factor, V v) const { return hn::Mul(above(d_, factor), v); }

  HWY_NOINLINE QuadraticV<V> restricted_to(const RestrictionOf<float>& weights,
                                           const QuadraticV<V>& quadratic) const {
    return restricted(d_, quadratic, weights);
  }
  // A step of points that comes to `next`. Called where it would be inlined in four places.
  HWY_NOINLINE void add_step(const Rows::Step& step, const LanesOf<float>& from, const LanesOf<float>& next,
                             const QuadraticV<V>& quadratic, HullV<D>& hull) const {
    each_product(d_, step.points, from,
                 [&](std::size_t r, const Vec3<V>& p) HWY_ATTR { store(d_, p, next, r); });
    each_product(d_, step.bezier, next, [&](std::size_t r, const Vec3<V>& p) HWY_ATTR {
      const std::array<float, 6>& weights = step.quadratic[r];
      hull.add([&](std::size_t k) { return weights[k]; }, quadratic, p);
    });
  }
  HWY_INLINE void add_level(const Rows::Level& level, const LanesOf<float>& from, const LanesOf<float>& next,
                            const QuadraticV<V>& quadratic, HullV<D>& hull) const {
    add_step(*level.step, from, next, quadratic, hull);
    if (level.middle == nullptr) return;
    add_step(*level.middle, next, memory_.middle, restricted_to(level.to_middle, quadratic), hull);
  }

  // The error of a vector, whatever its direction, and along that of the hull.
  HWY_INLINE V any_of(const V (&error)[3]) const { return hn::Add(error[0], hn::Add(error[1], error[2])); }
  HWY_INLINE V along_of(const V (&error)[3]) const {
    return hn::Add(
        hn::Mul(hn::Abs(direction_.x), error[0]),
        hn::Add(hn::Mul(hn::Abs(direction_.y), error[1]), hn::Mul(hn::Abs(direction_.z), error[2])));
  }
  HWY_INLINE V root(V square) const {
    return times(1 + 32 * roundoff_of<float>, hn::Sqrt(hn::Add(square, number(d_, 8 * underflow_of<float>))));
  }
  // Of heights along the axes, for points that are off by error_.
  HWY_INLINE void widen(const V (&lower)[3], const V (&upper)[3], V more, Reach& reach) const {
    const V aside = hn::Add(hn::Add(error_[0], error_[1]),
                            times(16 * roundoff_of<float>, hn::Add(hn::Add(size_[0], size_[1]), more)));
    const V across = hn::Add(error_[2], times(16 * roundoff_of<float>, hn::Add(size_[2], more)));
    for (std::size_t a = 0; a < 3; ++a) {
      const V by = hn::Add(more, a == 2 ? across : aside);
      reach.lower[a] = hn::Min(reach.lower[a], hn::Sub(lower[a], by));
      reach.upper[a] = hn::Max(reach.upper[a], hn::Add(upper[a], by));
    }
  }

  // Of differences from the quadratic.
  HWY_INLINE void find_errors(V (&error)[3]) const {
    for (std::size_t a = 0; a < 3; ++a)
      error[a] = hn::Add(error_[a], times(2 * gamma_bound<float>(single_roundings), size_[a]));
  }
  HWY_INLINE Reach bounds_of(const HullV<D>& hull) const {
    Reach reach = nothing();
    widen(hull.lower, hull.upper, hn::Zero(d_), reach);
    V error[3];
    find_errors(error);
    reach.base = root(hull.far_sq);
    reach.apart = hn::Add(root(hull.most_sq), any_of(error));
    reach.along =
        hn::Add(hn::Add(hull.most_along, along_of(error)), times(16 * roundoff_of<float>, reach.apart));
    return reach;
  }

  // As QuadraticRows::distance(). The corners as computed say what the affine map is, so that their errors are of no matter.
  HWY_INLINE void add_tip(const TipLayout<float>& layout, const NetLanes<float>& net,
                          const QuadraticV<V>& quadratic, const HullV<D>& hull, Reach& tips) const {
    const auto point = [&](std::size_t i) HWY_ATTR { return load(d_, net.points, net.control[i]); };
    Vec3<V> corner[3];
    for (std::size_t k = 0; k < 3; ++k) {
      corner[k] = zero3(d_);
      const std::vector<float>& weights = layout.to_corner[k];
      for (std::size_t i = 0; i < weights.size(); ++i) {
        if (weights[i] != 0) add_scaled(d_, weights[i], point(i), corner[k]);
      }
    }
    const Vec3<V> along_u = sub(corner[1], corner[0]), along_v = sub(corner[2], corner[0]);
    const auto on_layout = [&](float u, float v) HWY_ATTR {
      return add(scaled(hn::Set(d_, u), along_u), scaled(hn::Set(d_, v), along_v));
    };
    const V zero = hn::Zero(d_);
    Vec3<V> functions = zero3(d_);
    V functions_along = zero;
    for (std::size_t i = 0; i < layout.places.size(); ++i) {
      const auto& [u, v, largest] = layout.places[i];
      const V weight = hn::Set(d_, largest);
      const Vec3<V> off = sub(point(i), add(corner[0], on_layout(u, v)));
      functions = add(functions, scaled(weight, Vec3<V>{hn::Abs(off.x), hn::Abs(off.y), hn::Abs(off.z)}));
      functions_along = hn::Add(functions_along, hn::Mul(weight, hn::Abs(dot(direction_, off))));
    }
    Vec3<V> linear[6];
    for (std::size_t k = 0; k < 3; ++k) {
      linear[k] = sub(corner[k], quadratic.q[k]);
      linear[3 + k] = sub(scaled(number(d_, 0.5), add(corner[k], corner[(k + 1) % 3])), quadratic.q[3 + k]);
    }
    V layout_sq = zero, rest_sq = zero, rest_along = zero;
    for (const auto& [u, v] : layout.offsets) {
      const Vec3<V> by_layout = on_layout(u, v);
      layout_sq = hn::Max(layout_sq, dot(by_layout, by_layout));
      for (const Vec3<V>& b : linear) {
        const Vec3<V> off = add(by_layout, b);
        rest_sq = hn::Max(rest_sq, dot(off, off));
        rest_along = hn::Max(rest_along, hn::Abs(dot(direction_, off)));
      }
    }
    V error[3];
    for (std::size_t a = 0; a < 3; ++a) {
      error[a] = hn::Add(times(layout.reach, error_[a]),
                         times(32 * roundoff_of<float> * layout.reach + 8 * layout.offset_error +
                                   2 * gamma_bound<float>(single_roundings),
                               size_[a]));
    }
    const V by_functions = hn::Add(root(dot(functions, functions)), any_of(error));
    const V apart = hn::Add(by_functions, root(rest_sq)),
            from_corners = hn::Add(by_functions, root(layout_sq));
    tips.apart = hn::Max(tips.apart, apart);
    tips.along = hn::Max(
        tips.along, hn::Add(hn::Add(times(1 + 32 * roundoff_of<float>, hn::Add(functions_along, rest_along)),
                                    along_of(error)),
                            times(16 * roundoff_of<float>, apart)));
    Reach ends = nothing();
    V(&lower)[3] = ends.lower, (&upper)[3] = ends.upper;
    V farthest_sq = zero;
    for (const Vec3<V>& c : corner) {
      const Vec3<V> height = hull.along_axes(c);
      lower[0] = hn::Min(lower[0], height.x), upper[0] = hn::Max(upper[0], height.x);
      lower[1] = hn::Min(lower[1], height.y), upper[1] = hn::Max(upper[1], height.y);
      lower[2] = hn::Min(lower[2], height.z), upper[2] = hn::Max(upper[2], height.z);
      farthest_sq = hn::Max(farthest_sq, hull.distance_sq_of(c));
    }
    widen(lower, upper, from_corners, tips);
    tips.base = hn::Max(tips.base, hn::Add(root(farthest_sq), from_corners));
  }

  HWY_INLINE void put_out(const Reach& own, const Reach& tips, const FoundLanes& out) const {
    const auto put = [&](V v, std::size_t row) HWY_ATTR { hn::Store(v, d_, out.at(row)); };
    for (std::size_t k = 0; k < 6; ++k) {
      put(whole_.q[k].x, FoundLanes::quadratic + 3 * k);
      put(whole_.q[k].y, FoundLanes::quadratic + 3 * k + 1);
      put(whole_.q[k].z, FoundLanes::quadratic + 3 * k + 2);
    }
    put(direction_.x, FoundLanes::direction);
    put(direction_.y, FoundLanes::direction + 1);
    put(direction_.z, FoundLanes::direction + 2);
    for (std::size_t a = 0; a < 3; ++a) {
      put(hn::Min(own.lower[a], tips.lower[a]), FoundLanes::lower + a);
      put(hn::Max(own.upper[a], tips.upper[a]), FoundLanes::upper + a);
    }
    const V more = number(d_, 1 + 4 * roundoff_of<float>);
    const auto most = [&](V a, V b) HWY_ATTR { return hn::Mul(more, hn::Max(a, b)); };
    const V base = hn::Mul(more, hn::Add(most(own.base, tips.base), error_[2]));
    put(base, FoundLanes::base);
    put(most(own.apart, tips.apart), FoundLanes::apart);
    put(most(own.along, tips.along), FoundLanes::along);
    put(middle_, FoundLanes::middle);
    put(hn::Max(size_[0], hn::Max(size_[1], size_[2])), FoundLanes::size);
    V error[3];
    find_errors(error);
    put(hn::Add(hn::Add(error_[2], margin_), times(40 * roundoff_of<float>, base)), FoundLanes::doubt);
    const V allowed = number(d_, 1 + max_tip_excess), part = number(d_, part_of_rounding);
    auto good = hn::And(hn::Le(tips.base, hn::Mul(allowed, own.base)),
                        hn::Le(tips.apart, hn::Mul(allowed, own.apart)));
    good = hn::And(good, hn::And(hn::Le(hn::Mul(part, error_[2]), base),
                                 hn::Le(hn::Mul(number(d_, 32), margin_), base)));
    good = hn::And(good, hn::And(hn::Le(hn::Mul(part, any_of(error)), own.apart),
                                 hn::Le(hn::Mul(part, along_of(error)), own.along)));
    put(hn::IfThenElseZero(good, number(d_, 1)), FoundLanes::good);
  }

  const D d_;
  const Rows& rows_;
  const RowsMemory<float>& memory_;
  const PlanarTriangle<V>& t_;
  V axis_x_, axis_y_;
  QuadraticV<V> whole_;
  V error_[3], size_[3];  // of coordinates of points, and what none of those and of the quadratic exceeds
  Vec3<V> direction_;
  V middle_, margin_;
};

// From lanes to the patches of a vector of doubles.
template <class D, class V = hn::Vec<D>>
HWY_NOINLINE void hand_out_frames(D d, const PlanarTriangle<V>& t, V axis_x, V axis_y, V largest,
                                  const FoundLanes& found, std::size_t from,
                                  std::span<const PieceToFit> pieces) {
  const std::size_t here = pieces.size();
  const auto of = [&](std::size_t row) HWY_ATTR { return load_as(d, found.at(row) + from); };
  const auto of3 = [&](std::size_t row) HWY_ATTR { return Vec3<V>{of(row), of(row + 1), of(row + 2)}; };
  const auto frame = [&](auto field) {
    return [&pieces, field ](std::size_t l) -> auto& { return pieces[l].frame->*field; };
  };
  // Corner k of the kind is corner k + first of the patch.
  const auto place = [&](std::size_t l, std::size_t k) { return (k + pieces[l].patch->first) % 3; };
  for (std::size_t k = 0; k < 3; ++k) {
    hand_out(d, here, of3(FoundLanes::quadratic + 3 * k),
             [&](std::size_t l) -> Vector3& { return pieces[l].frame->quadratic[0][place(l, k)]; });
    hand_out(d, here, of3(FoundLanes::quadratic + 9 + 3 * k),
             [&](std::size_t l) -> Vector3& { return pieces[l].frame->quadratic[0][3 + place(l, k)]; });
  }
  hand_out(d, here, t.a, frame(&PatchFrame::a));
  hand_out(d, here, t.t1, frame(&PatchFrame::t1));
  hand_out(d, here, t.t2, frame(&PatchFrame::t2));
  hand_out(d, here, t.n, frame(&PatchFrame::n));
  hand_out(d, here, of3(FoundLanes::direction), frame(&PatchFrame::direction));
  hand_out(d, here, axis_x, frame(&PatchFrame::axis_x));
  hand_out(d, here, axis_y, frame(&PatchFrame::axis_y));
  hand_out(d, here, of(FoundLanes::middle), frame(&PatchFrame::middle));
  hand_out(d, here, t.longest, frame(&PatchFrame::longest));
  hand_out(d, here, t.deviation, frame(&PatchFrame::deviation));
  hand_out(d, here, t.amplify, frame(&PatchFrame::amplify));
  hand_out(d, here, t.stretch, frame(&PatchFrame::stretch));
  auto good = hn::And(well_shaped(d, t), hn::Le(t.stretch, hn::Set(d, max_frame_stretch)));
  good = hn::And(
      good, hn::And(hn::Lt(largest, hn::Set(d, INFINITY)), hn::Ge(t.longest, hn::Set(d, least_longest))));
  good = hn::And(good, hn::Gt(of(FoundLanes::good), hn::Zero(d)));
  const std::uint32_t mask = bits(d, good);
  for (std::size_t l = 0; l < here; ++l) {
    const auto number_of = [&](std::size_t row) { return static_cast<double>(found.at(row)[from + l]); };
    PartBounds& bounds = *pieces[l].bounds;
    bounds.points = {
        {number_of(FoundLanes::lower), number_of(FoundLanes::lower + 1), number_of(FoundLanes::lower + 2)},
        {number_of(FoundLanes::upper), number_of(FoundLanes::upper + 1), number_of(FoundLanes::upper + 2)},
        number_of(FoundLanes::base),
        number_of(FoundLanes::apart),
        number_of(FoundLanes::along)};
    bounds.tip = {};
    bounds.size = 2 * number_of(FoundLanes::size);
    bounds.doubt = number_of(FoundLanes::doubt);
    pieces[l].frame->good = (mask >> l & 1) != 0;
    bounds.error = pieces[l].frame->good ? 0 : -1;
  }
}

// `gathered`: room for the control points of a vector of doubles.
template <class B>
HWY_INLINE void fit_lanes(B of_bounds, const RowsWithTips<float>& rows, unsigned levels,
                          std::span<const PieceToFit> pieces, const RowsMemory<float>& memory,
                          double* gathered) {
  const hn::ScalableTag<double> d;
  using V = hn::Vec<decltype(d)>;
  const std::size_t some = hn::Lanes(d), all = hn::Lanes(of_bounds), count = rows.kind().control_count();
  constexpr std::size_t parts = most_parts<decltype(of_bounds)>;
  PlanarTriangle<V> triangle[parts];
  V largest[parts], axis_x[parts], axis_y[parts];
  HWY_ALIGN float lane[FoundLanes::count][HWY_MAX_BYTES / sizeof(float)];
  for (std::size_t l = 0; l < all; l += some) {
    const std::size_t begin = std::min(l, pieces.size() - 1), i = l / some;
    const std::span<const PieceToFit> own = pieces.subspan(begin, std::min(some, pieces.size() - begin));
    const Lanes here{gathered, some};
    gather(
        own.size(), [&](std::size_t k) -> const Patch& { return *own[k].patch; }, here);
    Vec3<V> corner[3];
    for (std::size_t k = 0; k < 3; ++k) {
      corner[k] = product(d, rows.kind().corner_limits(), k, here);
      if (l >= pieces.size()) continue;
      hand_out(d, own.size(), corner[k], [&](std::size_t p) -> Vector3& {
        return own[p].shape->corners[(k + own[p].patch->first) % 3];
      });
    }
    PlanarTriangle<V>& t = triangle[i];
    t = planar_triangle(d, corner[0], corner[1], corner[2]);
    largest[i] = into_frame(d, t, here, count, LanesOf<float>{memory.control.first + l, all});
    const auto second = hn::Gt(t.l1, t.l0), third = hn::Gt(t.l2, hn::Max(t.l0, t.l1));
    const V one = hn::Set(d, 1.0), zero = hn::Zero(d);
    axis_x[i] = hn::IfThenElse(third, t.d2x, hn::IfThenElse(second, t.d1x, one));
    axis_y[i] = hn::IfThenElse(third, t.d2y, hn::IfThenElse(second, t.d1y, zero));
    const V given = lanes_of(d, own.size(), [&](std::size_t k) { return own[k].patch->error; });
    const V numbers[] = {t.l0, t.xc, t.yc, largest[i], axis_x[i], axis_y[i], given};
    for (std::size_t row = 0; row < std::size(numbers); ++row) store_as(d, numbers[row], lane[row] + l);
  }
  const auto of = [&](std::size_t row) HWY_ATTR { return hn::Load(of_bounds, lane[row]); };
  PlanarTriangle<hn::Vec<decltype(of_bounds)>> t;
  t.l0 = of(0);
  t.xc = of(1);
  t.yc = of(2);
  find_edges(of_bounds, t);
  const FoundLanes found{lane[0], HWY_MAX_BYTES / sizeof(float)};
  PieceLanes<B>(of_bounds, rows, memory, t, of(4), of(5), of(3), of(6)).bound(levels, found);
  for (std::size_t l = 0; l < std::min(all, pieces.size()); l += some) {
    hand_out_frames(d, triangle[l / some], axis_x[l / some], axis_y[l / some], largest[l / some], found, l,
                    pieces.subspan(l, std::min(some, pieces.size() - l)));
  }
}

SNUG_FLAT void FitPiecesByRows(const RowsWithTips<float>& rows, unsigned levels,
                               std::span<const PieceToFit> pieces) {
  const hn::ScalableTag<double> d;
  const std::size_t lanes = hn::Lanes(hn::ScalableTag<float>()), count = rows.kind().control_count();
  double* const gathered = aligned_memory(3 * count * hn::Lanes(d));
  float* const at = aligned_memory<float>(lanes * RowsMemory<float>::size(rows, levels));
  const auto fit = [&](auto of_bounds, std::size_t begin) HWY_ATTR {
    const std::size_t here = std::min(hn::Lanes(of_bounds), pieces.size() - begin);
    fit_lanes(of_bounds, rows, levels, pieces.subspan(begin, here),
              RowsMemory<float>(at, hn::Lanes(of_bounds), rows), gathered);
    return begin + here;
  };
  for (std::size_t begin = 0; begin < pieces.size();) {
    // Half a vector costs less where there are 512 bits.
    constexpr std::size_t half = 8;
    if constexpr (hn::MaxLanes(hn::ScalableTag<float>()) == 2 * half) {
      if (pieces.size() - begin <= half) {
        begin = fit(hn::CappedTag<float, half>(), begin);
        continue;
      }
    }
    begin = fit(hn::ScalableTag<float>(), begin);
  }
}

}  // namespace
}  // namespace snug::kernels::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace snug::kernels {

HWY_EXPORT(FitPiecesByRows);

void fit_pieces_by_rows(const RowsWithTips<float>& rows, unsigned levels,
                        std::span<const PieceToFit> pieces) {
  SNUG_EXPECT(levels >= least_row_levels && levels <= most_row_levels);
  HWY_DYNAMIC_DISPATCH(FitPiecesByRows)(rows, levels, pieces);
}

}  // namespace snug::kernels
#endif
