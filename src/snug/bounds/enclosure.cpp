#include <snug/bounds/enclosure.h>

#include <algorithm>

#include <snug/geometry/rounding.h>
#include <support/direction.h>

namespace snug {
namespace {

// How much the boxes of tips may add to a hull before it is worth refining them.
constexpr double notable_excess = 0.03;

// Relative to the bounding points' origin.
using Ends = std::array<Vector3, 2>;
using Corners = std::array<Vector3, 3>;

// The way to the middle of the bounding points.
struct Shift {
  Vector3 by;
  bool tips_stick_out = false;  // along the normal, by a notable part of the hull's height
};

Shift to_middle(const BoundingPoints& points, const Corners& corners) {
  const Vector3 normal = normalized(cross(corners[1] - corners[0], corners[2] - corners[0]));
  if (normal == Vector3{}) return {};
  const kernels::Coordinates all = points.coordinates();
  auto [lower, upper] = kernels::heights(all.from(points.tips_end()), corners[0], normal);
  bool stick_out = false;
  if (!points.tips().empty()) {
    const kernels::Range tips = kernels::heights(all.first(points.tips_end()), corners[0], normal);
    stick_out = std::max(lower - tips.lower, tips.upper - upper) > notable_excess * (upper - lower);
    lower = std::min(lower, tips.lower);
    upper = std::max(upper, tips.upper);
  }
  return {(0.5 * (lower + upper)) * normal, stick_out};
}

Shift to_middle(const BoundingPoints& points, const Ends& ends) {
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
Base<N> moved_base(const BoundingPoints& points, const std::array<Vector3, N>& corners) {
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
Rests rests_of(const BoundingPoints& points, std::size_t begin, std::size_t end,
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
kernels::Reach farthest_by_feet(const BoundingPoints& points, std::size_t begin, std::size_t end,
                                const Corners& corner) {
  const Rests rests = rests_of(points, begin, end, corner);
  const double rounding = spatial_error(rests.error);
  return {rests.farthest + rounding, rounding};
}

// Of the three tips' points, 0 for none, and of all others: in the triangle's plane, if it has one.
std::array<kernels::Reach, 4> farthest(const BoundingPoints& points, const Corners& corner) {
  std::array<std::size_t, 3> splits;
  for (std::size_t i = 0; i < 3; ++i)
    splits[i] = std::min((i + 1) * BoundingPoints::tip_size, points.tips_end());
  const auto in_plane = kernels::farthest(points.coordinates(), splits, corner[0], corner[1], corner[2]);
  if (in_plane) return *in_plane;
  std::array<kernels::Reach, 4> reach{};
  std::size_t begin = 0;
  for (std::size_t i = 0; i < 4; ++i) {
    const std::size_t end = i < 3 ? splits[i] : points.size();
    if (begin < end) reach[i] = farthest_by_feet(points, begin, end, corner);
    begin = end;
  }
  return reach;
}

// Refines the tips that stick out of the rest of the hull. Those that stick out along the normal have moved
// the base towards them: then both sides are about as far.
bool refine_what_sticks_out(BoundsCache& library, bool along_normal,
                            const std::array<kernels::Reach, 4>& reach, BoundingPoints& points) {
  const double most = (along_normal ? 1 - notable_excess : 1 + notable_excess) * reach[3].distance;
  bool refined = false;
  for (std::size_t tip = 0; tip < points.tips().size(); ++tip) {
    if (!(reach[tip].distance > most)) continue;
    points.refine_tip(library, tip);
    refined = true;
  }
  return refined;
}

}  // namespace

OffsetSegment offset_segment(const BoundingPoints& points, const std::array<Vector3, 2>& ends) {
  const Base<2> base = moved_base(points, ends);
  const Rests rests = rests_of(points, 0, points.size(), base.relative);
  const double rounding = enlarged(spatial_error(enlarged(points.error + base.placing_error + rests.error)));
  return {base.placed, enlarged(rests.farthest + rounding), rounding};
}

OffsetTriangle offset_triangle(BoundsCache& library, BoundingPoints& points,
                               const std::array<Vector3, 3>& corners) {
  for (std::size_t round = 0;; ++round) {
    const Base<3> base = moved_base(points, corners);
    const std::array<kernels::Reach, 4> parts = farthest(points, base.relative);
    if (round < max_tip_refinements && refine_what_sticks_out(library, base.tips_stick_out, parts, points)) {
      continue;
    }
    const auto farther = [](const kernels::Reach& a, const kernels::Reach& b) {
      return a.distance < b.distance;
    };
    const kernels::Reach& reach = *std::max_element(parts.begin(), parts.end(), farther);
    const double given = spatial_error(enlarged(points.error + base.placing_error));
    const double radius = reach.distance + given;
    return {base.placed, std::isfinite(radius) ? enlarged(radius) : INFINITY,
            enlarged(reach.rounding + given)};
  }
}

template <std::size_t N>
IntervalSimplex<N> interval_simplex(const BoundingPoints& points, const std::array<Vector3, N>& corners) {
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

template IntervalSegment interval_simplex(const BoundingPoints&, const Ends&);
template IntervalTriangle interval_simplex(const BoundingPoints&, const Corners&);

}  // namespace snug
