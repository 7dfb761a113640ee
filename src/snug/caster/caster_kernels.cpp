#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "snug/caster/caster_kernels.cpp"
#include <snug/geometry/vector_code-inl.h>

#include <array>
#include <cmath>

#include <snug/caster/caster_kernels.h>
#include <snug/caster/open_nodes.h>

HWY_BEFORE_NAMESPACE();
namespace snug::kernels::HWY_NAMESPACE {
namespace {

using Tag = hn::CappedTag<float, caster_width>;
using V = hn::Vec<Tag>;
using Mask = hn::Mask<Tag>;
using Vector = Vec3<V>;

// Newton steps from a place, at most. Pieces are nearly flat: errors are squared by each.
constexpr unsigned steps = 4;
// They end where the square of the distance from the ray is this share of what is a hit, or, from the fourth place on, not below this
// share of the one before: the ray passes by. Earlier, needles still come nearer.
constexpr float near_enough = 0x1p-6F, hopeful = 0.25F;
// Of a box seen from a ray: what roundings do to a quotient.
constexpr float wider = 1 + 16 * 0x1p-24F;

std::uint32_t entered(const CasterBoxes& boxes, const CasterRay& ray, float grown, float from, float to,
                      float* enter) {
  const Tag d;
  const V by = hn::Set(d, grown);
  std::uint32_t met = 0;
  for (std::size_t at = 0; at < caster_width; at += hn::Lanes(d)) {
    V begin = hn::Set(d, from), end = hn::Set(d, to);
    for (std::size_t k = 0; k < 3; ++k) {
      const V origin = hn::Set(d, ray.origin[k]), inverse = hn::Set(d, ray.inverse[k]);
      const V low = hn::Sub(hn::Load(d, boxes.lower[k].data() + at), by),
              high = hn::Add(hn::Load(d, boxes.upper[k].data() + at), by);
      const V one = hn::Mul(hn::Sub(low, origin), inverse), two = hn::Mul(hn::Sub(high, origin), inverse);
      begin = hn::Max(begin, hn::Min(one, two));
      end = hn::Min(end, hn::Max(one, two));
    }
    hn::StoreU(begin, d, enter + at);
    met |= bits(d, hn::Le(begin, hn::Mul(end, hn::Set(d, wider)))) << at;
  }
  return met;
}

// A coordinate of a quadratic triangle as a ray sees it: powers of the parameters.
struct Quadratic {
  V at_0, u, v, uu, uv, vv;

  struct Value {
    V value, du, dv;
  };
  [[nodiscard]] HWY_INLINE Value at(V s, V r) const {
    const V s_uu = hn::Mul(s, uu), r_vv = hn::Mul(r, vv);
    const V along_u = hn::Add(u, hn::Add(s_uu, hn::Mul(r, uv))), along_v = hn::Add(v, r_vv);
    return {hn::Add(at_0, hn::Add(hn::Mul(s, along_u), hn::Mul(r, along_v))), hn::Add(along_u, s_uu),
            hn::Add(hn::Add(along_v, r_vv), hn::Mul(s, uv))};
  }
};
struct Quadratics {
  Quadratic x, y, z;

  HWY_INLINE explicit Quadratics(const Vector* p)
      : x(of(p, &Vector::x)), y(of(p, &Vector::y)), z(of(p, &Vector::z)) {}

 private:
  static HWY_INLINE Quadratic of(const Vector* p, V Vector::*axis) {
    const auto at = [&](std::size_t k) { return p[k].*axis; };
    const auto twice = [](V a) { return hn::Add(a, a); };
    return {at(0),
            twice(hn::Sub(at(3), at(0))),
            twice(hn::Sub(at(5), at(0))),
            hn::Sub(hn::Add(at(0), at(1)), twice(at(3))),
            twice(hn::Sub(hn::Add(at(0), at(4)), hn::Add(at(3), at(5)))),
            hn::Sub(hn::Add(at(0), at(2)), twice(at(5)))};
  }
};

// How a ray sees places: moved along it to the plane across its axis that its origin is in: two coordinates there, and how far that
// was.
struct View {
  V direction_x, direction_y;
  V x, y, inverse;  // the direction over its coordinate on the axis, and 1 over that

