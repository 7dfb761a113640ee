#include <snug/query/collide.h>

#include <algorithm>
#include <cmath>

#include <snug/base/contract.h>
#include <snug/base/error.h>
#include <snug/base/parallel.h>
#include <snug/base/rounding.h>
#include <snug/enclose/triangle_distance.h>
#include <snug/patch/evaluate.h>
#include <snug/surface/unscale.h>

namespace snug {
namespace {

PlacedFrame make_frame(const Surface& surface, const Placement& placement, PowerOfTwo world) {
  PlacedFrame frame;
  frame.rows = {placement.row(0), placement.row(1), placement.row(2)};
  frame.scale = (surface.scale().inverse() * world).apply(1.0);
  frame.translation = world.apply(placement.translation());
  frame.defect = rigidity_defect(placement);
  return frame;
}

// The power of two that brings both placed surfaces to about 1.
PowerOfTwo joint_scale(const Surface& a, const Placement& place_a, const Surface& b,
                       const Placement& place_b) {
  // Surfaces are at most 2 in their own scales.
  int exponent = std::max(-a.scale().exponent(), -b.scale().exponent());
  for (const Placement* placement : {&place_a, &place_b}) {
    const double t = max_abs(placement->translation());
    if (t > 0) exponent = std::max(exponent, std::ilogb(t));
  }
  return PowerOfTwo(-exponent);
}

OffsetTriangle placed(const OffsetTriangle& triangle, const PlacedFrame& frame) {
  OffsetTriangle result;
  double error = 0;
  for (std::size_t k = 0; k < 3; ++k) {
    result.base[k] = frame.apply(triangle.base[k]);
    error = std::max(error, frame.apply_error(triangle.base[k]));
  }
  result.radius = enlarged(triangle.radius * frame.growth() + spatial_error(error));
  return result;
}

double extent_of(const OffsetTriangle& t) {
  return std::max({max_abs(t.base[1] - t.base[0]), max_abs(t.base[2] - t.base[0]),
                   max_abs(t.base[2] - t.base[1])}) +
         t.radius;
}

// Barycentric weights as a parameter that limit_point accepts.
TriangleParameter parameter(Barycentric p) {
  const double b = std::clamp(p.b, 0.0, 1.0);
  double c = std::clamp(p.c, 0.0, 1.0 - b);
  if (b + c > 1) c = 0;
  return {b, c};
}

class Query {
 public:
  Query(const CollisionModel& a, const Placement& place_a, const CollisionModel& b, const Placement& place_b,
        const CollideOptions& options, CollideScratch& scratch, const WorkMonitor& monitor)
      : model_{&a, &b}, refinement_{&scratch.a, &scratch.b}, monitor_(monitor), budget_(options.budget) {
    world_ = joint_scale(a.surface(), place_a, b.surface(), place_b);
    frame_[0] = make_frame(a.surface(), place_a, world_);
    frame_[1] = make_frame(b.surface(), place_b, world_);
    defect_ = frame_[0].defect + frame_[1].defect;
    margin_ = world_.apply(options.margin);
    if (!world_.exact(options.margin)) margin_ = rounded_up(margin_ + underflow_error);
    const double reach = options.margin + options.tolerance;
    reach_ = rounded_down(world_.apply(rounded_down(reach)) - underflow_error);
  }

  Collision run() {
    descend();
    return result();
  }

 private:
  struct NodePair {
    std::uint32_t a, b;
    double gap;  // of the boxes
  };
  struct PiecePair {
    PieceId a, b;
  };

  [[nodiscard]] PlacedObb box(std::size_t side, std::uint32_t node) const {
    return snug::placed(model_[side]->tree().node(node).box, frame_[side]);
  }

  // Depth first through both trees, the pair that overlaps more deeply first.
  void descend() {
    std::vector<NodePair> stack;
    const auto push_if_near = [&](std::uint32_t a, std::uint32_t b) {
      ++stats_.box_tests;
      const double gap = certain_gap(box(0, a), box(1, b), defect_);
      if (gap > margin_) {
        lower_ = std::min(lower_, gap);
      } else {
        stack.push_back({a, b, gap});
      }
    };
    push_if_near(0, 0);
    while (!stack.empty() && !found_ && !exhausted_) {
      const NodePair pair = stack.back();
      stack.pop_back();
      const ObbTree::Node& a = model_[0]->tree().node(pair.a);
      const ObbTree::Node& b = model_[1]->tree().node(pair.b);
      if (a.is_leaf() && b.is_leaf()) {
        leaves(a.leaf, b.leaf);
        continue;
      }
      const std::size_t before = stack.size();
      const double size_a = frame_[0].scale * max_abs(a.box.half),
                   size_b = frame_[1].scale * max_abs(b.box.half);
      if (b.is_leaf() || (!a.is_leaf() && size_a >= size_b)) {
        push_if_near(a.first_child, pair.b);
        push_if_near(a.first_child + 1, pair.b);
      } else {
        push_if_near(pair.a, b.first_child);
        push_if_near(pair.a, b.first_child + 1);
      }
      if (stack.size() == before + 2 && stack[before].gap < stack[before + 1].gap) {
        std::swap(stack[before], stack[before + 1]);
      }
    }
  }

