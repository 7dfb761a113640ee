#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "snug/bvh/ray_kernel.cpp"
#include <snug/geometry/vector_code-inl.h>

#include <cmath>

#include <snug/bvh/ray_kernel.h>

HWY_BEFORE_NAMESPACE();
namespace snug::kernels::HWY_NAMESPACE {
namespace {

using Tag = hn::CappedTag<float, 8>;
using V = hn::Vec<Tag>;

// More than what roundings to single precision can do to a gap, as a part of all that is involved.
constexpr float gap_roundings = 64 * 0x1p-24F;
// More than what products lose that underflow, of a length and of a square.
constexpr float lost = 0x1p-118F;

// A segment, or one a lane.
struct Segment {
  Vec3<V> middle, direction;
  V half, origin, slack;
};

// Are they met? Writes where, if so, at the earliest. `row`: of the boxes, or of one.
template <class Row>
HWY_INLINE std::uint32_t met(const Row& row, V box_reach, const Segment& segment, float* begin) {
  const Tag d;
  const V dx = hn::Sub(row(0), segment.middle.x), dy = hn::Sub(row(1), segment.middle.y),
          dz = hn::Sub(row(2), segment.middle.z);
  const Vec3<V> delta{dx, dy, dz};
  const V reach = hn::Add(
      hn::Add(box_reach, segment.half),
      hn::Add(hn::Add(hn::Abs(segment.middle.x), hn::Abs(segment.middle.y)), hn::Abs(segment.middle.z)));
  const V doubt = hn::Add(hn::Mul(hn::Set(d, gap_roundings), reach), segment.slack);
  // Along the axes of a box: of the offset, and cosines.
  V t[3], c[3], far[3];
  V gap = hn::Neg(doubt), ahead = hn::Zero(d);
  for (std::size_t i = 0; i < 3; ++i) {
    const Vec3<V> axis{row(6 + 3 * i), row(7 + 3 * i), row(8 + 3 * i)};
    const V half = row(3 + i);
    t[i] = dot(axis, delta);
    c[i] = dot(axis, segment.direction);
    far[i] = hn::Abs(c[i]);
    ahead = hn::Add(ahead, hn::Mul(half, far[i]));
    gap = hn::Max(gap, hn::Sub(hn::Abs(t[i]), hn::Add(half, hn::Mul(segment.half, far[i]))));
  }
  for (std::size_t i = 0; i < 3; ++i) {
    const std::size_t j = (i + 1) % 3, k = (i + 2) % 3;
    const V across = hn::Abs(hn::Sub(hn::Mul(t[k], c[j]), hn::Mul(t[j], c[k])));
    gap = hn::Max(gap, hn::Sub(across, hn::Add(hn::Mul(row(3 + j), far[k]), hn::Mul(row(3 + k), far[j]))));
  }
  const V along = dot(delta, segment.direction);
  gap = hn::Max(gap, hn::Sub(hn::Abs(along), hn::Add(segment.half, ahead)));
  // From the node's origin, which is known in double precision: the node may be small.
  const V own = dot(Vec3<V>{row(0), row(1), row(2)}, segment.direction);
  const V unsure = hn::Add(hn::Add(hn::Mul(hn::Set(d, gap_roundings), box_reach), segment.slack),
                           hn::Mul(hn::Set(d, 0x1p-21F), hn::Abs(segment.origin)));
  hn::StoreU(hn::Add(segment.origin, hn::Sub(hn::Sub(own, ahead), unsure)), d, begin);
  return bits(d, hn::Not(hn::Gt(gap, doubt)));
}

std::uint32_t meet_boxes(const NodeBoxes& node, const SeenSegments& segments, std::size_t which,
                         float* begin) {
  const Tag d;
  const auto one = [&](const std::array<float, ray_width>& of_all) { return hn::Set(d, of_all[which]); };
  const Segment segment{{one(segments.middle[0]), one(segments.middle[1]), one(segments.middle[2])},
                        {one(segments.direction[0]), one(segments.direction[1]), one(segments.direction[2])},
                        one(segments.half),
                        one(segments.origin),
                        one(segments.slack)};
  std::uint32_t result = 0;
  for (std::size_t at = 0; at < node_width; at += hn::Lanes(d)) {
    const auto row = [&](std::size_t r) HWY_ATTR { return hn::Load(d, node.rows + node_width * r + at); };
    result |= met(row, hn::Set(d, node.reach), segment, begin + at) << at;
  }
  return result;
}

std::uint32_t rays(const NodeBoxes& node, std::size_t place, const SeenSegments& segments, float* begin) {
  const Tag d;
  const auto row = [&](std::size_t r) HWY_ATTR { return hn::Set(d, node.rows[node_width * r + place]); };
  std::uint32_t result = 0;
  for (std::size_t at = 0; at < ray_width; at += hn::Lanes(d)) {
    const auto some = [&](const std::array<float, ray_width>& all)
                          HWY_ATTR { return hn::Load(d, all.data() + at); };
    const Segment segment{
        {some(segments.middle[0]), some(segments.middle[1]), some(segments.middle[2])},
        {some(segments.direction[0]), some(segments.direction[1]), some(segments.direction[2])},
        some(segments.half),
        some(segments.origin),
        some(segments.slack)};
    result |= met(row, hn::Set(d, node.reach), segment, begin + at) << at;
  }
  return result;
}

void place(const SegmentPlaces& all, const Point3& origin, SeenSegments& out) {
  const hn::CappedTag<double, ray_width> d;
  const hn::Rebind<float, decltype(d)> narrow;
  for (std::size_t at = 0; at < ray_width; at += hn::Lanes(d)) {
    hn::Vec<decltype(d)> along[3];
    for (std::size_t k = 0; k < 3; ++k) {
      const auto from = hn::Sub(hn::LoadU(d, all.middle[k].data() + at), hn::Set(d, origin[k]));
      hn::StoreU(hn::DemoteTo(narrow, from), narrow, out.middle[k].data() + at);
      along[k] = hn::Mul(hn::LoadU(d, all.direction[k].data() + at), from);
    }
    const auto own = hn::Neg(hn::Add(hn::Add(along[0], along[1]), along[2]));
    hn::StoreU(hn::DemoteTo(narrow, own), narrow, out.origin.data() + at);
  }
}

// A side of the triangle and a ray span a plane; all of the set may lie on one side of the parallel one through the ray.
Meeting beside(const NearQuadratic& set, const SeenSegments& segments) {
  const Tag d;
  const float* const net = set.net;
  float sides[3][3], sizes[3];
  for (std::size_t k = 0; k < 3; ++k) {
    for (std::size_t a = 0; a < 3; ++a) sides[k][a] = net[3 * ((k + 1) % 3) + a] - net[3 * k + a];
    sizes[k] = std::fabs(sides[k][0]) + std::fabs(sides[k][1]) + std::fabs(sides[k][2]);
  }
  Meeting result{0, 0};
  for (std::size_t at = 0; at < ray_width; at += hn::Lanes(d)) {
    const auto some = [&](const std::array<float, ray_width>& all)
                          HWY_ATTR { return hn::Load(d, all.data() + at); };
    const Vec3<V> middle{some(segments.middle[0]), some(segments.middle[1]), some(segments.middle[2])};
    const Vec3<V> along{some(segments.direction[0]), some(segments.direction[1]),
                        some(segments.direction[2])};
    const V far = hn::Add(hn::Add(some(segments.half), hn::Set(d, set.reach)),
                          hn::Add(hn::Add(hn::Abs(middle.x), hn::Abs(middle.y)), hn::Abs(middle.z)));
    const V rounding = hn::Add(hn::Mul(hn::Set(d, gap_roundings), far), some(segments.slack));
    const V error = hn::Set(d, (1 + 0x1p-20F) * set.error), zero = hn::Zero(d);
    const V lost_here = hn::Mul(hn::Set(d, lost), hn::Add(hn::Set(d, 1.0F), far));
    Vec3<V> points[6];
    for (std::size_t k = 0; k < 6; ++k) {
      points[k] = sub(Vec3<V>{hn::Set(d, net[3 * k]), hn::Set(d, net[3 * k + 1]), hn::Set(d, net[3 * k + 2])},
                      middle);
    }
    auto passed = hn::Lt(error, zero), inside = hn::Not(passed);
    for (std::size_t k = 0; k < 3; ++k) {
      const Vec3<V> side{hn::Set(d, sides[k][0]), hn::Set(d, sides[k][1]), hn::Set(d, sides[k][2])};
      const Vec3<V> normal = cross(along, side);
      const V size = hn::Sqrt(hn::Add(dot(normal, normal), hn::Set(d, lost)));
      const V least =
          hn::Add(hn::Add(hn::Mul(size, error), hn::Mul(hn::Set(d, sizes[k]), rounding)), lost_here);
      // Of Bezier points; the side's other end is as high.
      const V end = dot(normal, points[k]), tip = dot(normal, points[(k + 2) % 3]);
      const V bend = dot(normal, points[3 + k]), second = dot(normal, points[3 + (k + 1) % 3]),
              third = dot(normal, points[3 + (k + 2) % 3]);
      // Of those of its four parts those that are no means of others.
      const V half = hn::Set(d, 0.5F), quarter = hn::Set(d, 0.25F),
              bends = hn::Add(bend, hn::Add(second, third));
      const V on_side = hn::Mul(half, hn::Add(end, bend));
      const V by_end = hn::Mul(quarter, hn::Add(end, bends)), by_tip = hn::Mul(quarter, hn::Add(tip, bends));
      const V least_end = hn::Min(end, tip), most_end = hn::Max(end, tip);
      const V low = hn::Min(end, on_side), high = hn::Max(end, on_side);
      const V lowest = hn::Min(hn::Min(hn::Min(low, tip), hn::Min(by_end, by_tip)),
                               hn::Mul(half, hn::Add(least_end, hn::Min(second, third))));
      const V highest = hn::Max(hn::Max(hn::Max(high, tip), hn::Max(by_end, by_tip)),
                                hn::Mul(half, hn::Add(most_end, hn::Max(second, third))));
      passed = hn::Or(passed, hn::Gt(hn::Max(lowest, hn::Neg(highest)), least));
      const V outer = hn::IfThenElse(hn::Gt(tip, end), hn::Neg(high), low);
      inside = hn::And(inside, hn::Gt(outer, least));
    }
    result.near |= bits(d, hn::Not(passed)) << at;
    result.inside |= bits(d, hn::AndNot(passed, inside)) << at;
  }
  return result;
}

}  // namespace
}  // namespace snug::kernels::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace snug::kernels {