  HWY_INLINE View(V along_x, V along_y, V over)
      : direction_x(along_x),
        direction_y(along_y),
        x(hn::Mul(along_x, over)),
        y(hn::Mul(along_y, over)),
        inverse(over) {}
  HWY_INLINE Vector operator()(const Vector& p) const {
    return {hn::Sub(p.x, hn::Mul(p.z, x)), hn::Sub(p.y, hn::Mul(p.z, y)), hn::Mul(p.z, inverse)};
  }
  // Around all that is within a distance, in each of these coordinates: the root of 1 + x^2 is no more than 1 + x^2 / 2.
  [[nodiscard]] HWY_INLINE Vector around(V distance) const {
    const Tag d;
    const V one = hn::Set(d, 1), half = hn::Set(d, 0.5F);
    return {hn::Mul(distance, hn::Add(one, hn::Mul(half, hn::Mul(x, x)))),
            hn::Mul(distance, hn::Add(one, hn::Mul(half, hn::Mul(y, y)))),
            hn::Mul(distance, hn::Abs(inverse))};
  }
  // From such a place to the ray's nearest point: along the ray.
  [[nodiscard]] HWY_INLINE V ahead(V at_x, V at_y) const {
    return hn::Add(hn::Mul(at_x, direction_x), hn::Mul(at_y, direction_y));
  }
};

struct Found {
  V t, s, r;  // along, and the parameters
};

// From places by Newton's method, kept on the triangle. Nothing is farther than infinity. A lane rests when it has ended, whatever
// the others do.
template <std::size_t count>
HWY_INLINE void search(const Quadratics& q, const View& view, std::array<V, count> s, std::array<V, count> r,
                       const std::array<V, count>& near_sq, V from, V to, Found& found) {
  const Tag d;
  const V zero = hn::Zero(d), one = hn::Set(d, 1), half = hn::Set(d, 0.5F), tiny = hn::Set(d, 1e-30F);
  std::array<V, count> ahead, away, last;
  for (unsigned step = 0;; ++step) {
    std::array<Quadratic::Value, count> x, y;
    std::array<Mask, count> moves;
    auto any = hn::Lt(one, zero);
    for (std::size_t i = 0; i < count; ++i) {
      x[i] = q.x.at(s[i], r[i]);
      y[i] = q.y.at(s[i], r[i]);
      ahead[i] = view.ahead(x[i].value, y[i].value);
      away[i] = hn::Sub(hn::Add(hn::Mul(x[i].value, x[i].value), hn::Mul(y[i].value, y[i].value)),
                        hn::Mul(ahead[i], ahead[i]));
      moves[i] =
          hn::And(hn::Gt(away[i], hn::Mul(hn::Set(d, near_enough), near_sq[i])), hn::Gt(near_sq[i], zero));
      if (step > 2) moves[i] = hn::And(moves[i], hn::Lt(away[i], hn::Mul(hn::Set(d, hopeful), last[i])));
      last[i] = away[i];
      any = hn::Or(any, moves[i]);
    }
    if (step == steps || bits(d, any) == 0) break;
    for (std::size_t i = 0; i < count; ++i) {
      const V turn = hn::Sub(hn::Mul(x[i].du, y[i].dv), hn::Mul(y[i].du, x[i].dv));
      const V safe = hn::IfThenElse(hn::Gt(hn::Abs(turn), tiny), turn, tiny);
      const V u =
          hn::Sub(s[i], hn::Div(hn::Sub(hn::Mul(y[i].dv, x[i].value), hn::Mul(x[i].dv, y[i].value)), safe));
      const V v =
          hn::Sub(r[i], hn::Div(hn::Sub(hn::Mul(x[i].du, y[i].value), hn::Mul(y[i].du, x[i].value)), safe));
      // The nearest place of the triangle, by its far edge and then by the others.
      const V off = hn::Mul(half, hn::Sub(u, v));
      s[i] = hn::IfThenElse(moves[i], hn::Min(hn::Max(hn::Min(u, hn::Add(half, off)), zero), one), s[i]);
      r[i] = hn::IfThenElse(moves[i], hn::Min(hn::Max(hn::Min(v, hn::Sub(half, off)), zero), one), r[i]);
    }
  }
  for (std::size_t i = 0; i < count; ++i) {
    const V along = hn::Add(q.z.at(s[i], r[i]).value, ahead[i]);
    const auto met = hn::And(hn::And(hn::Le(away[i], near_sq[i]), hn::Ge(along, from)),
                             hn::And(hn::Le(along, to), hn::Lt(along, found.t)));
    found.t = hn::IfThenElse(met, along, found.t);
    found.s = hn::IfThenElse(met, s[i], found.s);
    found.r = hn::IfThenElse(met, hn::Min(r[i], hn::Sub(one, s[i])), found.r);
  }
}

// Bezier points of a triangle as a ray sees them, and whether that is near their box.
struct Seen {
  Vector p[6];
  Vector low, high;

