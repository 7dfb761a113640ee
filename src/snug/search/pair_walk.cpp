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

NodePair PairWalk::roots() const {
  return {{frames_.workspace(0).root(), frames_.workspace(1).root()}, -INFINITY};
}

PairWalk::Opening PairWalk::opening(const NodePair& pair) const {
  const auto& [a, b] = pair.nodes;
  const bool can_a = SurfaceWorkspace::can_open(a), can_b = SurfaceWorkspace::can_open(b);
  if (can_a && can_b) return size(pair, 1) > size(pair, 0) ? Opening::b : Opening::a;
  return can_a ? Opening::a : can_b ? Opening::b : Opening::none;
}

float PairWalk::open(const NodePair& pair, Opening opening, double prune_distance,
                     std::vector<NodePair>& out) {
  const std::size_t side = opening == Opening::b ? 1 : 0;
  const Node &node = pair.nodes[side], other = pair.nodes[1 - side];
  stats_.splits += node.bounded();
  const SurfaceWorkspace::Opened opened = frames_.workspace(side).open(node);
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
    out.push_back(
        {side == 0 ? std::array{opened.child(place), other} : std::array{other, opened.child(place)},
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
