#include <snug/search/pair_walk.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <utility>

namespace snug {

PairWalk::PairWalk(PairFrames& frames, SearchStats& stats, WideNode::Gaps gaps)
    : frames_(frames),
      stats_(stats),
      gaps_(gaps),
      scale_{static_cast<float>(frames.frame(0).scale), static_cast<float>(frames.frame(1).scale)} {}

NodePair PairWalk::roots() const { return {{frames_.cache(0).root(), frames_.cache(1).root()}, -INFINITY}; }

std::size_t PairWalk::side_to_open(const NodePair& pair) const {
  const auto& [a, b] = pair.nodes;
  const bool can_a = PieceCache::can_open(a), can_b = PieceCache::can_open(b);
  if (can_a && can_b) return size(pair, 1) > size(pair, 0) ? 1 : 0;
  return can_a ? 0 : can_b ? 1 : neither;
}

PairWalk::May PairWalk::may(const NodePair& pair, std::uint64_t budget) const {
  const std::size_t side = side_to_open(pair);
  if (side == neither) return May::not_open;
  const bool splits = pair.nodes[side].bounded();
  const bool spent = stats_.splits >= budget || frames_.cache(0).full() || frames_.cache(1).full();
  return splits && spent ? May::end : May::open;
}

float PairWalk::open(const NodePair& pair, double prune_distance, Frontier<NodePair>& out) {
  const std::size_t side = side_to_open(pair);
  const Node &node = pair.nodes[side], other = pair.nodes[1 - side];
  stats_.splits += node.bounded();
  const PieceCache::Opened opened = frames_.cache(side).open(node);
  stats_.box_tests += opened.count();
  const View& view = frames_.view(side);
  const float parent_gap = pair.gap > 0 ? pair.gap : -INFINITY;
  // In the query's units. Rounded down: by one rounding of the factor, two of products, and what they lose
  // where they underflow.
  const auto gap_of = [&](float gap) {
    return std::max(gap > 0 ? gap * view.to_world * (1 - 4 * 0x1p-24F) - 0x1p-125F : gap * view.to_world,
                    parent_gap);
  };
  WideNode::Distances gaps;
  WideNode::Near near{(1u << opened.count()) - 1, INFINITY};
  if (view.frame.comparable) {
    near = opened.boxes->distances(*other.boxes, other.place, view,
                                   static_cast<float>(prune_distance * view.frame.from_world), gaps_, gaps);
  } else {
    gaps.fill(-INFINITY);
  }
  const auto add = [&](std::size_t place) {
    out.add({side == 0 ? std::array{opened.child(place), other} : std::array{other, opened.child(place)},
             gap_of(gaps[place])});
  };
  if (near.places != 0) {
    auto nearest = static_cast<std::size_t>(std::countr_zero(near.places));
    for (std::uint32_t rest = near.places & (near.places - 1); rest != 0; rest &= rest - 1) {
      auto place = static_cast<std::size_t>(std::countr_zero(rest));
      if (gaps[place] < gaps[nearest]) std::swap(place, nearest);
      add(place);
    }
    add(nearest);
  }
  return gap_of(near.others);
}

}  // namespace snug