  // `point(k)`: relative to the ray's origin.
  template <class Point>
  HWY_INLINE Seen(const View& view, const Point& point) {
    const Tag d;
    low.x = low.y = low.z = hn::Set(d, INFINITY);
    high.x = high.y = high.z = hn::Set(d, -INFINITY);
    for (std::size_t k = 0; k < 6; ++k) {
      p[k] = view(point(k));
      low = {hn::Min(low.x, p[k].x), hn::Min(low.y, p[k].y), hn::Min(low.z, p[k].z)};
      high = {hn::Max(high.x, p[k].x), hn::Max(high.y, p[k].y), hn::Max(high.z, p[k].z)};
    }
  }
  [[nodiscard]] HWY_INLINE Mask within(const Vector& near) const {
    return hn::And(hn::And(hn::Le(low.x, near.x), hn::Ge(high.x, hn::Neg(near.x))),
                   hn::And(hn::Le(low.y, near.y), hn::Ge(high.y, hn::Neg(near.y))));
  }
  // Between two places along the ray.
  [[nodiscard]] HWY_INLINE Mask between(const Vector& near, V from, V to) const {
    return hn::And(hn::Ge(hn::Add(high.z, near.z), from), hn::Le(hn::Sub(low.z, near.z), to));
  }
};

HWY_INLINE V sum_of(const Vector& v) { return hn::Add(hn::Add(hn::Abs(v.x), hn::Abs(v.y)), hn::Abs(v.z)); }

// Whether a part of a ray comes as near to the plane of a triangle's corners as its quadratic bends away from it: what begins above
// a surface and leaves it does not, though it is within the box.
HWY_INLINE Mask reaches_plane(const Seen& seen, const Vector& near, V from, V to) {
  const Tag d;
  const Vector* const p = seen.p;
  const Vector a = sub(p[1], p[0]), b = sub(p[2], p[0]), normal = cross(a, b);
  V low = hn::Zero(d), high = low;
  for (std::size_t k = 3; k < 6; ++k) {
    const V height = dot(normal, sub(p[k], p[0]));
    low = hn::Min(low, height);
    high = hn::Max(high, height);
  }
  // Their weights are two thirds together, at most.
  const V weight = hn::Set(d, 2.0F / 3);
  const V own = dot(normal, p[0]);
  const V first = hn::Sub(hn::Mul(normal.z, from), own), last = hn::Sub(hn::Mul(normal.z, to), own);
  // A needle's normal is as rounded as its sides are long.
  const V rounding = hn::Mul(hn::Mul(hn::Mul(hn::Set(d, 0x1p-20F), sum_of(a)), sum_of(b)),
                             hn::Add(sum_of(p[0]), hn::Add(hn::Abs(from), hn::Abs(to))));
  const Vector grown{hn::Mul(normal.x, near.x), hn::Mul(normal.y, near.y), hn::Mul(normal.z, near.z)};
  const V least = hn::Add(hn::Add(sum_of(grown), rounding), hn::Set(d, 1e-30F));
  return hn::Not(hn::Or(hn::Gt(hn::Sub(hn::Min(first, last), hn::Mul(weight, high)), least),
                        hn::Gt(hn::Sub(hn::Mul(weight, low), hn::Max(first, last)), least)));
}

// Whether it passes between the lines along the triangle's sides, as it sees them, that its Bezier points lie between.
HWY_INLINE Mask passes_between_sides(const Seen& seen, const Vector& near) {
  const Tag d;
  const Vector* const p = seen.p;
  auto outside = hn::Lt(near.x, hn::Zero(d));
  for (std::size_t k = 0; k < 3; ++k) {
    const std::size_t next = (k + 1) % 3;
    const V x = hn::Sub(p[next].y, p[k].y), y = hn::Sub(p[k].x, p[next].x);
    const auto height = [&](std::size_t i) { return hn::Add(hn::Mul(x, p[i].x), hn::Mul(y, p[i].y)); };
    V low = height(k), high = low;
    for (const std::size_t i : {(k + 2) % 3, std::size_t{3}, std::size_t{4}, std::size_t{5}}) {
      const V other = height(i);
      low = hn::Min(low, other);
      high = hn::Max(high, other);
    }
    const V least =
        hn::Add(hn::Add(hn::Mul(hn::Abs(x), near.x), hn::Mul(hn::Abs(y), near.y)), hn::Set(d, 1e-30F));
    outside = hn::Or(outside, hn::Gt(hn::Max(low, hn::Neg(high)), least));
  }
  return hn::Not(outside);
}

HWY_INLINE View view_of(const CasterRay& ray) {
  const Tag d;
  return {hn::Set(d, ray.direction[(ray.axis + 1) % 3]), hn::Set(d, ray.direction[(ray.axis + 2) % 3]),
          hn::Set(d, ray.inverse[ray.axis])};
}
// Triangles of a block, the first of which is `at`, as a ray sees them, in steps of the block.
HWY_INLINE Seen seen_block(const CasterBlock& block, const CasterRay& ray, const View& view, std::size_t at) {
  const Tag d;
  const auto point = [&](std::size_t k) {
    const auto coordinate = [&](std::size_t axis) {
      const hn::Rebind<std::int16_t, Tag> narrow;
      const hn::Rebind<std::int32_t, Tag> whole;
      const V number =
          hn::ConvertTo(d, hn::PromoteTo(whole, hn::LoadU(narrow, block.net[k][axis].data() + at)));
      return hn::Add(number, hn::Set(d, (block.origin[axis] - ray.origin[axis]) * block.inverse_step));
    };
    return Vector{coordinate((ray.axis + 1) % 3), coordinate((ray.axis + 2) % 3), coordinate(ray.axis)};
  };
  return Seen(view, point);
}

// The first places where rays are within `near` of triangles, if they are candidates.
HWY_INLINE Found first_hits(const Seen& seen, const View& view, Mask candidates, V near, V from, V to) {
  const Tag d;
  const Vector* const p = seen.p;
  const Quadratics q(p);
  const V none = hn::IfThenElse(candidates, hn::Mul(near, near), hn::Set(d, -1));
  const V zero = hn::Zero(d), one = hn::Set(d, 1), third = hn::Set(d, 1.0F / 3);
  Found found{hn::Set(d, INFINITY), zero, zero};
  // A triangle that turns away somewhere, at a corner or the middle of an edge, may be met twice.
  const auto turning = [&](const Vector& x, const Vector& y) {
    return hn::Sub(hn::Mul(x.x, y.y), hn::Mul(x.y, y.x));
  };
  const Vector du[3] = {sub(p[3], p[0]), sub(p[1], p[3]), sub(p[4], p[5])},
               dv[3] = {sub(p[5], p[0]), sub(p[4], p[3]), sub(p[2], p[5])};
  V least = hn::Set(d, INFINITY), most = hn::Set(d, -INFINITY);
  for (std::size_t k = 0; k < 3; ++k) {
    const std::size_t next = (k + 1) % 3;
    for (const V turn : {turning(du[k], dv[k]), turning(add(du[k], du[next]), add(dv[k], dv[next]))}) {
      least = hn::Min(least, turn);
      most = hn::Max(most, turn);
    }
  }
  const auto turns_away = hn::And(candidates, hn::And(hn::Le(least, zero), hn::Ge(most, zero)));
  if (bits(d, turns_away) == 0) {
    search<1>(q, view, {third}, {third}, {none}, from, to, found);
  } else {
    // No other lane, so that it makes no difference which ones a vector has.
    const V of_these = hn::IfThenElse(turns_away, none, hn::Set(d, -1));
    search<4>(q, view, {third, zero, one, zero}, {third, zero, zero, one},
              {none, of_these, of_these, of_these}, from, to, found);
  }
  return found;
}

std::uint32_t near_pieces(const CasterBlock& block, const CasterRay& ray, float grown) {
  const Tag d;
  std::uint32_t result = 0;
  const View view = view_of(ray);
  const Vector near = view.around(hn::Set(d, (block.error + ray.rounding + grown) * block.inverse_step));
  for (std::size_t at = 0; at < caster_width; at += hn::Lanes(d)) {
    result |= bits(d, seen_block(block, ray, view, at).within(near)) << at;
  }
  return result & block.taken;
}

// The first place of a block, or none.
template <CasterQuery query>
HWY_INLINE CasterHit hit_block(const CasterBlock& block, const CasterRay& ray, float from, float to) {
  const Tag d;
  CasterHit hit;
  hit.t = to;
  const View view = view_of(ray);
  const V distance = hn::Set(d, (block.error + ray.rounding) * block.inverse_step);
  const Vector near = view.around(distance);
  for (std::size_t at = 0; at < caster_width; at += hn::Lanes(d)) {
    const Seen seen = seen_block(block, ray, view, at);
    const V first = hn::Set(d, from * block.inverse_step), last = hn::Set(d, hit.t * block.inverse_step);
    auto candidates = seen.within(near);
    std::uint32_t taken = bits(d, candidates) & block.taken >> at;
    if (taken == 0) continue;
    candidates = hn::And(candidates, seen.between(near, first, last));
    // Most triangles that a shadow's ray is near to are those that it begins on.
    if constexpr (query == CasterQuery::any)
      candidates = hn::And(candidates, reaches_plane(seen, near, first, last));
    if ((taken &= bits(d, candidates)) == 0) continue;
    candidates = hn::And(candidates, passes_between_sides(seen, near));
    if ((taken &= bits(d, candidates)) == 0) continue;
    const Found found = first_hits(seen, view, candidates, distance, first, last);
    HWY_ALIGN float t[caster_width], s[caster_width], r[caster_width];
    hn::Store(hn::Mul(found.t, hn::Set(d, block.step)), d, t);
    hn::Store(found.s, d, s);
    hn::Store(found.r, d, r);
    for (std::size_t l = 0; l < hn::Lanes(d); ++l) {
      if ((taken >> l & 1u) == 0 || !(t[l] < hit.t || (hit.place == caster_width && t[l] <= hit.t))) continue;
      hit = {0, static_cast<std::uint32_t>(at + l), t[l], s[l], r[l]};
    }
  }
  return hit;
}

template <CasterQuery query>
HWY_INLINE CasterHit walk_for(const CasterNode* nodes, const CasterBlock* blocks, const CasterRay& ray,
                              float from, float to) {
  CasterHit best;
  best.t = to;
  OpenNodes open;
  open.add(0, from);
  while (!open.empty()) {
    const OpenNodes::Item top = open.take();
    if (top.enter > best.t) continue;
    if ((top.name & caster_leaf_bit) == 0) {
      const CasterNode& node = nodes[top.name];
      HWY_ALIGN float enter[caster_width];
      const std::uint32_t met = entered(node.boxes, ray, 0, from, best.t, enter);
      // Shadow rays begin beside the surface that they leave, and are blocked farther on.
      constexpr auto order =
          query == CasterQuery::any ? OpenNodes::Order::farthest_first : OpenNodes::Order::nearest_first;
      open.add<order>(node.children, met, enter);
      continue;
    }
    const std::uint32_t block = top.name & ~caster_leaf_bit;
    CasterHit hit = hit_block<query>(blocks[block], ray, from, best.t);
    if (hit.place == caster_width) continue;
    hit.block = block;
    best = hit;
    if constexpr (query == CasterQuery::any) break;
  }
  return best;
}

CasterHit walk(const CasterNode* nodes, const CasterBlock* blocks, const CasterRay& ray, float from, float to,
               CasterQuery query) {
  return query == CasterQuery::any ? walk_for<CasterQuery::any>(nodes, blocks, ray, from, to)
                                   : walk_for<CasterQuery::nearest>(nodes, blocks, ray, from, to);
}

std::uint32_t piece(const CasterBlock& block, std::size_t place, const CasterRays& rays, float rounding,
                    const float* from, float* to, float* u, float* v) {
  const Tag d;
  std::uint32_t met = 0;
  const V distance = hn::Set(d, block.error + rounding);
  for (std::size_t at = 0; at < caster_width; at += hn::Lanes(d)) {
    const auto rows = [&](const std::array<std::array<float, caster_width>, 3>& w) {
      return Vector{hn::Load(d, w[0].data() + at), hn::Load(d, w[1].data() + at),
                    hn::Load(d, w[2].data() + at)};
    };
    const Vector origin = rows(rays.origin), direction = rows(rays.direction);
    const auto point = [&](std::size_t k) {
      const auto coordinate = [&](std::size_t axis) {
        return hn::Set(d, block.origin[axis] + block.step * static_cast<float>(block.net[k][axis][place]));
      };
      return sub(
          Vector{coordinate((rays.axis + 1) % 3), coordinate((rays.axis + 2) % 3), coordinate(rays.axis)},
          origin);
    };
    const View view(direction.x, direction.y, hn::Load(d, rays.inverse.data() + at));
    const Vector near = view.around(distance);
    const Seen seen(view, point);
    const V first = hn::Load(d, from + at), last = hn::Load(d, to + at);
    auto candidates = hn::And(seen.within(near), seen.between(near, first, last));
    if (bits(d, candidates) == 0) continue;
    candidates = hn::And(candidates, passes_between_sides(seen, near));
    if (bits(d, candidates) == 0) continue;
    const Found found = first_hits(seen, view, candidates, distance, first, last);
    const auto nearer = hn::Lt(found.t, hn::Set(d, INFINITY));
    hn::Store(hn::IfThenElse(nearer, found.t, last), d, to + at);
    hn::Store(hn::IfThenElse(nearer, found.s, hn::Load(d, u + at)), d, u + at);
    hn::Store(hn::IfThenElse(nearer, found.r, hn::Load(d, v + at)), d, v + at);
    met |= bits(d, nearer) << at;
  }
  return met;
}

}  // namespace
}  // namespace snug::kernels::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace snug::kernels {

HWY_EXPORT(entered);
HWY_EXPORT(near_pieces);
HWY_EXPORT(walk);
HWY_EXPORT(piece);

std::uint32_t enter_boxes(const CasterBoxes& boxes_of_node, const CasterRay& ray, float grown, float from,
                          float to, float* enter) {
  return HWY_DYNAMIC_DISPATCH(entered)(boxes_of_node, ray, grown, from, to, enter);
}

std::uint32_t near_ray(const CasterBlock& triangles, const CasterRay& ray, float grown) {
  return HWY_DYNAMIC_DISPATCH(near_pieces)(triangles, ray, grown);
}

CasterHit cast(const CasterNode* nodes, const CasterBlock* blocks, const CasterRay& ray, float from, float to,
               CasterQuery query) {
  return HWY_DYNAMIC_DISPATCH(walk)(nodes, blocks, ray, from, to, query);
}

std::uint32_t hit_piece(const CasterBlock& triangles, std::size_t place, const CasterRays& rays,
                        float rounding, const float* from, float* to, float* u, float* v) {
  return HWY_DYNAMIC_DISPATCH(piece)(triangles, place, rays, rounding, from, to, u, v);
}

}  // namespace snug::kernels
#endif
