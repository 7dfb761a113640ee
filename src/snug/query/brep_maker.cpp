#include <snug/query/brep_maker.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include <snug/geometry/angles.h>
#include <snug/geometry/rounding.h>
#include <snug/mesh/disjoint_sets.h>
#include <snug/query/brep_voids.h>
#include <snug/surface/unscale.h>
#include <support/error.h>
#include <support/number.h>
#include <support/parallel.h>
#include <support/run.h>

namespace snug {
namespace {

constexpr double default_error = 1e-4;  // of the size
constexpr double degrees = 57.29577951308232;

std::string text_of(double x) {
  std::string text;
  append_real(text, x);
  return text;
}

std::size_t spans_of(const SplineSurface& s) {
  return (breaks_of(s.u_knots).size() - 1) * (breaks_of(s.v_knots).size() - 1);
}

template <class Shape>
Shape scaled(Shape shape, PowerOfTwo scale) {
  for (Point3& x : shape.points) x = scale.apply(x);
  return shape;
}

// All of a border, with the parameters of a curve of this length along the joint. Where a quad adjoins two quads of a polygon
// these differ by a factor of two.
SplineCurve border_of(const Brep& brep, const JointUse& use, bool backwards, double length) {
  SplineCurve border = side_of(brep.faces[use.face].surface, use.side);
  const double begin = backwards ? border.knots.back() - use.end : use.begin;
  if (backwards) border = reversed(border);
  for (double& knot : border.knots) knot = (knot - begin) * (length / use.length());
  return border;
}

void sort_into_shells(Brep& brep) {
  std::vector<std::array<std::uint32_t, 2>> faces_of(brep.edges.size(), {UINT32_MAX, UINT32_MAX});
  DisjointSets sets(brep.faces.size());
  for (std::uint32_t f = 0; f < brep.faces.size(); ++f) {
    for (const Brep::Side& side : brep.faces[f].loop) {
      auto& both = faces_of[side.edge];
      (both[0] == UINT32_MAX ? both[0] : both[1]) = f;
      sets.join(both[0], f);
    }
  }
  std::vector<std::uint32_t> order(brep.faces.size());
  for (std::uint32_t f = 0; f < order.size(); ++f) order[f] = f;
  std::stable_sort(order.begin(), order.end(),
                   [&](std::uint32_t a, std::uint32_t b) { return sets.least(a) < sets.least(b); });
  std::vector<bool> open(brep.faces.size());
  for (const auto& both : faces_of) {
    if (both[0] != UINT32_MAX && both[1] == UINT32_MAX) open[sets.least(both[0])] = true;
  }
  std::vector<Brep::Face> sorted;
  sorted.reserve(order.size());
  brep.shells.clear();
  std::uint32_t last = UINT32_MAX;
  for (const std::uint32_t f : order) {
    const std::uint32_t root = sets.least(f);
    if (root != last) brep.shells.push_back({static_cast<std::uint32_t>(sorted.size()), 0, !open[root], {}});
    last = root;
    sorted.push_back(std::move(brep.faces[f]));
    brep.shells.back().end = static_cast<std::uint32_t>(sorted.size());
  }
  brep.faces = std::move(sorted);
}

}  // namespace

BrepMaker::BrepMaker(const LimitSurface& surface, const BrepOptions& options, const Run& run)
    : surface_(surface),
      run_(run),
      monitor_(monitor_of(run)),
      layout_(surface),
      back_(surface.scale().inverse()),
      error_(scaled_error(options)),
      max_angle_(options.max_angle),
      budget_(run.max_splits.value_or(default_splits::brep)) {}

double BrepMaker::scaled_error(const BrepOptions& options) const {
  const double size = surface_.size();
  const double error = options.error.value_or(default_error * size);
  require_value(std::isfinite(error) && error > 0, "the error is not a positive, finite number");
  if (options.max_angle) {
    require_value(*options.max_angle > 0 && *options.max_angle <= 90,
                  "the largest angle is not above 0 and at most 90 degrees");
  }
  const double least = 0x1p-40 * size;
  if (error < least) {
    throw InputError(InputProblem::value,
                     "the error is below what doubles allow: the least is " + text_of(least));
  }
  return surface_.scale().apply(error);
}

void BrepMaker::require_spans(std::uint64_t least) const {
  if (least <= budget_) return;
  throw InputError(InputProblem::value,
                   "at least " + std::to_string(least) + " spans are needed: give a larger budget");
}

Brep BrepMaker::run() {
  fit();
  Brep brep = *assembled(false);
  for (int round = 0; max_angle_ && brep.break_angle > *max_angle_ && round < most_angle_rounds; ++round) {
    if (!deepen_at_breaks(breaks_)) break;
    std::optional<Brep> next = assembled(true);
    if (!next) break;
    brep = std::move(*next);
  }
  const bool reached =
      brep.error_bound <= back_.apply(error_) && (!max_angle_ || brep.break_angle <= *max_angle_);
  brep.outcome = outcome_of(reached, spent_);
  return brep;
}

std::optional<Brep> BrepMaker::assembled(bool again) {
  if (!prepare(again)) return {};
  Brep brep;
  brep.faces.resize(drafts_.size());
  std::atomic<std::size_t> count{0};
  parallel_for(drafts_.size(), run_.threads, [&](std::size_t begin, std::size_t end) {
    for (std::size_t f = begin; f < end; ++f) {
      monitor_.checkpoint();
      make_face(drafts_[f], brep.faces[f]);
      brep.faces[f].owner = surface_.place(layout_.quads()[drafts_[f].at(0, 0).quad].patch).owner;
    }
    count += end - begin;
    monitor_.report(0.7 + 0.25 * static_cast<double>(count) / static_cast<double>(drafts_.size()));
  });
  for (const Brep::Face& face : brep.faces) {
    brep.spans += spans_of(face.surface);
    brep.error_bound = std::max(brep.error_bound, face.error_bound);
  }
  join(brep);
  measure_breaks(brep);
  sort_into_shells(brep);
  find_voids(brep, monitor_);
  monitor_.report(1);
  return brep;
}

void BrepMaker::take_parts(const std::vector<FacePart>& parts, std::size_t natural, Brep::Face& face) const {
  SplineSurface& spline = face.surface;
  spline = spline_of(parts, natural);
  // The bound is proved for the points that are handed out.
  for (Point3& p : spline.points) p = require_representable(back_.apply(p));
  face.error_bound = unscaled_up(distance_bound(parts, scaled(spline, surface_.scale())), back_);
}

// Edges and loops.
void BrepMaker::join(Brep& brep) {
  joints_ = layout_.joined(drafts_);
  brep.edges.resize(joints_.size());
  std::vector<std::uint32_t> number(layout_.name_count(), UINT32_MAX);
  double gap = 0;  // in scaled units
  for (std::uint32_t e = 0; e < joints_.size(); ++e) {
    const FaceJoint& joint = joints_[e];
    Brep::Edge& edge = brep.edges[e];
    edge.curve = curve_of(brep, joint.uses[0], false);
    if (joint.count == 2) {
      SplineCurve other = curve_of(brep, joint.uses[1], true);
      if (other.points.size() < edge.curve.points.size()) edge.curve = std::move(other);
    }
    // The curve that is handed out is compared with the borders themselves.
    const SplineCurve curve = scaled(edge.curve, surface_.scale());
    for (std::size_t k = 0; k < joint.count; ++k)
      gap = std::max(gap, gap_of(brep, joint.uses[k], k == 1, curve));
    for (std::size_t k = 0; k < 2; ++k) {
      const Point3 end = k == 0 ? edge.curve.points.front() : edge.curve.points.back();
      std::uint32_t& vertex = number[joint.ends[k]];
      if (vertex == UINT32_MAX) {
        vertex = static_cast<std::uint32_t>(brep.vertices.size());
        brep.vertices.push_back(end);
      } else {
        const PowerOfTwo scale = surface_.scale();
        gap = std::max(gap, enlarged(distance(scale.apply(end), scale.apply(brep.vertices[vertex]))));
      }
      edge.vertices[k] = vertex;
    }
  }
  brep.gap_bound = unscaled_up(gap, back_);
  for (Brep::Face& face : brep.faces) face.loop.clear();
  for (const LoopSide& side : layout_.loops(drafts_, joints_))
    brep.faces[side.face].loop.push_back({side.joint, side.reversed});
}

// Is it the third side of a face over one triangle?
bool BrepMaker::is_diagonal(const JointUse& use) const {
  return use.side == 2 && layout_.quads()[drafts_[use.face].at(0, 0).quad].side_count() == 3;
}

// The part of a face's border along a joint, in its direction.
SplineCurve BrepMaker::curve_of(const Brep& brep, const JointUse& use, bool backwards) const {
  const SplineSurface& surface = brep.faces[use.face].surface;
  if (is_diagonal(use)) return backwards ? diagonal_of(surface) : reversed(diagonal_of(surface));
  const SplineCurve curve = part_of(side_of(surface, use.side), use.begin, use.end);
  return backwards ? reversed(curve) : curve;
}

double BrepMaker::gap_of(const Brep& brep, const JointUse& use, bool backwards,
                         const SplineCurve& curve) const {
  if (is_diagonal(use)) {
    return distance_from_diagonal(scaled(brep.faces[use.face].surface, surface_.scale()),
                                  backwards ? curve : reversed(curve));
  }
  return distance_bound(curve, scaled(border_of(brep, use, backwards, curve.knots.back()), surface_.scale()));
}

std::array<double, 2> BrepMaker::on_side(const FaceDraft& draft, std::size_t side, double t) const {
  const auto w = static_cast<double>(draft.width), h = static_cast<double>(draft.height);
  if (side == 2 && layout_.quads()[draft.at(0, 0).quad].side_count() == 3) return {1 - t, 1 - t};
  return side == 0   ? std::array{t, 0.0}
         : side == 1 ? std::array{w, t}
         : side == 2 ? std::array{w - t, h}
                     : std::array{0.0, h - t};
}

BrepMaker::Break BrepMaker::place_of(const JointUse& use, double t) const {
  const FaceDraft& draft = drafts_[use.face];
  const std::size_t count = use.side % 2 == 0 ? draft.width : draft.height;
  const std::size_t k = std::min(static_cast<std::size_t>(t), count - 1);
  const PlacedQuad& placed = use.side == 0   ? draft.at(k, 0)
                             : use.side == 1 ? draft.at(draft.width - 1, k)
                             : use.side == 2 ? draft.at(draft.width - 1 - k, draft.height - 1)
                                             : draft.at(0, draft.height - 1 - k);
  return {placed.quad, (use.side + placed.turn) % layout_.quads()[placed.quad].side_count(),
          t - static_cast<double>(k)};
}

// Angles between faces across edges where the limit surface is smooth.
void BrepMaker::measure_breaks(Brep& brep) {
  std::vector<double> angles(joints_.size());
  std::vector<std::vector<Break>> breaks(joints_.size());
  parallel_for(joints_.size(), run_.threads, [&](std::size_t begin, std::size_t end) {
    for (std::size_t e = begin; e < end; ++e) {
      monitor_.checkpoint();
      angles[e] = break_of(brep, joints_[e], breaks[e]);
    }
  });
  breaks_.clear();
  for (std::size_t e = 0; e < joints_.size(); ++e) {
    brep.break_angle = std::max(brep.break_angle, angles[e]);
    breaks_.insert(breaks_.end(), breaks[e].begin(), breaks[e].end());
  }
}

// Also says where they are too large.
double BrepMaker::break_of(const Brep& brep, const FaceJoint& joint, std::vector<Break>& where) const {
  if (joint.count != 2) return 0;
  const JointUse &a = joint.uses[0], &b = joint.uses[1];
  if (!may_break(drafts_[a.face]) && !may_break(drafts_[b.face])) return 0;
  const double length = a.length(), ratio = b.length() / length;
  const auto angle_at = [&](double t) {
    const auto [u, v] = on_side(drafts_[a.face], a.side, a.begin + t);
    const auto [s, r] = on_side(drafts_[b.face], b.side, b.end - ratio * t);
    const SplineFrame p = frame_at(brep.faces[a.face].surface, u, v),
                      q = frame_at(brep.faces[b.face].surface, s, r);
    if (!p.normal || !q.normal) return 0.0;
    return degrees * angle_of(snug::length(cross(*p.normal, *q.normal)), dot(*p.normal, *q.normal));
  };
  if (!layout_.smooth(joint, length)) return 0;
  double largest = 0;
  const SplineSurface& surface = brep.faces[a.face].surface;
  std::vector<double> breaks = breaks_of(a.side % 2 == 0 ? surface.u_knots : surface.v_knots);
  if (a.side >= 2) {  // sides run backwards there
    const double end = breaks.back();
    for (double& t : breaks) t = end - t;
    std::reverse(breaks.begin(), breaks.end());
  }
  for (std::size_t k = 0; k + 1 < breaks.size(); ++k) {
    double here = 0;
    for (const double share : {0.25, 0.5, 0.75}) {
      const double t = breaks[k] + share * (breaks[k + 1] - breaks[k]) - a.begin;
      if (t > 0 && t < length) here = std::max(here, angle_at(t));
    }
    largest = std::max(largest, here);
    if (max_angle_ && here > *max_angle_) {
      const double middle = 0.5 * (breaks[k] + breaks[k + 1]);
      for (const bool first : {true, false}) {
        where.push_back(first ? place_of(a, middle) : place_of(b, b.end - ratio * (middle - a.begin)));
        where.back().angle = here / *max_angle_;
      }
    }
  }
  return largest;
}

}  // namespace snug
