#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "snug/caster/caster_kernels.cpp"
#include <snug/geometry/vector_code-inl.h>

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

// Newton steps from a place. Pieces are nearly flat: errors are squared by each.
constexpr unsigned steps = 4;
// Of a box seen from a ray: what roundings do to a quotient.
constexpr float wider = 1 + 16 * 0x1p-24F;

std::uint32_t boxes(const CasterBoxes& boxes, const CasterRay& ray, float grown, float from, float to,
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
      end = hn::Min(end, hn::Mul(hn::Max(one, two), hn::Set(d, wider)));
    }
    hn::StoreU(begin, d, enter + at);
    met |= bits(d, hn::Le(begin, end)) << at;
  }
  return met;
}

// A quadratic triangle as the ray sees it: across, across, along.
struct Quadratic {
  Vector at_0, u, v, uu, uv, vv;

  HWY_INLINE Vector at(V s, V t) const {
    return add(at_0,
               add(scaled(s, add(u, add(scaled(s, uu), scaled(t, uv)))), scaled(t, add(v, scaled(t, vv)))));
  }
};

// The determinant of the derivative across the ray: whether the triangle turns away.
HWY_INLINE V turning(const Quadratic& q, V s, V t) {
  const V du_x = hn::Add(q.u.x, hn::Add(hn::Mul(hn::Add(s, s), q.uu.x), hn::Mul(t, q.uv.x)));
  const V du_y = hn::Add(q.u.y, hn::Add(hn::Mul(hn::Add(s, s), q.uu.y), hn::Mul(t, q.uv.y)));
  const V dv_x = hn::Add(q.v.x, hn::Add(hn::Mul(hn::Add(t, t), q.vv.x), hn::Mul(s, q.uv.x)));
  const V dv_y = hn::Add(q.v.y, hn::Add(hn::Mul(hn::Add(t, t), q.vv.y), hn::Mul(s, q.uv.y)));
  return hn::Sub(hn::Mul(du_x, dv_y), hn::Mul(du_y, dv_x));
}

struct Found {
  V t, s, r;  // along, and the parameters
};

// From a place by Newton's method, kept on the triangle. Nothing is farther than infinity.
HWY_INLINE void search(const Quadratic& q, V s, V r, V near_sq, V from, V to, Found& found) {
  const Tag d;
  const V zero = hn::Zero(d), one = hn::Set(d, 1), half = hn::Set(d, 0.5F), tiny = hn::Set(d, 1e-30F);
  for (unsigned step = 0; step < steps; ++step) {
    const Vector value = q.at(s, r);
    const V du_x = hn::Add(q.u.x, hn::Add(hn::Mul(hn::Add(s, s), q.uu.x), hn::Mul(r, q.uv.x)));
    const V du_y = hn::Add(q.u.y, hn::Add(hn::Mul(hn::Add(s, s), q.uu.y), hn::Mul(r, q.uv.y)));
    const V dv_x = hn::Add(q.v.x, hn::Add(hn::Mul(hn::Add(r, r), q.vv.x), hn::Mul(s, q.uv.x)));
    const V dv_y = hn::Add(q.v.y, hn::Add(hn::Mul(hn::Add(r, r), q.vv.y), hn::Mul(s, q.uv.y)));
    const V turn = hn::Sub(hn::Mul(du_x, dv_y), hn::Mul(du_y, dv_x));
    const V safe = hn::IfThenElse(hn::Gt(hn::Abs(turn), tiny), turn, tiny);
    s = hn::Sub(s, hn::Div(hn::Sub(hn::Mul(dv_y, value.x), hn::Mul(dv_x, value.y)), safe));
    r = hn::Sub(r, hn::Div(hn::Sub(hn::Mul(du_x, value.y), hn::Mul(du_y, value.x)), safe));
    s = hn::Min(hn::Max(s, hn::Set(d, -1)), hn::Set(d, 2));
    r = hn::Min(hn::Max(r, hn::Set(d, -1)), hn::Set(d, 2));
    // The nearest place of the triangle, by its far edge and then by the others.
    const V excess = hn::Max(zero, hn::Mul(half, hn::Sub(hn::Add(s, r), one)));
    s = hn::Sub(s, excess);
    r = hn::Sub(r, excess);
    s = hn::Min(hn::Max(s, zero), one);
    r = hn::Max(zero, hn::Min(r, hn::Sub(one, s)));
  }
  const Vector value = q.at(s, r);
  const V away = hn::Add(hn::Mul(value.x, value.x), hn::Mul(value.y, value.y));
  const auto met = hn::And(hn::And(hn::Le(away, near_sq), hn::Ge(value.z, from)),
                           hn::And(hn::Le(value.z, to), hn::Lt(value.z, found.t)));
  found.t = hn::IfThenElse(met, value.z, found.t);
  found.s = hn::IfThenElse(met, s, found.s);
  found.r = hn::IfThenElse(met, r, found.r);
}

// Bezier points of a triangle as a ray sees them, and whether that is near their box.
struct Seen {
  Vector p[6];
  Vector low, high;

