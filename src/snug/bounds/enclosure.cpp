#include <snug/bounds/enclosure.h>

#include <algorithm>

#include <snug/geometry/direction.h>
#include <snug/geometry/rounding.h>

namespace snug {
namespace {

// How much the nets of tips may add to a hull before it is worth refining them.
constexpr double notable_excess = 0.01;

// Relative to the hull points' origin.
using Ends = std::array<Vector3, 2>;
using Corners = std::array<Vector3, 3>;

// The way to the middle of the hull points.
struct Shift {
  Vector3 by;
  bool tips_stick_out = false;  // along the normal, by a notable part of the hull's height
};

Shift to_middle(const HullPoints& points, const Corners& corners) {
  const Vector3 normal = normalized(cross(corners[1] - corners[0], corners[2] - corners[0]));
  if (normal == Vector3{}) return {};
  const kernels::Coordinates all = points.coordinates();
  auto [lower, upper] = kernels::heights(all.first(points.tips_begin()), corners[0], normal);
  bool stick_out = false;
  if (points.tips[0].kind) {
    const kernels::Range tips = kernels::heights(all.from(points.tips_begin()), corners[0], normal);
    stick_out = std::max(lower - tips.lower, tips.upper - upper) > notable_excess * (upper - lower);
    lower = std::min(lower, tips.lower);
    upper = std::max(upper, tips.upper);
  }
  return {(0.5 * (lower + upper)) * normal, stick_out};
}

Shift to_middle(const HullPoints& points, const Ends& ends) {
  thread_local std::vector<Vector3> rests;
  rests.clear();
  const SegmentFoot foot(ends[0], ends[1]);
  Shift shift;
  double farthest_sq = 0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    rests.push_back(foot.rest(points.at(i)));
    for (std::size_t k = 0; k < i; ++k) {
      const double apart_sq = length_sq(rests[i] - rests[k]);
      if (!(apart_sq > farthest_sq)) continue;
      farthest_sq = apart_sq;
      shift.by = 0.5 * rests[i] + 0.5 * rests[k];
    }
  }
  return shift;
}

template <std::size_t N>
struct Base {
  std::array<Vector3, N> relative;
  std::array<Point3, N> placed;  // origin + relative, rounded
  double placing_error;          // of `placed`, a coordinate
  bool tips_stick_out;
};

template <std::size_t N>
Base<N> moved_base(const HullPoints& points, const std::array<Vector3, N>& corners) {
  const Shift shift = to_middle(points, corners);
  Base<N> base{corners, {}, 0, shift.tips_stick_out};
  for (std::size_t k = 0; k < N; ++k) {
    if (is_finite(shift.by)) base.relative[k] = corners[k] + shift.by;
    base.placed[k] = points.origin + base.relative[k];
    base.placing_error = std::max(base.placing_error, max_abs(base.placed[k] - Point3{}));
  }
  base.placing_error *= unit_roundoff * (1 + 0x1p-50);
  return base;
}

TriangleFoot foot_on(const Corners& c) { return {c[0], c[1], c[2]}; }
SegmentFoot foot_on(const Ends& e) { return {e[0], e[1]}; }

// Points minus their feet.
struct Rests {
  Vector3 lower{INFINITY, INFINITY, INFINITY}, upper{-INFINITY, -INFINITY, -INFINITY};
  double farthest;  // infinite where a rest is not finite
  double error;     // by rounding, a coordinate
};

// Of the points `begin` to `end` - 1.
template <std::size_t N>
Rests rests_of(const HullPoints& points, std::size_t begin, std::size_t end,
               const std::array<Vector3, N>& corner) {
  const auto foot = foot_on(corner);
  Rests all;
  bool finite = true;
  double farthest_sq = 0,
         reach = 0;  // largest |coordinate| of an edge, or of a point relative to the first corner
  for (std::size_t k = 0; k < N; ++k) {
    for (std::size_t i = 0; i < k; ++i) reach = std::max(reach, max_abs(corner[k] - corner[i]));
  }
  for (std::size_t i = begin; i < end; ++i) {
    const Vector3 p = points.at(i), rest = foot.rest(p);
    for (std::size_t a = 0; a < 3; ++a) {
      if (!(rest[a] >= all.lower[a])) all.lower[a] = rest[a];
      if (!(rest[a] <= all.upper[a])) all.upper[a] = rest[a];
    }
    const double dist_sq = length_sq(rest);
    finite = finite && dist_sq < INFINITY;
    farthest_sq = std::max(farthest_sq, dist_sq);
    reach = std::max(reach, max_abs(p - corner[0]));
  }
  // Squares of parts much smaller than the whole may underflow.
  all.farthest = finite ? std::sqrt(farthest_sq + 8 * underflow_error) : INFINITY;
  all.error = enlarged(32 * unit_roundoff * reach + 32 * underflow_error);
  return all;
}

// The nearest points of the edges, each found on its own.
kernels::Reach farthest_by_feet(const HullPoints& points, std::size_t begin, std::size_t end,
                                const Corners& corner) {
  const Rests rests = rests_of(points, begin, end, corner);
  const double rounding = spatial_error(rests.error);
  return {rests.farthest + rounding, rounding};
}

// Of the points `begin` to `split` - 1, and of those up to `end` - 1: in the triangle's plane, if it has one.
std::array<kernels::Reach, 2> farthest(const HullPoints& points, std::size_t begin, std::size_t split,
                                       std::size_t end, const Corners& corner) {
  const kernels::Coordinates all = points.coordinates().first(end).from(begin);
  if (const auto in_plane = kernels::farthest(all, split - begin, corner[0], corner[1], corner[2])) {
    return *in_plane;
  }
  return {farthest_by_feet(points, begin, split, corner), farthest_by_feet(points, split, end, corner)};
}

// Refines the tips whose nets stick out of the rest of the hull, which is within `rest` of the base. Nets
// that stick out along the normal have moved the base towards them: then both sides are about as far.
bool refine_what_sticks_out(BoundsCache& library, const Base<3>& base, double rest, HullPoints& points) {
  const double most = (base.tips_stick_out ? 1 - notable_excess : 1 + notable_excess) * rest;
  std::array<bool, 3> which{};
  for (std::size_t i = 0; i < 3 && points.tips[i].kind; ++i) {
    const std::size_t begin = points.tips[i].begin, count = points.tips[i].kind->control_count();
    which[i] = farthest(points, begin, begin + count, begin + count, base.relative)[0].distance > most;
  }
  if (which == std::array<bool, 3>{}) return false;
  refine_tips(library, which, points);
  return true;
}

}  // namespace