  void leaves(std::uint32_t leaf_a, std::uint32_t leaf_b) {
    monitor_.checkpoint();
    const NearestTriangles near =
        test(placed(model_[0]->offset(leaf_a), frame_[0]), placed(model_[1]->offset(leaf_b), frame_[1]));
    if (dropped_) return;
    refine(refinement_[0]->root(model_[0]->patch(leaf_a)), refinement_[1]->root(model_[1]->patch(leaf_b)),
           near);
  }

  // Rule (a): sets dropped_ if the offset triangles are farther apart than the margin.
  NearestTriangles test(const OffsetTriangle& a, const OffsetTriangle& b) {
    ++stats_.triangle_tests;
    const NearestTriangles near = nearest(a.base, b.base);
    const double gap = rounded_down(near.certain_distance - enlarged(a.radius + b.radius));
    dropped_ = gap > margin_;
    if (dropped_) lower_ = std::min(lower_, gap);
    return near;
  }

  // Rules (b) and (c), depth first, the nearest pair of pieces first.
  void refine(PieceId root_a, PieceId root_b, const NearestTriangles& root_near) {
    struct Task {
      PiecePair pair;
      NearestTriangles near;
      double distance;  // between the base triangles
    };
    std::vector<Task> stack{{{root_a, root_b}, root_near, 0}};
    while (!stack.empty()) {
      const Task task = stack.back();
      stack.pop_back();
      if (try_witness(task.pair, task.near)) return;
      const int side = side_to_split(task.pair);
      if (side < 0) {
        unresolved_ = true;
        continue;
      }
      if (stats_.splits >= budget_) {
        exhausted_ = true;
        return;
      }
      ++stats_.splits;
      monitor_.checkpoint();
      const PieceId whole = side == 0 ? task.pair.a : task.pair.b;
      const PieceId first = refinement_[side]->split(whole);
      const PieceId other = side == 0 ? task.pair.b : task.pair.a;
      const OffsetTriangle placed_other = placed((*refinement_[1 - side])[other].offset, frame_[1 - side]);
      std::array<Task, 4> kept;
      std::size_t count = 0;
      for (unsigned child = 0; child < 4; ++child) {
        const PieceId id(first.index() + child);
        const OffsetTriangle placed_child = placed((*refinement_[side])[id].offset, frame_[side]);
        const NearestTriangles near =
            side == 0 ? test(placed_child, placed_other) : test(placed_other, placed_child);
        if (dropped_) continue;
        const PiecePair pair = side == 0 ? PiecePair{id, other} : PiecePair{other, id};
        kept[count++] = {pair, near, near.certain_distance};
      }
      std::stable_sort(kept.begin(), kept.begin() + static_cast<std::ptrdiff_t>(count),
                       [](const Task& x, const Task& y) { return x.distance > y.distance; });
      stack.insert(stack.end(), kept.begin(), kept.begin() + static_cast<std::ptrdiff_t>(count));
    }
  }

  // The larger piece that can still be split, or -1.
  int side_to_split(const PiecePair& pair) const {
    const std::array<PieceId, 2> ids{pair.a, pair.b};
    double size[2];
    for (std::size_t s = 0; s < 2; ++s) {
      size[s] = refinement_[s]->can_split(ids[s])
                    ? frame_[s].scale * extent_of((*refinement_[s])[ids[s]].offset)
                    : -1;
    }
    if (size[0] < 0 && size[1] < 0) return -1;
    return size[0] >= size[1] ? 0 : 1;
  }

