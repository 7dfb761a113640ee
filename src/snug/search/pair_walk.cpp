#include <snug/search/pair_walk.h>

#include <algorithm>
#include <bit>
#include <cmath>

namespace snug {
namespace {

// Nodes are opened together where the larger one is at most so many times as large.
constexpr float both_opened = 3;
// And where they do not overlap by more than this part of the smaller one: else one of them is enough to find out where.
constexpr float deep_overlap = 0.4F;

// A gap in the query's units, rounded down: by one rounding of the factor, two of products, and what they lose where they
// underflow.
float in_world(float gap, float to_world) {
  return gap > 0 ? gap * to_world * (1 - 4 * 0x1p-24F) - 0x1p-125F : gap * to_world;
}

}  // namespace

void nearest_last(std::vector<NodePair>& pairs, std::size_t from) {
  if (from == pairs.size()) return;
  std::size_t nearest = from;
  for (std::size_t i = from + 1; i < pairs.size(); ++i) {
    if (pairs[i].gap < pairs[nearest].gap) nearest = i;
  }
  std::swap(pairs[nearest], pairs.back());
}

PairWalk::PairWalk(PairFrames& frames, SearchStats& stats)
    : frames_(frames),
      stats_(stats),
      scale_{static_cast<float>(frames.frame(0).scale), static_cast<float>(frames.frame(1).scale)} {}

NodePair PairWalk::roots() const {
  NodePair pair;
  pair.gap = -INFINITY;
  for (std::size_t s = 0; s < 2; ++s) {
    pair.nodes[s] = frames_.workspace(s).root();
    pair.sizes[s] = scale_[s] * frames_.workspace(s).nodes(false).size_of(pair.nodes[s].child());
  }
  return pair;
}

PairWalk::Opening PairWalk::opening(const NodePair& pair, Bounding bounding) const {
  const SurfaceWorkspace &on_a = frames_.workspace(0), &on_b = frames_.workspace(1);
  const bool a = on_a.can_open(pair.nodes[0]), b = on_b.can_open(pair.nodes[1]);
  if (a != b) return a ? Opening::a : Opening::b;
  if (!a) return Opening::none;
  const std::size_t larger = pair.sizes[1] > pair.sizes[0] ? 1 : 0;
  const float smaller_size = pair.sizes[1 - larger];
  const bool alike = pair.sizes[larger] <= both_opened * smaller_size;
  const bool deep = pair.gap > -INFINITY && -pair.gap > deep_overlap * smaller_size;
  const bool costly = bounding == Bounding::sparing &&
                      (on_a.opens_to_pieces(pair.nodes[0]) || on_b.opens_to_pieces(pair.nodes[1]));
  if (alike && !deep && !costly) return Opening::both;
  return larger == 0 ? Opening::a : Opening::b;
}

float PairWalk::open(const NodePair& pair, Opening opening, double prune_distance,
                     std::vector<NodePair>& out) {
  if (opening == Opening::both && frames_.view(0).frame.comparable)
    return open_both(pair, prune_distance, out);
  return open_one(pair, opening == Opening::b ? 1 : 0, prune_distance, out);
}

float PairWalk::open_both(const NodePair& pair, double prune_distance, std::vector<NodePair>& out) {
  std::array<SurfaceWorkspace::Opened, 2> opened;
  std::array<const WideNodes*, 2> nodes;
  for (std::size_t s = 0; s < 2; ++s) {
    stats_.splits += pair.nodes[s].piece;
    opened[s] = frames_.workspace(s).open(pair.nodes[s]);
    nodes[s] = &frames_.workspace(s).nodes(opened[s].pieces);
  }
  stats_.box_tests += nodes[0]->count(opened[0].parent) * nodes[1]->count(opened[1].parent);
  const View& view = frames_.view(0);
  const auto to_world = static_cast<float>(view.frame.to_world);
  WideNodes::Pairs near;
  const float others = nodes[0]->distances(opened[0].parent, *nodes[1], opened[1].parent, view,
                                           static_cast<float>(prune_distance * view.frame.from_world), near);
  const float parent_gap = pair.gap > 0 ? pair.gap : -INFINITY;
  for (std::size_t k = 0; k < near.count; ++k) {
    const kernels::ChildPair& found = near.pairs[k];
    const std::array<std::uint8_t, 2> places{found.own, found.other};
    NodePair& next = out.emplace_back();
    for (std::size_t s = 0; s < 2; ++s) {
      next.nodes[s] = {opened[s].parent, places[s], opened[s].pieces};
      next.sizes[s] = scale_[s] * nodes[s]->size_of(next.nodes[s].child());
    }
    next.gap = std::max(in_world(found.gap, to_world), parent_gap);
  }
  return std::max(in_world(others, to_world), parent_gap);
}

float PairWalk::open_one(const NodePair& pair, std::size_t side, double prune_distance,
                         std::vector<NodePair>& out) {
  const Node node = pair.nodes[side], other = pair.nodes[1 - side];
  stats_.splits += node.piece;
  const SurfaceWorkspace::Opened opened = frames_.workspace(side).open(node);
  const WideNodes& nodes = frames_.workspace(side).nodes(opened.pieces);
  stats_.box_tests += nodes.count(opened.parent);
  const View& view = frames_.view(side);
  WideNodes::Distances gaps;
  WideNodes::Near near{(1u << nodes.count(opened.parent)) - 1, INFINITY};
  if (view.frame.comparable) {
    const PlacedBox seen = frames_.workspace(1 - side).nodes(other.piece).placed(other.child(), view);
    near = nodes.distances(opened.parent, seen, view.frame.slack,
                           static_cast<float>(prune_distance * view.frame.from_world), gaps);
  } else {
    gaps.fill(-INFINITY);
  }
  const auto to_world = static_cast<float>(view.frame.to_world);
  const float parent_gap = pair.gap > 0 ? pair.gap : -INFINITY;
  for (std::uint32_t rest = near.places; rest != 0; rest &= rest - 1) {
    const auto place = static_cast<std::uint8_t>(std::countr_zero(rest));
    NodePair& next = out.emplace_back();
    next.nodes[side] = {opened.parent, place, opened.pieces};
    next.nodes[1 - side] = other;
    next.sizes[side] = scale_[side] * nodes.size_of(next.nodes[side].child());
    next.sizes[1 - side] = pair.sizes[1 - side];
    next.gap = std::max(in_world(gaps[place], to_world), parent_gap);
  }
  return std::max(in_world(near.others, to_world), parent_gap);
}

}  // namespace snug
