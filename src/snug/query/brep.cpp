#include <snug/brep.h>
#include <snug/search/surface_data.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <set>
#include <utility>

#include <snug/geometry/rounding.h>
#include <snug/mesh/disjoint_sets.h>
#include <snug/query/brep_layout.h>
#include <snug/query/brep_voids.h>
#include <snug/spline/face_spline.h>
#include <snug/spline/quad_pieces.h>
#include <snug/surface/unscale.h>
#include <support/error.h>
#include <support/number.h>
#include <support/parallel.h>
#include <support/run.h>

namespace snug {
namespace {

constexpr double default_error = 1e-4;   // of the size
constexpr double share_of_fits = 0.999;  // of the error: the rest is for rounding
constexpr double level_factor = 2.5;     // by which a split brings a tip nearer, cautiously
constexpr std::uint8_t most_depth = 24;
constexpr int most_angle_rounds = 12;
constexpr double degrees = 57.29577951308232;

// How many spans the B-spline surface of a quad has: knots run across all of it.
std::uint64_t spans_of(const std::vector<QuadPiece>& pieces) {
  std::set<double> u, v;
  for (const QuadPiece& piece : pieces) {
    u.insert(piece.box().u0);
    v.insert(piece.box().v0);
  }
  return std::uint64_t{u.size()} * v.size();
}

// Makes the boundary representation of one surface.
class BrepMaker {
 public:
  BrepMaker(const LimitSurface& surface, const BrepOptions& options, const Run& run)
      : surface_(surface),
        run_(run),
        monitor_(monitor_of(run)),
        layout_(surface),
        back_(surface.scale().inverse()),
        error_(scaled_error(options)),
        max_angle_(options.max_angle),
        degree_(tensor_degree(surface.rules().basis)),
        budget_(run.max_splits.value_or(default_splits::brep)) {
    for (std::uint32_t q = 0; q < layout_.quads().size(); ++q) {
      if (!surface.kind(layout_.quads()[q].patch).polynomial()) irregular_.push_back(q);
    }
    pieces_.resize(layout_.quads().size());
  }

  [[nodiscard]] Brep run() {
    std::vector<std::uint32_t> all(pieces_.size());
    for (std::uint32_t q = 0; q < all.size(); ++q) all[q] = q;
    fit(all, 0);
    if (spans() > budget_) {
      throw InputError(InputProblem::value,
                       "at least " + std::to_string(spans()) + " spans are needed: give a larger budget");
    }
    refine_tips();
    drafts_ = layout_.packed([this](std::uint32_t q) -> const TensorPiece* {
      return pieces_[q].size() == 1 && degree_ > 1 ? &pieces_[q].front().piece : nullptr;
    });
    Brep brep = assembled();
    for (int round = 0; max_angle_ && brep.break_angle > *max_angle_ && round < most_angle_rounds; ++round) {
      if (!deepen_at_breaks()) break;
      refine_tips();
      brep = assembled();
    }
    const bool reached =
        brep.error_bound <= back_.apply(error_) && (!max_angle_ || brep.break_angle <= *max_angle_);
    brep.outcome = outcome_of(reached, spent_);
    return brep;
  }