  // `point(k)`: relative to the ray's origin; `turn(v)`: across, across, along.
  template <class Point, class Turn>
  HWY_INLINE Seen(const Point& point, const Turn& turn) {
    const Tag d;
    low.x = low.y = low.z = hn::Set(d, INFINITY);
    high.x = high.y = high.z = hn::Set(d, -INFINITY);
    for (std::size_t k = 0; k < 6; ++k) {
      p[k] = turn(point(k));
      low = {hn::Min(low.x, p[k].x), hn::Min(low.y, p[k].y), hn::Min(low.z, p[k].z)};
      high = {hn::Max(high.x, p[k].x), hn::Max(high.y, p[k].y), hn::Max(high.z, p[k].z)};
    }
  }
  [[nodiscard]] HWY_INLINE Mask within(V near) const {
    const V other = hn::Neg(near);
    return hn::And(hn::And(hn::Le(low.x, near), hn::Ge(high.x, other)),
                   hn::And(hn::Le(low.y, near), hn::Ge(high.y, other)));
  }
  // The same, and between two places along the ray.
  [[nodiscard]] HWY_INLINE Mask within(V near, V from, V to) const {
    return hn::And(within(near),
                   hn::And(hn::Ge(hn::Add(high.z, near), from), hn::Le(hn::Sub(low.z, near), to)));
  }
};

HWY_INLINE V sum_of(const Vector& v) { return hn::Add(hn::Add(hn::Abs(v.x), hn::Abs(v.y)), hn::Abs(v.z)); }

// Whether a part of a ray comes as near to the plane of a triangle's corners as its quadratic bends away from it: what begins above
// a surface and leaves it does not, though it is within the box.
HWY_INLINE Mask reaches_plane(const Seen& seen, V near, V from, V to) {
  const Tag d;
  const Vector* const p = seen.p;
  const Vector a = sub(p[1], p[0]), b = sub(p[2], p[0]), normal = cross(a, b);
  V low = hn::Zero(d), high = low;
  for (std::size_t k = 3; k < 6; ++k) {
    const V height = dot(normal, sub(p[k], p[0]));
    low = hn::Min(low, height);
    high = hn::Max(high, height);
  }
  const V own = dot(normal, p[0]);
  const V first = hn::Sub(hn::Mul(normal.z, from), own), last = hn::Sub(hn::Mul(normal.z, to), own);
  // A needle's normal is as rounded as its sides are long.
  const V rounding = hn::Mul(hn::Mul(hn::Mul(hn::Set(d, 0x1p-20F), sum_of(a)), sum_of(b)),
                             hn::Add(sum_of(p[0]), hn::Add(hn::Abs(from), hn::Abs(to))));
  const V least = hn::Add(hn::Add(hn::Mul(sum_of(normal), near), rounding), hn::Set(d, 1e-30F));
  return hn::Not(hn::Or(hn::Gt(hn::Sub(hn::Min(first, last), high), least),
                        hn::Gt(hn::Sub(low, hn::Max(first, last)), least)));
}

// Whether it passes between the lines along the triangle's sides, as it sees them, that its Bezier points lie between.
HWY_INLINE Mask passes_between_sides(const Seen& seen, V near) {
  const Tag d;
  const Vector* const p = seen.p;
  auto outside = hn::Lt(near, hn::Zero(d));
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
    const V least = hn::Add(hn::Mul(hn::Add(hn::Abs(x), hn::Abs(y)), near), hn::Set(d, 1e-30F));
    outside = hn::Or(outside, hn::Gt(hn::Max(low, hn::Neg(high)), least));
  }
  return hn::Not(outside);
}

HWY_INLINE Seen seen_block(const CasterBlock& block, const CasterRay& ray, std::size_t at) {
  const Tag d;
  const auto point = [&](std::size_t k) {
    const auto row = [&](std::size_t axis) {
      const hn::Rebind<std::int16_t, Tag> narrow;
      const hn::Rebind<std::int32_t, Tag> whole;
      const V number =
          hn::ConvertTo(d, hn::PromoteTo(whole, hn::LoadU(narrow, block.net[k][axis].data() + at)));
      return hn::Add(hn::Mul(number, hn::Set(d, block.step)),
                     hn::Set(d, block.origin[axis] - ray.origin[axis]));
    };
    return Vector{row(0), row(1), row(2)};
  };
  const auto turn = [&](const Vector& v) {
    const auto along = [&](const std::array<float, 3>& w) {
      return dot(v, Vector{hn::Set(d, w[0]), hn::Set(d, w[1]), hn::Set(d, w[2])});
    };
    return Vector{along(ray.across[0]), along(ray.across[1]), along(ray.direction)};
  };
  return Seen(point, turn);
}

