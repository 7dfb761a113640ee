#include <snug/search/pair_search.h>

#include <algorithm>
#include <bit>
#include <cmath>

#include <snug/base/contract.h>
#include <snug/base/error.h>
#include <snug/geometry/direction.h>
#include <snug/geometry/rounding.h>
#include <snug/patch/evaluate.h>
#include <snug/search/crossing.h>
#include <snug/surface/unscale.h>

namespace snug {
namespace {

PlacedFrame make_frame(const PlacedBvh& model, PowerOfTwo world) {
  const Motion& pose = model.pose;
  return {.rows = {pose.row(0), pose.row(1), pose.row(2)},
          .scale = (model.model.surface().scale().inverse() * world).apply(1.0),
          .translation = world.apply(pose.translation()),
          .defect = pose.defect()};
}

// The power of two that brings both placed surfaces to about 1.
PowerOfTwo joint_scale(const PlacedBvh& a, const PlacedBvh& b) {
  // Surfaces are at most 2 in their own scales.
  const int exponent = std::max(-a.model.surface().scale().exponent(), -b.model.surface().scale().exponent());
  const double t = std::max(max_abs(a.pose.translation()), max_abs(b.pose.translation()));
  const PowerOfTwo scale(-exponent);
  return scale.apply(t) < 2 ? scale : PowerOfTwo(-std::max(exponent, std::ilogb(t)));
}

// Nodes are opened together where the larger one is at most so many times as large.
constexpr float both_opened = 3;
// And where they do not overlap by more than this part of the smaller one: else one of them is enough to find out where.
constexpr float deep_overlap = 0.4F;

// A placed model as a polytope, in some units: `to_units` leads there from its own.
struct Outline {
  const Dop26& dop;
  std::array<Vector3, 3> rows;
  double to_units;
  Point3 centre;  // of the polytope, placed
  double size;    // of what was summed up for it