  // Rule (b): limit points at the nearest parameters.
  bool try_witness(const PiecePair& pair, const NearestTriangles& near) {
    const std::array<PieceId, 2> ids{pair.a, pair.b};
    const std::array<Barycentric, 2> at{near.on_a, near.on_b};
    std::array<Point3, 2> points;
    double error = 0;
    for (std::size_t s = 0; s < 2; ++s) {
      const Piece& piece = (*refinement_[s])[ids[s]];
      const LimitPoint limit = limit_point(piece.patch, parameter(at[s]));
      const Point3 local = piece.patch.origin + limit.relative;
      points[s] = frame_[s].apply(local);
      const double local_error = limit.error + unit_roundoff * max_abs(local - Point3{});
      error = std::max(
          error, enlarged(frame_[s].growth() * spatial_error(local_error)) + frame_[s].apply_error(local));
    }
    ++stats_.evaluations;
    const double distance =
        enlarged(std::sqrt(length_sq(points[1] - points[0]) + 8 * underflow_error) +
                 2 * spatial_error(error) + 8 * unit_roundoff * max_abs(points[1] - points[0]));
    if (distance < upper_) {
      upper_ = distance;
      witness_ = points;
      witness_error_ = error;
    }
    found_ = distance <= reach_;
    return found_;
  }

  Collision result() {
    const PowerOfTwo back = world_.inverse();
    Collision answer;
    answer.stats = stats_;
    if (found_) {
      answer.verdict = Verdict::within;
    } else if (exhausted_ || unresolved_) {
      answer.verdict = Verdict::undecided;
    } else {
      answer.verdict = Verdict::separated;
    }
    // Pairs that were not looked at, or not resolved, may be as near as 0.
    const bool whole = answer.verdict == Verdict::separated;
    answer.lower = whole ? unscaled_down(std::min(lower_, upper_), back) : 0.0;
    if (witness_) {
      answer.witness = {require_representable(back.apply((*witness_)[0])),
                        require_representable(back.apply((*witness_)[1]))};
      answer.upper = require_representable(unscaled_up(upper_, back));
      answer.witness_error = unscaled_up(witness_error_, back) + underflow_error;
    }
    return answer;
  }

  std::array<const CollisionModel*, 2> model_;
  std::array<Refinement*, 2> refinement_;
  const WorkMonitor& monitor_;
  std::uint64_t budget_;
  PowerOfTwo world_;
  std::array<PlacedFrame, 2> frame_;
  double defect_ = 0, margin_ = 0, reach_ = 0;
  double lower_ = INFINITY, upper_ = INFINITY, witness_error_ = 0;
  std::optional<std::array<Point3, 2>> witness_;
  bool found_ = false, dropped_ = false, exhausted_ = false, unresolved_ = false;
  CollideStats stats_;
};

}  // namespace

const char* name_of(Verdict verdict) {
  switch (verdict) {
    case Verdict::separated:
      return "separated";
    case Verdict::within:
      return "within";
    case Verdict::undecided:
      return "undecided";
  }
  return "";
}

CollisionModel::CollisionModel(const Surface& surface, int threads, const WorkMonitor& monitor,
                               std::optional<TableLayout> table)
    : surface_(&surface), table_(table) {
  for (std::size_t p = 0; p < surface.patch_count(); ++p) {
    if (surface.has_patch(PatchId(p))) patches_.push_back(PatchId(p));
  }
  if (patches_.empty()) {
    throw InputError(InputProblem::refused,
                     "nothing here has a limit surface: all touches the boundary or is a hole; take another "
                     "boundary rule");
  }
  offsets_.resize(patches_.size());
  parallel_for(patches_.size(), threads, [&](std::size_t begin, std::size_t end) {
    monitor.checkpoint();
    HullPoints points;
    for (std::size_t i = begin; i < end; ++i) {
      offsets_[i] =
          make_piece(surface.library(), patches_[i], surface.patch(patches_[i]), points, table_).offset;
    }
  });
  tree_ = ObbTree(offsets_);
}

Collision collide(const CollisionModel& a, const Placement& place_a, const CollisionModel& b,
                  const Placement& place_b, const CollideOptions& options, CollideScratch& scratch,
                  const WorkMonitor& monitor) {
  SNUG_EXPECT(options.tolerance > 0 && std::isfinite(options.tolerance));
  SNUG_EXPECT(options.margin >= 0 && std::isfinite(options.margin));
  SNUG_EXPECT(rigidity_defect(place_a) <= rigidity_tolerance &&
              rigidity_defect(place_b) <= rigidity_tolerance);
  return Query(a, place_a, b, place_b, options, scratch, monitor).run();
}

}  // namespace snug
