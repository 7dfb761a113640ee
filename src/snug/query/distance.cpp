#include <snug/query/distance.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include <snug/base/contract.h>
#include <snug/base/rounding.h>
#include <snug/surface/unscale.h>

namespace snug {
namespace {

constexpr std::size_t most_touched = 50'000;
constexpr int most_attempts = 64;

bool farther(const NodePair& x, const NodePair& y) { return x.gap > y.gap; }

class Query {
 public:
  Query(const PlacedModel& a, const PlacedModel& b, const DistanceOptions& options,
        const WorkMonitor& monitor)
      : search_(a, b), options_(options), monitor_(monitor) {
    absolute_ = search_.length_down(options.absolute);
  }

  Distance run() {
    thread_local std::vector<NodePair> heap;
    const NodePair roots = search_.roots();
    dive(roots, heap);
    heap.assign(1, roots);
    while (!heap.empty() && best_ > 0) {
      std::pop_heap(heap.begin(), heap.end(), farther);
      const NodePair pair = heap.back();
      heap.pop_back();
      // All others are as far or farther.
      const double gap = std::max(static_cast<double>(pair.gap), 0.0);
      if (gap >= enough() || !visit(pair, heap)) {
        resolved_ = std::min(resolved_, gap);
        break;
      }
    }
    return result();
  }

 private:
  // A lower bound that is near enough to the upper one.
  [[nodiscard]] double enough() const {
    return best_ == INFINITY ? INFINITY : best_ - std::max(absolute_, options_.relative * best_);
  }

  // Straight down to two pieces that are near each other, so that there is an upper bound from the beginning.
  void dive(NodePair pair, std::vector<NodePair>& scratch) {
    while (!search_.pieces(pair)) {
      scratch.clear();
      static_cast<void>(search_.open(pair, *search_.side_to_open(pair), INFINITY, scratch));
      pair = scratch.back();
    }
    improve(pair, search_.nearest_pieces(pair));
  }

  // False when the budget ends.
  bool visit(const NodePair& pair, std::vector<NodePair>& heap) {
    const std::optional<std::size_t> side = search_.side_to_open(pair);
    double gap = std::max(static_cast<double>(pair.gap), 0.0);
    if (search_.pieces(pair)) {
      monitor_.checkpoint();
      // The direction of the nearest points so far will do for most pairs.
      if (witness_.distance < INFINITY) {
        gap = std::max(gap, search_.hull_gap(pair, witness_.points[1] - witness_.points[0]));
      }
      if (gap < enough()) {
        const PairSearch::Pieces pieces = search_.nearest_pieces(pair);
        improve(pair, pieces);
        gap = std::max({gap, pieces.gap, search_.hull_gap(pair, pieces.direction())});
      }
    }
    if (!side || gap >= enough()) {
      resolved_ = std::min(resolved_, gap);
      return true;
    }
    if (search_.stats.splits >= options_.budget || search_.scratch(*side).touched() >= most_touched)
      return false;
    std::size_t at = heap.size();
    NodePair parent = pair;
    parent.gap = std::max(parent.gap, static_cast<float>(gap * (1 - 0x1p-23)));
    resolved_ = std::min(resolved_, static_cast<double>(search_.open(parent, *side, enough(), heap)));
    while (at < heap.size())
      std::push_heap(heap.begin(), heap.begin() + static_cast<std::ptrdiff_t>(++at), farther);
    return true;
  }

  // The upper bound, by limit points or by a proof of contact.
  void improve(const NodePair& pair, const PairSearch::Pieces& pieces) {
    const double radii = pieces.radii[0] + pieces.radii[1];
    if (pieces.near.certain_distance < best_) {
      const PairSearch::Witness witness = search_.witness(pieces);
      if (witness.distance < witness_.distance) witness_ = witness;
      best_ = std::min(best_, witness.distance);
    }
    const bool flat = radii <= static_cast<double>(std::min(pair.sizes[0], pair.sizes[1])) / 16;
    if (pieces.near.certain_distance == 0 && flat && attempts_ < most_attempts) {
      ++attempts_;
      if (search_.certainly_cross(pieces)) best_ = 0;
    }
  }

  Distance result() {
    Distance answer;
    answer.stats = search_.stats;
    const PowerOfTwo back = search_.to_mesh_units();
    const double lower = std::min(resolved_, best_);
    answer.lower = unscaled_down(lower, back);
    answer.upper = require_representable(unscaled_up(best_, back));
    answer.reached =
        answer.upper - answer.lower <= std::max(options_.absolute, options_.relative * answer.upper);
    for (std::size_t s = 0; s < 2; ++s) {
      answer.witness[s] = require_representable(back.apply(witness_.points[s]));
    }
    answer.witness_error = unscaled_up(witness_.error, back) + underflow_error;
    return answer;
  }

  PairSearch search_;
  const DistanceOptions& options_;
  const WorkMonitor& monitor_;
  double absolute_ = 0;
  double best_ = INFINITY;      // upper bound
  double resolved_ = INFINITY;  // lower bound of the pairs that are done with
  PairSearch::Witness witness_;
  int attempts_ = 0;
};

}  // namespace

Distance distance(const PlacedModel& a, const PlacedModel& b, const DistanceOptions& options,
                  const WorkMonitor& monitor) {
  SNUG_EXPECT(options.absolute >= 0 && std::isfinite(options.absolute));
  SNUG_EXPECT(options.relative >= 0 && std::isfinite(options.relative));
  SNUG_EXPECT(rigidity_defect(a.placement) <= rigidity_tolerance &&
              rigidity_defect(b.placement) <= rigidity_tolerance);
  return Query(a, b, options, monitor).run();
}

}  // namespace snug