  Outline(const PlacedBvh& model, PowerOfTwo units)
      : dop(model.model.tree().dop()),
        rows{model.pose.row(0), model.pose.row(1), model.pose.row(2)},
        to_units((model.model.surface().scale().inverse() * units).apply(1.0)) {
    const Vector3 local = to_units * (model.model.tree().box().centre - Point3{});
    const Vector3 translation = units.apply(model.pose.translation());
    centre =
        Point3{} + (Vector3{dot(rows[0], local), dot(rows[1], local), dot(rows[2], local)} + translation);
    size = 2 * max_abs(local) + max_abs(translation) + to_units * dop.radius();
  }
  // Upper bound, but for roundings, of dot(direction, x - centre) over the surface.
  [[nodiscard]] double reach(const Vector3& direction) const {
    return to_units * dop.reach(direction.x * rows[0] + direction.y * rows[1] + direction.z * rows[2]);
  }
};

// Far enough from the ends of the range for squares and products of three.
bool tame(double x) { return x > 0x1p-300 && x < 0x1p300; }

// A lower bound of the distance along the line between the middles, in some units; not positive where none shows. NaN where
// numbers come near the ends of the range in these units.
double gap_between(const PlacedBvh& a, const PlacedBvh& b, PowerOfTwo units) {
  const Outline one(a, units), other(b, units);
  const Vector3 between = other.centre - one.centre;
  const double apart_sq = length_sq(between), apart = std::sqrt(apart_sq);
  if (!tame(apart)) return NAN;
  const double gap = (apart_sq - (one.reach(between) + other.reach(-between))) / apart;
  return gap - 32 * unit_roundoff * (apart + one.size + other.size);
}

}  // namespace

double outer_gap(const PlacedBvh& a, const PlacedBvh& b) {
  if (const double gap = gap_between(a, b, PowerOfTwo()); !std::isnan(gap)) return gap;
  const PowerOfTwo world = joint_scale(a, b);
  const double gap = gap_between(a, b, world);
  return gap > 0 ? unscaled_down(gap, world.inverse()) : -INFINITY;
}

void nearest_last(std::vector<NodePair>& pairs, std::size_t from) {
  if (from == pairs.size()) return;
  std::size_t nearest = from;
  for (std::size_t i = from + 1; i < pairs.size(); ++i) {
    if (pairs[i].gap < pairs[nearest].gap) nearest = i;
  }
  std::swap(pairs[nearest], pairs.back());
}

PairSearch::PairSearch(const PlacedBvh& a, const PlacedBvh& b)
    : scratch_{&a.scratch, &b.scratch},
      world_(joint_scale(a, b)),
      frame_{make_frame(a, world_), make_frame(b, world_)},
      scale_{static_cast<float>(frame_[0].scale), static_cast<float>(frame_[1].scale)},
      volume_(a.model.tree().blocks().volume()) {
  require_value(&a.scratch != &b.scratch && &a.scratch.model() == &a.model && &b.scratch.model() == &b.model,
                "pair of models: each needs a scratch of its own, made for it");
  require_value(volume_ == b.model.tree().blocks().volume(),
                "pair of models: their trees are of different volumes; make both with the same one");
  for (SurfaceWorkspace* scratch : scratch_) scratch->begin();
}

double PairSearch::length_down(double mesh_units) const {
  return world_.apply(mesh_units) * (1 - 2 * unit_roundoff) - underflow_error;
}

double PairSearch::length_up(double mesh_units) const {
  const double x = world_.apply(mesh_units);
  return world_.exact(mesh_units) ? x : x * (1 + 2 * unit_roundoff) + underflow_error;
}

Blocks::Near PairSearch::find_gaps(std::size_t side, std::uint32_t block, const Blocks& blocks, Node other,
                                   double most, Blocks::Distances& out) {
  const View& seen_view = view(side);
  const RelativeFrame& frame = seen_view.frame;
  if (!frame.comparable) {
    out.fill(-INFINITY);
    return {(1u << blocks.count(block)) - 1, INFINITY};
  }
  PlacedVolume seen;
  scratch_[1 - side]->blocks(other.piece).placed(other.lane(), seen_view, seen);
  const double enough = most * frame.from_world;
  return blocks.distances(block, seen, frame.slack, static_cast<float>(enough), out);
}

namespace {

// A gap in the search's units, rounded down: by one rounding of the factor, two of products, and what they lose where they
// underflow.
float in_world(float gap, float to_world) {
  return gap > 0 ? gap * to_world * (1 - 4 * 0x1p-24F) - 0x1p-125F : gap * to_world;
}

}  // namespace

NodePair PairSearch::roots() const {
  NodePair pair;
  pair.gap = -INFINITY;
  for (std::size_t s = 0; s < 2; ++s) {
    pair.nodes[s] = scratch_[s]->root();
    pair.sizes[s] = scale_[s] * scratch_[s]->blocks(false).size_of(pair.nodes[s].lane());
  }
  return pair;
}

PairSearch::Opening PairSearch::opening(const NodePair& pair, Bounding bounding) const {
  const bool a = scratch_[0]->can_open(pair.nodes[0]), b = scratch_[1]->can_open(pair.nodes[1]);
  if (a != b) return a ? Opening::a : Opening::b;
  if (!a) return Opening::none;
  const std::size_t larger = pair.sizes[1] > pair.sizes[0] ? 1 : 0;
  const float smaller_size = pair.sizes[1 - larger];
  const bool alike = pair.sizes[larger] <= both_opened * smaller_size;
  const bool deep = pair.gap > -INFINITY && -pair.gap > deep_overlap * smaller_size;
  const bool costly = bounding == Bounding::sparing && (scratch_[0]->opens_to_pieces(pair.nodes[0]) ||
                                                        scratch_[1]->opens_to_pieces(pair.nodes[1]));
  if (alike && !deep && !costly) return Opening::both;
  return larger == 0 ? Opening::a : Opening::b;
}

float PairSearch::open(const NodePair& pair, Opening opening, double most, std::vector<NodePair>& out) {
  switch (opening) {
    case Opening::a:
      return open_one(pair, 0, most, out);
    case Opening::b:
      return open_one(pair, 1, most, out);
    default:
      return view(0).frame.comparable ? open_both(pair, most, out) : open_one(pair, 0, most, out);
  }
}

float PairSearch::open_both(const NodePair& pair, double most, std::vector<NodePair>& out) {
  std::array<SurfaceWorkspace::Opened, 2> opened;
  std::array<const Blocks*, 2> blocks;
  for (std::size_t s = 0; s < 2; ++s) {
    stats.splits += pair.nodes[s].piece;
    opened[s] = scratch_[s]->open(pair.nodes[s]);
    blocks[s] = &scratch_[s]->blocks(opened[s].piece);
  }
  stats.box_tests += blocks[0]->count(opened[0].block) * blocks[1]->count(opened[1].block);
  const View& seen = view(0);
  const auto to_world = static_cast<float>(seen.frame.to_world);
  Blocks::Pairs near;
  const float others = blocks[0]->distances(opened[0].block, *blocks[1], opened[1].block, seen,
                                            static_cast<float>(most * seen.frame.from_world), near);
  const float parent = pair.gap > 0 ? pair.gap : -INFINITY;
  for (std::size_t k = 0; k < near.count; ++k) {
    const kernels::LanePair& found = near.pairs[k];
    const std::array<std::uint8_t, 2> lanes{found.own, found.other};
    NodePair& next = out.emplace_back();
    for (std::size_t s = 0; s < 2; ++s) {
      next.nodes[s] = {opened[s].block, lanes[s], opened[s].piece};
      next.sizes[s] = scale_[s] * blocks[s]->size_of({opened[s].block, lanes[s]});
    }
    next.gap = std::max(in_world(found.gap, to_world), parent);
  }
  return std::max(in_world(others, to_world), parent);
}

float PairSearch::open_one(const NodePair& pair, std::size_t side, double most, std::vector<NodePair>& out) {
  const Node node = pair.nodes[side], other = pair.nodes[1 - side];
  stats.splits += node.piece;
  const SurfaceWorkspace::Opened opened = scratch_[side]->open(node);
  const Blocks& blocks = scratch_[side]->blocks(opened.piece);
  stats.box_tests += blocks.count(opened.block);
  Blocks::Distances found;
  const Blocks::Near near = find_gaps(side, opened.block, blocks, other, most, found);
  const auto to_world = static_cast<float>(view(side).frame.to_world);
  const float parent = pair.gap > 0 ? pair.gap : -INFINITY;
  for (std::uint32_t rest = near.lanes; rest != 0; rest &= rest - 1) {
    const auto i = static_cast<std::uint32_t>(std::countr_zero(rest));
    NodePair& next = out.emplace_back();
    next.nodes[side] = {opened.block, static_cast<std::uint8_t>(i), opened.piece};
    next.nodes[1 - side] = other;
    next.sizes[side] = scale_[side] * blocks.size_of({opened.block, i});
    next.sizes[1 - side] = pair.sizes[1 - side];
    next.gap = std::max(in_world(found[i], to_world), parent);
  }
  return std::max(in_world(near.others, to_world), parent);
}

double PairSearch::radii(const NodePair& pair) const {
  double sum = 0;
  for (std::size_t s = 0; s < 2; ++s) {
    sum += frame_[s].growth() * static_cast<double>(scratch_[s]->radius(pair.nodes[s]));
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

double PairSearch::end(std::size_t side, PieceId piece, const Vector3& w) {
  const PlacedFrame& frame = frame_[side];
  const HullPoints& hull = scratch_[side]->pieces().hull(piece);
  // w . (scale R x + t) = scale (R' w) . x + w . t
  const Vector3 local = w.x * frame.rows[0] + w.y * frame.rows[1] + w.z * frame.rows[2];
  const Slab slab = outer_slab(hull, local);
  const double from = frame.scale * dot(local, hull.origin - Point3{}) + dot(w, frame.translation);
  const double reach =
      frame.scale * (max_abs(hull.origin - Point3{}) + hull.largest) + max_abs(frame.translation);
  // |w| <= 1 + 4 u; R' w is off by 4 roundings of its rows' sums, which multiply coordinates.
  const double error = 40 * unit_roundoff * reach + 8 * underflow_error;
  return side == 0 ? from + frame.scale * slab.upper + error : from + frame.scale * slab.lower - error;
}

double PairSearch::hull_gap(const NodePair& pair, const Vector3& direction) {
  const Vector3 w = normalized(direction);
  if (w == Vector3{}) return 0;
  const double gap = (end(1, piece(pair, 1), w) - end(0, piece(pair, 0), w)) * (1 - 16 * unit_roundoff);
  return gap > 0 ? gap : 0;
}

void PairSearch::look_along(const Vector3& direction) {
  const Vector3 w = normalized(direction);
  if (w == Vector3{}) return;
  along_ = w;
  for (SurfaceWorkspace* scratch : scratch_) scratch->ends().forget();
  const std::array<Vector3, 3>& rows = frame_[0].rows;
  static_cast<void>(view(0));
  view_[0].look_along(along_.x * rows[0] + along_.y * rows[1] + along_.z * rows[2]);
}

double PairSearch::gap_along(const NodePair& pair) {
  if (along_ == Vector3{}) return 0;
  std::array<double, 2> ends;
  for (std::size_t s = 0; s < 2; ++s) {
    const PieceId id = piece(pair, s);
    double& known = scratch_[s]->ends()[id.index()];
    if (std::isnan(known)) known = end(s, id, along_);
    ends[s] = known;
  }
  const double gap = (ends[1] - ends[0]) * (1 - 16 * unit_roundoff);
  return gap > 0 ? gap : 0;
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
    found.pieces[s] = pieces.ids[s];
    found.at[s] = clamped(at[s]);
    const LimitPoint limit = limit_point(patch, found.at[s]);
    const Point3 local = patch.origin + limit.relative;
    double error = limit.error + unit_roundoff * max_abs(local - Point3{});
    found.points[s] = placed(s, local, error);
    found.error = std::max(found.error, error);
  }
  const Vector3 between = found.points[1] - found.points[0];
  // Not enlarged(): of surfaces far apart that would be more than all else.
  found.distance = (std::sqrt(length_sq(between) + 8 * underflow_error) + 2 * spatial_error(found.error) +
                    8 * unit_roundoff * max_abs(between)) *
                   (1 + 16 * unit_roundoff);
  return found;
}

WitnessPlaces PairSearch::places(const Witness& witness) const {
  WitnessPlaces places;
  for (std::size_t s = 0; s < 2; ++s) {
    const Piece& piece = scratch_[s]->pieces()[witness.pieces[s]];
    places[s] =
        place_of(scratch_[s]->model().surface(), piece.root, to_face(piece.patch.path, witness.at[s]));
  }
  return places;
}

bool PairSearch::certainly_cross(const Pieces& pieces) {
  const std::optional<PairOfPoints> middle = middle_of_contact(pieces.base[0], pieces.base[1]);
  if (!middle) return false;
  const std::array<Barycentric, 2> at{middle->on_a, middle->on_b};
  for (std::size_t s = 0; s < 2; ++s) {
    const Crossed crossed(scratch_[s]->pieces()[pieces.ids[s]], scratch_[s]->pieces().heights(pieces.ids[s]));
    if (!crossed.possible()) continue;
    if (crosses_near(scratch_[1 - s]->pieces(), pieces.ids[1 - s], clamped(at[1 - s]), crossed,
                     view(s).frame)) {
      return true;
    }
  }
  return false;
}

}  // namespace snug