HWY_EXPORT(place);
HWY_EXPORT(meet_boxes);
HWY_EXPORT(rays);
HWY_EXPORT(beside);

void place_segments(const SegmentPlaces& all, const Point3& node_origin, SeenSegments& out) {
  HWY_DYNAMIC_DISPATCH(place)(all, node_origin, out);
}

std::uint32_t boxes_met(const NodeBoxes& node, const SeenSegments& segments, std::size_t which,
                        std::array<float, node_width>& begin) {
  const std::uint32_t all = (1u << node.box_count) - 1;
  // A NaN may be lost in a maximum.
  if (!(node.reach < 1e18F)) {
    begin.fill(-INFINITY);
    return all;
  }
  return HWY_DYNAMIC_DISPATCH(meet_boxes)(node, segments, which, begin.data()) & all;
}

std::uint32_t segments_meeting(const NodeBoxes& node, std::size_t place, const SeenSegments& segments,
                               std::array<float, ray_width>& begin) {
  if (!(node.reach < 1e18F)) {
    begin.fill(-INFINITY);
    return (1u << ray_width) - 1;
  }
  return HWY_DYNAMIC_DISPATCH(rays)(node, place, segments, begin.data());
}

Meeting segments_meeting(const NearQuadratic& set, const SeenSegments& segments) {
  // A NaN may be lost in a maximum.
  if (!(set.error < 1e18F && set.reach < 1e18F)) return {(1u << ray_width) - 1, 0};
  return HWY_DYNAMIC_DISPATCH(beside)(set, segments);
}

}  // namespace snug::kernels
#endif
