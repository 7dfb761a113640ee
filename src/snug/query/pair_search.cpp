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
  const int exponent = std::max(-a.model.surface().scale().exponent(), -b.model.surface().scale().exponent());
  const double t = std::max(max_abs(a.placement.translation()), max_abs(b.placement.translation()));
  const PowerOfTwo scale(-exponent);
  return scale.apply(t) < 2 ? scale : PowerOfTwo(-std::max(exponent, std::ilogb(t)));
}

// Barycentric weights as a parameter that limit_point accepts.
TriangleParameter parameter(Barycentric p) {
  const double b = std::clamp(p.b, 0.0, 1.0);
  double c = std::clamp(p.c, 0.0, 1.0 - b);
  if (b + c > 1) c = 0;
  return {b, c};
}

}  // namespace

namespace {

// Distance of a placed point to the box of a placed model, but for roundings.
double distance_to_box(const PlacedModel& model, const Point3& p) {
  const Vector3 d = p - model.placement.apply(model.model.box().centre);
  const Vector3 local =
      d.x * model.placement.row(0) + d.y * model.placement.row(1) + d.z * model.placement.row(2);
  double sum = 0;
  for (std::size_t k = 0; k < 3; ++k) {
    const double beyond = std::fabs(dot(model.model.box().axes[k], local)) - model.model.box().half[k];
    if (beyond > 0) sum += beyond * beyond;
  }
  return std::sqrt(sum);
}

}  // namespace

double outer_gap(const PlacedModel& a, const PlacedModel& b) {
  const Ball& ball_a = a.model.ball();
  const Ball& ball_b = b.model.ball();
  const Point3 centre_a = a.placement.apply(ball_a.centre), centre_b = b.placement.apply(ball_b.centre);
  const double between = length(centre_b - centre_a);
  if (!(between > 0x1p-400 && between < 0x1p400))
    return -INFINITY;  // squares are far from both ends of the range
  // Rotations within rigidity_tolerance: their inverses, which are their transposes but for that, and radii; products and
  // sums of three, far below that.
  const double reach = between + max_abs(ball_a.centre - Point3{}) + max_abs(ball_b.centre - Point3{}) +
                       max_abs(a.placement.translation()) * 0x1p-20 +
                       max_abs(b.placement.translation()) * 0x1p-20 + ball_a.radius + ball_b.radius;
  const double doubt = 16 * rigidity_tolerance * reach;
  const double balls = between - ball_a.radius - ball_b.radius - doubt;
  if (balls > 0) return balls;
  const double a_box = distance_to_box(a, centre_b) - ball_b.radius,
               b_box = distance_to_box(b, centre_a) - ball_a.radius;
  const double boxes = std::max(a_box, b_box) - doubt;
  return boxes > 0 ? boxes : -INFINITY;
}

PairSearch::PairSearch(const PlacedModel& a, const PlacedModel& b)
    : scratch_{&a.scratch, &b.scratch}, volume_(a.model.tree().blocks().volume()) {
  SNUG_EXPECT(&a.scratch != &b.scratch && &a.scratch.model() == &a.model && &b.scratch.model() == &b.model);
  SNUG_EXPECT(volume_ == b.model.tree().blocks().volume());
  world_ = joint_scale(a, b);
  const std::array<const PlacedModel*, 2> side{&a, &b};
  for (std::size_t s = 0; s < 2; ++s) {
    frame_[s] =
        make_frame(side[s]->model.surface(), side[s]->placement, world_, rigidity_defect(side[s]->placement));
    scale_[s] = static_cast<float>(frame_[s].scale);
    scratch_[s]->begin();
  }
}

double PairSearch::length_down(double mesh_units) const {
  return world_.apply(mesh_units) * (1 - 2 * unit_roundoff) - underflow_error;
}

double PairSearch::length_up(double mesh_units) const {
  const double x = world_.apply(mesh_units);
  return world_.exact(mesh_units) ? x : x * (1 + 2 * unit_roundoff) + underflow_error;
}

void PairSearch::find_gaps(std::size_t side, std::uint32_t block, const Blocks& blocks, Node other,
                           double most, Blocks::Distances& out) {
  const View& seen_view = view(side);
  const RelativeFrame& frame = seen_view.frame;
  if (!frame.comparable) {
    out.fill(-INFINITY);
    return;
  }
  PlacedVolume seen;
  scratch_[1 - side]->blocks(other.piece).placed(other.lane(), seen_view, seen);
  // In the frame's units, and a little more for the rounding of in_world().
  const double enough = most / frame.to_world * (1 + 0x1p-20);
  blocks.distances(block, seen, frame.slack, static_cast<float>(enough), out);
}

namespace {

// A gap in the search's units, rounded down: by one rounding of the factor, one of the product.
float in_world(float gap, float to_world) {
  return gap > 0 ? gap * to_world * (1 - 4 * 0x1p-24F) : gap * to_world;
}

}  // namespace