 private:
  double scaled_error(const BrepOptions& options) const {
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
  static std::string text_of(double x) {
    std::string text;
    append_real(text, x);
    return text;
  }

  // Makes the pieces of some quads, by their present depths.
  void fit(const std::vector<std::uint32_t>& quads, double done) {
    std::atomic<std::size_t> count{0};
    parallel_for_with(
        quads.size(), run_.threads, [] { return Patch(); },
        [&](Patch& patch, std::size_t begin, std::size_t end) {
          for (std::size_t i = begin; i < end; ++i) {
            surface_.patch(layout_.quads()[quads[i]].patch, patch);
            pieces_[quads[i]] = QuadPieces(patch, layout_.depths(quads[i]), share_of_fits * error_).take();
          }
          count += end - begin;
          monitor_.report(
              std::max(done, 0.7 * static_cast<double>(count) / static_cast<double>(quads.size())));
        });
  }

  [[nodiscard]] std::uint64_t spans() const {
    std::uint64_t sum = 0;
    for (const std::vector<QuadPiece>& pieces : pieces_) sum += spans_of(pieces);
    return sum;
  }

  // The same for quads whose depths have changed. If the budget does not allow it they keep their pieces, and the result is false.
  bool fit_changed() {
    changed_ = layout_.take_changed(irregular_);
    std::vector<std::vector<QuadPiece>> before;
    for (const std::uint32_t q : changed_) before.push_back(pieces_[q]);
    fit(changed_, 0.7);
    if (spans() <= budget_) return true;
    for (std::size_t k = 0; k < changed_.size(); ++k) pieces_[changed_[k]] = std::move(before[k]);
    spent_ = true;
    return false;
  }

  // Splits at tips that are too far from the surface, until none is or the budget is spent.
  void refine_tips() {
    changed_ = irregular_;
    while (!changed_.empty() && !spent_) {
      for (const std::uint32_t q : changed_) {
        for (const QuadPiece& piece : pieces_[q]) {
          if (piece.tip && piece.corners() == 0) layout_.join_depths(q, piece);
          if (!piece.tip || piece.distance <= share_of_fits * error_) continue;
          const double levels = std::log(piece.distance / (share_of_fits * error_)) / std::log(level_factor);
          const double more = std::clamp(std::floor(levels), 1.0, 8.0);
          layout_.deepen(q, piece, static_cast<std::uint8_t>(more), most_depth);
        }
      }
      layout_.level_depths();
      fit_changed();
    }
  }

  // Splits at tips beside tangent breaks that are too large; false if nothing was split.
  bool deepen_at_breaks() {
    for (const auto& [quad, piece] : breaks_) layout_.deepen(quad, piece, 1, most_depth);
    return fit_changed() && !changed_.empty();
  }

  [[nodiscard]] std::vector<FacePart> parts_of(const FaceDraft& draft) const {
    std::vector<FacePart> parts;
    for (std::size_t y = 0; y < draft.height; ++y) {
      for (std::size_t x = 0; x < draft.width; ++x) {
        const PlacedQuad& placed = draft.at(x, y);
        const Point3 origin = origins_[placed.quad];
        for (const QuadPiece& piece : pieces_[placed.quad]) {
          const ParameterBox box = piece.box();
          const double u = static_cast<double>(x), v = static_cast<double>(y);
          parts.push_back({{u + box.u0, u + box.u1, v + box.v0, v + box.v1},
                           placed.turn == 0 ? piece.piece : turned(piece.piece, placed.turn),
                           origin,
                           piece.tip,
                           piece.distance});
        }
      }
    }
    return parts;
  }

  Brep assembled() {
    origins_.resize(pieces_.size());
    Brep brep;
    brep.faces.resize(drafts_.size());
    std::vector<std::size_t> spans(drafts_.size());
    std::atomic<std::size_t> count{0};
    parallel_for(pieces_.size(), run_.threads, [&](std::size_t begin, std::size_t end) {
      Patch patch;
      for (std::size_t q = begin; q < end; ++q) {
        surface_.patch(layout_.quads()[q].patch, patch);
        origins_[q] = patch.origin;
      }
    });
    parallel_for(drafts_.size(), run_.threads, [&](std::size_t begin, std::size_t end) {
      for (std::size_t f = begin; f < end; ++f) {
        monitor_.checkpoint();
        make_face(drafts_[f], brep.faces[f]);
        spans[f] = (breaks_of(brep.faces[f].surface.u_knots).size() - 1) *
                   (breaks_of(brep.faces[f].surface.v_knots).size() - 1);
      }
      count += end - begin;
      monitor_.report(0.7 + 0.25 * static_cast<double>(count) / static_cast<double>(drafts_.size()));
    });
    for (std::size_t f = 0; f < drafts_.size(); ++f) {
      brep.spans += spans[f];
      brep.error_bound = std::max(brep.error_bound, brep.faces[f].error_bound);
    }
    join(brep);
    measure_breaks(brep);
    sort_into_shells(brep);
    find_voids(brep);
    monitor_.report(1);
    return brep;
  }

  void make_face(const FaceDraft& draft, Brep::Face& face) const {
    const std::vector<FacePart> parts = parts_of(draft);
    SplineSurface& spline = face.surface;
    spline = spline_of(parts, degree_);
    // The bound is proved for the points that are handed out.
    SplineSurface scaled = spline;
    for (std::size_t i = 0; i < spline.points.size(); ++i) {
      spline.points[i] = require_representable(back_.apply(spline.points[i]));
      scaled.points[i] = surface_.scale().apply(spline.points[i]);
    }
    face.error_bound = unscaled_up(distance_bound(parts, scaled), back_);
    face.owner = surface_.place(layout_.quads()[draft.at(0, 0).quad].patch).owner;
  }

  // Edges and loops.
  void join(Brep& brep) {
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
      const SplineCurve curve = scaled(edge.curve);
      for (std::size_t k = 0; k < joint.count; ++k)
        gap = std::max(
            gap, distance_bound(curve, scaled(border_of(brep, joint.uses[k], k == 1, curve.knots.back()))));
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
  // The part of a face's border along a joint, in its direction.
  static SplineCurve curve_of(const Brep& brep, const JointUse& use, bool backwards) {
    const SplineCurve curve = part_of(side_of(brep.faces[use.face].surface, use.side), use.begin, use.end);
    return backwards ? reversed(curve) : curve;
  }
  // All of the border, with the parameters of a curve of this length along the joint. Where a quad adjoins two quads of a polygon
  // these differ by a factor of two.
  static SplineCurve border_of(const Brep& brep, const JointUse& use, bool backwards, double length) {
    SplineCurve border = side_of(brep.faces[use.face].surface, use.side);
    const double begin = backwards ? border.knots.back() - use.end : use.begin;
    if (backwards) border = reversed(border);
    for (double& knot : border.knots) knot = (knot - begin) * (length / use.length());
    return border;
  }
  SplineCurve scaled(SplineCurve curve) const {
    for (Point3& x : curve.points) x = surface_.scale().apply(x);
    return curve;
  }

  static std::array<double, 2> on_side(const FaceDraft& draft, std::size_t side, double t) {
    const auto w = static_cast<double>(draft.width), h = static_cast<double>(draft.height);
    return side == 0   ? std::array{t, 0.0}
           : side == 1 ? std::array{w, t}
           : side == 2 ? std::array{w - t, h}
                       : std::array{0.0, h - t};
  }

  // Angles between faces at tips across edges where the limit surface is smooth.
  void measure_breaks(Brep& brep) {
    breaks_.clear();
    std::vector<double> angles(joints_.size());
    parallel_for(joints_.size(), run_.threads, [&](std::size_t begin, std::size_t end) {
      for (std::size_t e = begin; e < end; ++e) angles[e] = break_of(brep, joints_[e]);
    });
    for (std::size_t e = 0; e < joints_.size(); ++e) {
      brep.break_angle = std::max(brep.break_angle, angles[e]);
      if (!max_angle_ || angles[e] <= *max_angle_) continue;
      for (const JointUse& use : joints_[e].uses) {
        const std::uint32_t q = drafts_[use.face].at(0, 0).quad;
        for (const QuadPiece& piece : pieces_[q]) {
          if (piece.tip && (piece.sides() >> use.side) % 2 == 1) breaks_.emplace_back(q, piece);
        }
      }
    }
  }
  [[nodiscard]] double break_of(const Brep& brep, const FaceJoint& joint) const {
    if (joint.count != 2) return 0;
    const auto has_tips = [&](const JointUse& use) {
      const FaceDraft& draft = drafts_[use.face];
      const auto& pieces = pieces_[draft.at(0, 0).quad];
      return draft.width * draft.height == 1 &&
             std::any_of(pieces.begin(), pieces.end(), [](const QuadPiece& piece) { return piece.tip; });
    };
    if (!has_tips(joint.uses[0]) && !has_tips(joint.uses[1])) return 0;
    const JointUse &a = joint.uses[0], &b = joint.uses[1];
    const double length = a.length(), ratio = b.length() / length;
    const auto angle_at = [&](double t) {
      const auto [u, v] = on_side(drafts_[a.face], a.side, a.begin + t);
      const auto [s, r] = on_side(drafts_[b.face], b.side, b.end - ratio * t);
      const SplineFrame p = frame_at(brep.faces[a.face].surface, u, v),
                        q = frame_at(brep.faces[b.face].surface, s, r);
      if (!p.normal || !q.normal) return 0.0;
      return degrees * std::atan2(snug::length(cross(*p.normal, *q.normal)), dot(*p.normal, *q.normal));
    };
    if (!layout_.smooth(joint, length)) return 0;
    double largest = 0;
    const std::vector<double> breaks = breaks_of(side_of(brep.faces[a.face].surface, a.side).knots);
    for (std::size_t k = 0; k + 1 < breaks.size(); ++k) {
      for (const double share : {0.25, 0.5, 0.75}) {
        const double t = breaks[k] + share * (breaks[k + 1] - breaks[k]) - a.begin;
        if (t > 0 && t < length) largest = std::max(largest, angle_at(t));
      }
    }
    return largest;
  }

  static void sort_into_shells(Brep& brep) {
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
      if (root != last)
        brep.shells.push_back({static_cast<std::uint32_t>(sorted.size()), 0, !open[root], {}});
      last = root;
      sorted.push_back(std::move(brep.faces[f]));
      brep.shells.back().end = static_cast<std::uint32_t>(sorted.size());
    }
    brep.faces = std::move(sorted);
  }

  const LimitSurface& surface_;
  const Run& run_;
  const WorkMonitor& monitor_;
  BrepLayout layout_;
  PowerOfTwo back_;
  double error_;  // in scaled units
  std::optional<double> max_angle_;
  std::size_t degree_;
  std::uint64_t budget_;  // of spans
  bool spent_ = false;
  std::vector<std::uint32_t> irregular_, changed_;  // quads
  std::vector<std::vector<QuadPiece>> pieces_;      // of quads
  std::vector<Point3> origins_;
  std::vector<FaceDraft> drafts_;
  std::vector<FaceJoint> joints_;
  std::vector<std::pair<std::uint32_t, QuadPiece>> breaks_;
};

}  // namespace

Brep to_brep(const Surface& surface, const BrepOptions& options, const Run& run) {
  const LimitSurface& limit = surface.data()->limit();
  if (!is_tensor(limit.rules().basis)) {
    throw InputError(InputProblem::refused,
                     std::string("B-spline faces are made of schemes of quads, and this surface's is ") +
                         name_of(surface.scheme()) + ": tessellate() makes triangles of it");
  }
  return BrepMaker(limit, options, run).run();
}

}  // namespace snug
