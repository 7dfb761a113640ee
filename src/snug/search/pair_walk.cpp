#include <snug/search/pair_walk.h>

#include <algorithm>
#include <bit>
#include <cmath>

namespace snug {
namespace {

// Nodes are opened together where the larger one is at most so many times as large.
constexpr float both_opened = 3;
// And where they overlap by at most this part of the smaller one: else opening one of them is enough.
constexpr float deep_overlap = 0.4F;

// Gaps of what a pair opens to, in the query's units and not below the pair's own. Rounded down: by one
// rounding of the factor, two of products, and what they lose where they underflow.
struct GapInWorld {
  float to_world, parent_gap;

  GapInWorld(const View& view, const NodePair& pair)
      : to_world(static_cast<float>(view.frame.to_world)), parent_gap(pair.gap > 0 ? pair.gap : -INFINITY) {}
  float operator()(float gap) const {
    return std::max(gap > 0 ? gap * to_world * (1 - 4 * 0x1p-24F) - 0x1p-125F : gap * to_world, parent_gap);
  }
};

}  // namespace

void nearest_last(std::vector<NodePair>& pairs, std::size_t from) {
  if (from == pairs.size()) return;
  const auto nearer = [](const NodePair& x, const NodePair& y) { return x.gap < y.gap; };
  std::iter_swap(std::min_element(pairs.begin() + static_cast<std::ptrdiff_t>(from), pairs.end(), nearer),
                 pairs.end() - 1);
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

SurfaceWorkspace::Opened PairWalk::open_node(const NodePair& pair, std::size_t side) {
  stats_.splits += pair.nodes[side].piece;
  return frames_.workspace(side).open(pair.nodes[side]);
}

float PairWalk::open_both(const NodePair& pair, double prune_distance, std::vector<NodePair>& out) {
  const SurfaceWorkspace::Opened a = open_node(pair, 0), b = open_node(pair, 1);
  stats_.box_tests += a.count() * b.count();
  const View& view = frames_.view(0);
  const GapInWorld gap_of(view, pair);
  WideNodes::Pairs near;
  const float others = a.nodes.distances(a.parent, b.nodes, b.parent, view,
                                         static_cast<float>(prune_distance * view.frame.from_world), near);
  for (std::size_t k = 0; k < near.count; ++k) {
    const kernels::ChildPair& found = near.pairs[k];
    const Node of_a = a.child(found.own), of_b = b.child(found.other);
    out.push_back(
        {.nodes = {of_a, of_b},
         .sizes = {scale_[0] * a.nodes.size_of(of_a.child()), scale_[1] * b.nodes.size_of(of_b.child())},
         .gap = gap_of(found.gap)});
  }
  return gap_of(others);
}

float PairWalk::open_one(const NodePair& pair, std::size_t side, double prune_distance,
                         std::vector<NodePair>& out) {
  const SurfaceWorkspace::Opened opened = open_node(pair, side);
  stats_.box_tests += opened.count();
  const View& view = frames_.view(side);
  const GapInWorld gap_of(view, pair);
  WideNodes::Distances gaps;
  WideNodes::Near near{(1u << opened.count()) - 1, INFINITY};
  if (view.frame.comparable) {
    const Node other = pair.nodes[1 - side];
    const PlacedBox seen = frames_.workspace(1 - side).nodes(other.piece).placed(other.child(), view);
    near = opened.nodes.distances(opened.parent, seen, view.frame.slack,
                                  static_cast<float>(prune_distance * view.frame.from_world), gaps);
  } else {
    gaps.fill(-INFINITY);
  }
  for (std::uint32_t rest = near.places; rest != 0; rest &= rest - 1) {
    const auto place = static_cast<std::size_t>(std::countr_zero(rest));
    NodePair& next = out.emplace_back(pair);
    next.nodes[side] = opened.child(place);
    next.sizes[side] = scale_[side] * opened.nodes.size_of(next.nodes[side].child());
    next.gap = gap_of(gaps[place]);
  }
  return gap_of(near.others);
}

}  // namespace snug