NodePair PairSearch::roots() {
  NodePair pair;
  for (std::size_t s = 0; s < 2; ++s) {
    pair.nodes[s] = scratch_[s]->root();
    pair.sizes[s] = scale_[s] * scratch_[s]->blocks(false).size_of(pair.nodes[s].lane());
  }
  const std::size_t side = view(0).frame.comparable ? 0 : 1;
  Blocks::Distances found;
  find_gaps(side, pair.nodes[side].block, scratch_[side]->blocks(false), pair.nodes[1 - side], INFINITY,
            found);
  pair.gap = in_world(found[0], static_cast<float>(view(side).frame.to_world));
  return pair;
}

std::optional<std::size_t> PairSearch::side_to_open(const NodePair& pair) const {
  const std::size_t larger = pair.sizes[1] > pair.sizes[0] ? 1 : 0;
  if (scratch_[larger]->can_open(pair.nodes[larger])) return larger;
  if (scratch_[1 - larger]->can_open(pair.nodes[1 - larger])) return 1 - larger;
  return std::nullopt;
}

float PairSearch::open(const NodePair& pair, std::size_t side, double most, std::vector<NodePair>& out) {
  const Node node = pair.nodes[side], other = pair.nodes[1 - side];
  stats.splits += node.piece;
  const QueryScratch::Opened opened = scratch_[side]->open(node);
  const Blocks& blocks = scratch_[side]->blocks(opened.piece);
  const std::size_t count = blocks.count(opened.block);
  stats.box_tests += count;
  Blocks::Distances found;
  find_gaps(side, opened.block, blocks, other, most, found);
  const auto to_world = static_cast<float>(view(side).frame.to_world);
  float least = INFINITY;
  const std::size_t before = out.size();
  for (std::size_t i = 0; i < count; ++i) {
    float gap = in_world(found[i], to_world);
    if (pair.gap > 0) gap = std::max(gap, pair.gap);
    if (static_cast<double>(gap) > most) {
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
    std::size_t at = out.size();
    out.push_back(next);
    for (; at > before && out[at - 1].gap < gap; --at) out[at] = out[at - 1];
    out[at] = next;
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

Vector3 PairSearch::Pieces::direction() const {
  const auto at = [](const Triangle& t, Barycentric p) {
    return t[0] + (p.b * (t[1] - t[0]) + p.c * (t[2] - t[0]));
  };
  return at(base[1], near.on_b) - at(base[0], near.on_a);
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
  pieces.gap = std::max({gap, static_cast<double>(pair.gap), 0.0});
  return pieces;
}

double PairSearch::hull_gap(const NodePair& pair, const Vector3& direction) {
  const double size = length(direction);
  if (!(size > 0) || !std::isfinite(1 / size)) return 0;
  const Vector3 w = (1 / size) * direction;
  double end[2] = {0, 0}, reach = 0;
  for (std::size_t s = 0; s < 2; ++s) {
    const PlacedFrame& frame = frame_[s];
    const HullPoints& hull = scratch_[s]->pieces().hull(piece(pair, s));
    // w . (scale R x + t) = scale (R' w) . x + w . t
    const Vector3 local = w.x * frame.rows[0] + w.y * frame.rows[1] + w.z * frame.rows[2];
    const Slab slab = outer_slab(hull, local);
    const double from = frame.scale * dot(local, hull.origin - Point3{}) + dot(w, frame.translation);
    end[s] = from + frame.scale * (s == 0 ? slab.upper : slab.lower);
    reach = std::max(
        reach, frame.scale * (max_abs(hull.origin - Point3{}) + hull.largest) + max_abs(frame.translation));
  }
  // |w| <= 1 + 4 u; R' w is off by 4 roundings of its rows' sums, which multiply coordinates.
  const double gap =
      (end[1] - end[0]) * (1 - 16 * unit_roundoff) - 64 * unit_roundoff * reach - 16 * underflow_error;
  return gap > 0 ? gap : 0;
}

double PairSearch::corner_gap(const NodePair& pair, const Vector3& direction) const {
  const Vector3 w = (1 / length(direction)) * direction;
  double end[2] = {-INFINITY, INFINITY};
  for (std::size_t s = 0; s < 2; ++s) {
    const PlacedFrame& frame = frame_[s];
    const Piece& piece_here = scratch_[s]->pieces()[piece(pair, s)];
    const Vector3 local = w.x * frame.rows[0] + w.y * frame.rows[1] + w.z * frame.rows[2];
    const double from =
        frame.scale * dot(local, piece_here.patch.origin - Point3{}) + dot(w, frame.translation);
    for (const Vector3& corner : piece_here.corners) {
      const double height = from + frame.scale * dot(local, corner);
      end[s] = s == 0 ? std::max(end[s], height) : std::min(end[s], height);
    }
  }
  return end[1] - end[0];
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
                     view(s).frame)) {
      return true;
    }
  }
  return false;
}

}  // namespace snug