// The first places where rays are within `near` of triangles, if they are candidates.
HWY_INLINE Found first_hits(const Seen& seen, Mask candidates, V near, V from, V to) {
  const Tag d;
  const Vector* const p = seen.p;
  const auto doubled = [&](const Vector& x) { return add(x, x); };
  const Quadratic q{p[0],
                    doubled(sub(p[3], p[0])),
                    doubled(sub(p[5], p[0])),
                    sub(add(p[0], p[1]), doubled(p[3])),
                    doubled(sub(add(p[0], p[4]), add(p[3], p[5]))),
                    sub(add(p[0], p[2]), doubled(p[5]))};
  const V none = hn::IfThenElse(candidates, hn::Mul(near, near), hn::Set(d, -1));
  const V zero = hn::Zero(d), one = hn::Set(d, 1), third = hn::Set(d, 1.0F / 3), half = hn::Set(d, 0.5F);
  Found found{hn::Set(d, INFINITY), zero, zero};
  search(q, third, third, none, from, to, found);
  // A triangle that turns away somewhere may be met twice.
  const V turns[6] = {turning(q, zero, zero), turning(q, one, zero),  turning(q, zero, one),
                      turning(q, half, zero), turning(q, half, half), turning(q, zero, half)};
  V least = turns[0], most = turns[0];
  for (std::size_t k = 1; k < 6; ++k) {
    least = hn::Min(least, turns[k]);
    most = hn::Max(most, turns[k]);
  }
  const auto turns_away = hn::And(candidates, hn::And(hn::Le(least, zero), hn::Ge(most, zero)));
  if (bits(d, turns_away) != 0) {
    // No other lane, so that it makes no difference which ones a vector has.
    const V of_these = hn::IfThenElse(turns_away, none, hn::Set(d, -1));
    search(q, zero, zero, of_these, from, to, found);
    search(q, one, zero, of_these, from, to, found);
    search(q, zero, one, of_these, from, to, found);
  }
  return found;
}

std::uint32_t near_pieces(const CasterBlock& block, const CasterRay& ray, float grown) {
  const Tag d;
  std::uint32_t result = 0;
  for (std::size_t at = 0; at < caster_width; at += hn::Lanes(d)) {
    const V near = hn::Set(d, block.error + ray.rounding + grown);
    result |= bits(d, seen_block(block, ray, at).within(near)) << at;
  }
  return result & block.taken;
}

// The first place of a block, or none.
template <CasterQuery query>
HWY_INLINE CasterHit hit_block(const CasterBlock& block, const CasterRay& ray, float from, float to) {
  const Tag d;
  CasterHit hit;
  hit.t = to;
  for (std::size_t at = 0; at < caster_width; at += hn::Lanes(d)) {
    const Seen seen = seen_block(block, ray, at);
    const V near = hn::Set(d, block.error + ray.rounding);
    auto candidates = seen.within(near, hn::Set(d, from), hn::Set(d, hit.t));
    std::uint32_t taken = bits(d, candidates) & block.taken >> at;
    if (taken == 0) continue;
    // Most triangles that a shadow's ray is near to are those that it begins on.
    if constexpr (query == CasterQuery::any) {
      candidates = hn::And(candidates, reaches_plane(seen, near, hn::Set(d, from), hn::Set(d, hit.t)));
      if ((taken &= bits(d, candidates)) == 0) continue;
    }
    candidates = hn::And(candidates, passes_between_sides(seen, near));
    if ((taken &= bits(d, candidates)) == 0) continue;
    const Found found = first_hits(seen, candidates, near, hn::Set(d, from), hn::Set(d, hit.t));
    HWY_ALIGN float t[caster_width], s[caster_width], r[caster_width];
    hn::Store(found.t, d, t);
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
      float enter[caster_width];
      const std::uint32_t met = boxes(node.boxes, ray, 0, from, best.t, enter) & node.taken;
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
  const V near = hn::Set(d, block.error + rounding);
  for (std::size_t at = 0; at < caster_width; at += hn::Lanes(d)) {
    const auto rows = [&](const std::array<std::array<float, caster_width>, 3>& w) {
      return Vector{hn::Load(d, w[0].data() + at), hn::Load(d, w[1].data() + at),
                    hn::Load(d, w[2].data() + at)};
    };
    const Vector origin = rows(rays.origin);
    const auto point = [&](std::size_t k) {
      const auto coordinate = [&](std::size_t axis) {
        return hn::Set(d, block.origin[axis] + block.step * static_cast<float>(block.net[k][axis][place]));
      };
      return sub(Vector{coordinate(0), coordinate(1), coordinate(2)}, origin);
    };
    const auto turn = [&](const Vector& w) {
      return Vector{dot(w, rows(rays.across[0])), dot(w, rows(rays.across[1])), dot(w, rows(rays.direction))};
    };
    const Seen seen(point, turn);
    const V first = hn::Load(d, from + at), last = hn::Load(d, to + at);
    auto candidates = seen.within(near, first, last);
    if (bits(d, candidates) == 0) continue;
    candidates = hn::And(candidates, passes_between_sides(seen, near));
    if (bits(d, candidates) == 0) continue;
    const Found found = first_hits(seen, candidates, near, first, last);
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

HWY_EXPORT(boxes);
HWY_EXPORT(near_pieces);
HWY_EXPORT(walk);
HWY_EXPORT(piece);

std::uint32_t enter_boxes(const CasterBoxes& boxes_of_node, const CasterRay& ray, float grown, float from,
                          float to, float* enter) {
  return HWY_DYNAMIC_DISPATCH(boxes)(boxes_of_node, ray, grown, from, to, enter);
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