OffsetSegment offset_segment(const HullPoints& points, const std::array<Vector3, 2>& ends) {
  const Base<2> base = moved_base(points, ends);
  const Rests rests = rests_of(points, 0, points.size(), base.relative);
  const double rounding = enlarged(spatial_error(enlarged(points.error + base.placing_error + rests.error)));
  return {base.placed, enlarged(rests.farthest + rounding), rounding};
}

OffsetTriangle offset_triangle(BoundsCache& library, HullPoints& points,
                               const std::array<Vector3, 3>& corners) {
  for (std::size_t round = 0;; ++round) {
    const Base<3> base = moved_base(points, corners);
    const auto [rest, tips] = farthest(points, 0, points.tips_begin(), points.size(), base.relative);
    const bool tight = !base.tips_stick_out && tips.distance <= (1 + notable_excess) * rest.distance;
    if (!tight && round < max_tip_refinements &&
        refine_what_sticks_out(library, base, rest.distance, points)) {
      continue;
    }
    const kernels::Reach& reach = rest.distance >= tips.distance ? rest : tips;
    const double given = spatial_error(enlarged(points.error + base.placing_error));
    const double radius = reach.distance + given;
    return {base.placed, std::isfinite(radius) ? enlarged(radius) : INFINITY,
            enlarged(reach.rounding + given)};
  }
}

template <std::size_t N>
IntervalSimplex<N> interval_simplex(const HullPoints& points, const std::array<Vector3, N>& corners) {
  const Base<N> base = moved_base(points, corners);
  const Rests rests = rests_of(points, 0, points.size(), base.relative);
  const double error = enlarged(points.error + base.placing_error + rests.error);
  IntervalSimplex<N> result;
  for (std::size_t k = 0; k < N; ++k) {
    for (std::size_t a = 0; a < 3; ++a) {
      result.corner[k].lower[a] = rounded_down(base.placed[k][a] + rounded_down(rests.lower[a] - error));
      result.corner[k].upper[a] = rounded_up(base.placed[k][a] + rounded_up(rests.upper[a] + error));
    }
  }
  return result;
}

template IntervalSegment interval_simplex(const HullPoints&, const Ends&);
template IntervalTriangle interval_simplex(const HullPoints&, const Corners&);

}  // namespace snug
