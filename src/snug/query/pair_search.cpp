#include <snug/query/pair_search.h>

#include <algorithm>
#include <cmath>

#include <snug/base/contract.h>
#include <snug/base/rounding.h>
#include <snug/patch/evaluate.h>
#include <snug/query/crossing.h>

namespace snug {
namespace {

PlacedFrame make_frame(const Surface& surface, const Placement& placement, PowerOfTwo world, double defect) {
  PlacedFrame frame;
  frame.rows = {placement.row(0), placement.row(1), placement.row(2)};
  frame.scale = (surface.scale().inverse() * world).apply(1.0);
  frame.translation = world.apply(placement.translation());
  frame.defect = defect;
  return frame;
}

// The power of two that brings both placed surfaces to about 1.
PowerOfTwo joint_scale(const PlacedModel& a, const PlacedModel& b) {
  // Surfaces are at most 2 in their own scales.
  int exponent = std::max(-a.model.surface().scale().exponent(), -b.model.surface().scale().exponent());
  const double t = std::max(max_abs(a.placement.translation()), max_abs(b.placement.translation()));
  if (t > 0) exponent = std::max(exponent, std::ilogb(t));
  return PowerOfTwo(-exponent);
}

// Barycentric weights as a parameter that limit_point accepts.
TriangleParameter parameter(Barycentric p) {
  const double b = std::clamp(p.b, 0.0, 1.0);
  double c = std::clamp(p.c, 0.0, 1.0 - b);
  if (b + c > 1) c = 0;
  return {b, c};
}

}  // namespace

PairSearch::PairSearch(const PlacedModel& a, const PlacedModel& b) : scratch_{&a.scratch, &b.scratch} {
  SNUG_EXPECT(&a.scratch != &b.scratch && &a.scratch.model() == &a.model && &b.scratch.model() == &b.model);
  const double defect_a = rigidity_defect(a.placement), defect_b = rigidity_defect(b.placement);
  SNUG_EXPECT(defect_a <= rigidity_tolerance && defect_b <= rigidity_tolerance);
  world_ = joint_scale(a, b);
  frame_[0] = make_frame(a.model.surface(), a.placement, world_, defect_a);
  frame_[1] = make_frame(b.model.surface(), b.placement, world_, defect_b);
  const Ball& ball_a = a.model.tree().ball();
  const Ball& ball_b = b.model.tree().ball();
  const Point3 centre_a = frame_[0].apply(ball_a.centre), centre_b = frame_[1].apply(ball_b.centre);
  const double error = frame_[0].apply_error(ball_a.centre) + frame_[1].apply_error(ball_b.centre);
  ball_gap_ = length(centre_b - centre_a) * (1 - 8 * unit_roundoff) -
              enlarged(ball_a.radius * frame_[0].growth() + ball_b.radius * frame_[1].growth() +
                       spatial_error(error));
}

void PairSearch::prepare() {
  const Volume volume = scratch_[0]->blocks(false).volume();
  SNUG_EXPECT(volume == scratch_[1]->blocks(false).volume());
  for (std::size_t s = 0; s < 2; ++s) {
    view_[s] = View(volume, frame_[s], frame_[1 - s]);
    scale_[s] = static_cast<float>(frame_[s].scale);
    scratch_[s]->begin();
  }
}

double PairSearch::length_down(double mesh_units) const {
  return rounded_down(world_.apply(mesh_units) - underflow_error);
}

double PairSearch::length_up(double mesh_units) const {
  const double x = world_.apply(mesh_units);
  return world_.exact(mesh_units) ? x : rounded_up(x + underflow_error);
}

Blocks::Distances PairSearch::gaps(std::size_t side, std::uint32_t block, const Blocks& blocks,
                                   Node other) const {
  Blocks::Distances gaps;
  const RelativeFrame& frame = view_[side].frame;
  if (!frame.comparable) {
    gaps.fill(-INFINITY);
    return gaps;
  }
  PlacedVolume seen;
  scratch_[1 - side]->blocks(other.piece).placed(other.lane(), view_[side], seen);
  blocks.distances(block, seen, frame.slack, gaps);
  return gaps;
}

namespace {

// In the search's units. One rounding of the product, one of the single precision.
double in_world(float gap, const RelativeFrame& frame) {
  const double world = static_cast<double>(gap) * frame.to_world;
  return world > 0 ? world * (1 - 4 * unit_roundoff) : world;
}

}  // namespace

NodePair PairSearch::roots() const {
  NodePair pair;
  for (std::size_t s = 0; s < 2; ++s) {
    pair.nodes[s] = scratch_[s]->root();
    pair.sizes[s] = scale_[s] * scratch_[s]->blocks(false).size_of(pair.nodes[s].lane());
  }
  const std::size_t side = view_[0].frame.comparable ? 0 : 1;
  pair.gap =
      in_world(gaps(side, pair.nodes[side].block, scratch_[side]->blocks(false), pair.nodes[1 - side])[0],
               view_[side].frame);
  return pair;
}

std::optional<std::size_t> PairSearch::side_to_open(const NodePair& pair) const {
  const std::size_t larger = pair.sizes[1] > pair.sizes[0] ? 1 : 0;
  if (scratch_[larger]->can_open(pair.nodes[larger])) return larger;
  if (scratch_[1 - larger]->can_open(pair.nodes[1 - larger])) return 1 - larger;
  return std::nullopt;
}

double PairSearch::open(const NodePair& pair, std::size_t side, double most, std::vector<NodePair>& out) {
  const Node node = pair.nodes[side], other = pair.nodes[1 - side];
  if (node.piece) ++stats.splits;
  const QueryScratch::Opened opened = scratch_[side]->open(node);
  const Blocks& blocks = scratch_[side]->blocks(opened.piece);
  const std::size_t count = blocks.count(opened.block);
  stats.box_tests += count;
  const Blocks::Distances found = gaps(side, opened.block, blocks, other);
  double least = INFINITY;
  const std::size_t before = out.size();
  for (std::size_t i = 0; i < count; ++i) {
    double gap = in_world(found[i], view_[side].frame);
    if (pair.gap > 0) gap = std::max(gap, pair.gap);
    if (gap > most) {
      least = std::min(least, gap);
      continue;
    }
    NodePair next;
    next.nodes[side] = {opened.block, static_cast<std::uint8_t>(i), opened.piece};
    next.nodes[1 - side] = other;
    next.sizes[side] = scale_[side] * blocks.size_of({opened.block, static_cast<std::uint32_t>(i)});
    next.sizes[1 - side] = pair.sizes[1 - side];
    next.gap = gap;
    // Insertion: a handful of pairs, equal ones in the order of their lanes.
    out.push_back(next);
    for (std::size_t at = out.size() - 1; at > before && out[at - 1].gap < gap; --at) {
      std::swap(out[at], out[at - 1]);
    }
  }
  return least;
}

double PairSearch::radii(const NodePair& pair) const {
  double sum = 0;
  for (std::size_t s = 0; s < 2; ++s) {
    sum += frame_[s].growth() * scratch_[s]->pieces()[piece(pair, s)].offset.radius;
  }
  return sum;
}

PairSearch::Pieces PairSearch::nearest_pieces(const NodePair& pair) {
  ++stats.triangle_tests;
  Pieces pieces;
  for (std::size_t s = 0; s < 2; ++s) {
    pieces.ids[s] = piece(pair, s);
    const OffsetTriangle& offset = scratch_[s]->pieces()[pieces.ids[s]].offset;
    double error = 0;
    for (std::size_t k = 0; k < 3; ++k) {
      pieces.base[s][k] = frame_[s].apply(offset.base[k]);
      error = std::max(error, frame_[s].apply_error(offset.base[k]));
    }
    pieces.radii[s] = enlarged(offset.radius * frame_[s].growth() + spatial_error(error));
  }
  pieces.near = nearest(pieces.base[0], pieces.base[1]);
  const double gap = rounded_down(pieces.near.certain_distance - enlarged(pieces.radii[0] + pieces.radii[1]));
  pieces.gap = std::max(gap > 0 ? gap : 0.0, pair.gap > 0 ? pair.gap : 0.0);
  return pieces;
}

Point3 PairSearch::placed(std::size_t side, const Point3& p, double& error) const {
  error = enlarged(frame_[side].growth() * spatial_error(error)) + frame_[side].apply_error(p);
  return frame_[side].apply(p);
}

PairSearch::Witness PairSearch::witness(const Pieces& pieces) {
  ++stats.evaluations;
  Witness found;
  const std::array<Barycentric, 2> at{pieces.near.on_a, pieces.near.on_b};
  for (std::size_t s = 0; s < 2; ++s) {
    const Patch& patch = scratch_[s]->pieces()[pieces.ids[s]].patch;
    const LimitPoint limit = limit_point(patch, parameter(at[s]));
    const Point3 local = patch.origin + limit.relative;
    double error = limit.error + unit_roundoff * max_abs(local - Point3{});
    found.points[s] = placed(s, local, error);
    found.error = std::max(found.error, error);
  }
  const Vector3 between = found.points[1] - found.points[0];
  found.distance = enlarged(std::sqrt(length_sq(between) + 8 * underflow_error) +
                            2 * spatial_error(found.error) + 8 * unit_roundoff * max_abs(between));
  return found;
}

bool PairSearch::certainly_cross(const Pieces& pieces) {
  const std::optional<PairOfPoints> middle = middle_of_contact(pieces.base[0], pieces.base[1]);
  if (!middle) return false;
  const std::array<Barycentric, 2> at{middle->on_a, middle->on_b};
  for (std::size_t s = 0; s < 2; ++s) {
    const Crossed crossed(scratch_[s]->pieces()[pieces.ids[s]], scratch_[s]->pieces().heights(pieces.ids[s]));
    if (!crossed.possible()) continue;
    if (crosses_near(scratch_[1 - s]->pieces(), pieces.ids[1 - s], parameter(at[1 - s]), crossed,
                     view_[s].frame)) {
      return true;
    }
  }
  return false;
}

}  // namespace snug
