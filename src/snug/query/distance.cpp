#include <algorithm>
#include <cmath>
#include <vector>

#include <snug/geometry/rounding.h>
#include <snug/query/containment.h>
#include <snug/query/pairs.h>
#include <snug/search/crossing.h>
#include <snug/search/pair_frames.h>
#include <snug/search/precision.h>
#include <snug/surface/unscale.h>

namespace snug {
namespace {

constexpr int max_attempts = 64;
// Pairs that are followed down at the same time for a first upper bound.
constexpr std::size_t beam = 4;
// Bounds of gaps err by some hundred roundings of what is about 4 large.
constexpr double noise = 0x1p-43;

bool nearer(const NodePair& x, const NodePair& y) { return x.gap < y.gap; }

class Query {
 public:
  Query(const PlacedBvh& a, const PlacedBvh& b, const DistanceOptions& options, const WorkMonitor& monitor)
      : frames_(a, b),
        options_(options),
        monitor_(monitor),
        bounds_(frames_.length_down(*options.absolute), *options.relative, noise) {
    bounds_.raise_lower(frames_.length_down(outer_gap(a, b)));
  }

  // Best first.
  Distance run() {
    dive();
    open_.start(walk_.roots());
    while (!open_.empty() && !bounds_.done()) {
      const NodePair pair = open_.take();
      // All others are as far or farther.
      const double gap = std::max(static_cast<double>(pair.gap), 0.0);
      if (gap >= bounds_.prune_distance() || !visit(pair)) {
        bounds_.prune(gap);
        break;
      }
    }
    if (!open_.empty()) bounds_.prune(std::max(static_cast<double>(open_.nearest().gap), 0.0));
    return result();
  }

 private:
  // Straight down to pieces that are near each other, so that there is an upper bound from the beginning.
  void dive() {
    std::vector<NodePair> front{walk_.roots()}, next;
    const auto whole = [](const NodePair& pair) { return pair.bounded(); };
    while (!std::all_of(front.begin(), front.end(), whole)) {
      next.clear();
      for (const NodePair& pair : front) {
        if (whole(pair)) {
          next.push_back(pair);
        } else {
          static_cast<void>(walk_.open(pair, walk_.opening(pair), INFINITY, next));
        }
      }
      const auto end = next.begin() + static_cast<std::ptrdiff_t>(std::min(beam, next.size()));
      std::partial_sort(next.begin(), end, next.end(), nearer);
      front.assign(next.begin(), end);
    }
    double least = INFINITY;
    NodePair best = front[0];
    for (const NodePair& pair : front) {
      const double distance = pieces_.nearest(pair).near_distance;
      if (distance < least) {
        least = distance;
        best = pair;
      }
    }
    follow(best);
  }

  // From two pieces on to smaller ones, until quadratics there are as near as the surfaces come.
  void follow(NodePair pair) {
    while (pieces_.errors(pair) > bounds_.precision() / 8) {
      const PairWalk::Opening opening = walk_.opening(pair);
      if (opening == PairWalk::Opening::none || !walk_.may_open(pair, opening, options_.budget)) break;
      children_.clear();
      static_cast<void>(walk_.open(pair, opening, INFINITY, children_));
      pair = *std::min_element(children_.begin(), children_.end(), nearer);
    }
    improve(pair, pieces_.nearest(pair));
  }

  // False when the budget ends.
  bool visit(NodePair pair) {
    double gap = std::max(static_cast<double>(pair.gap), 0.0);
    if (pair.bounded()) {
      monitor_.checkpoint();
      gap = std::max(gap, gap_of_pieces(pair));
      pair.gap = single_down(gap);
    }
    const PairWalk::Opening opening = walk_.opening(pair);
    if (opening == PairWalk::Opening::none || gap >= bounds_.prune_distance()) {
      bounds_.prune(gap);
      return true;
    }
    if (!walk_.may_open(pair, opening, options_.budget)) return false;
    children_.clear();
    bounds_.prune(static_cast<double>(walk_.open(pair, opening, bounds_.prune_distance(), children_)));
    for (NodePair& child : children_) {
      if (child.bounded()) {
        const double along = pieces_.gap_along(child.nodes, direction_);
        if (along >= bounds_.prune_distance()) {
          bounds_.prune(along);
          continue;
        }
        child.gap = std::max(child.gap, single_down(along));
      }
      open_.add(child);
    }
    return true;
  }

  // A lower bound of the distance of two pieces; improves the upper one.
  double gap_of_pieces(const NodePair& pair) {
    const double along = pieces_.gap_along(pair.nodes, direction_);
    if (along >= bounds_.prune_distance()) return along;
    const PiecePair pieces = pieces_.nearest(pair);
    improve(pair, pieces);
    if (length(pieces.between) < bounds_.prune_distance()) follow(pair);
    return std::max({along, pieces.gap, pieces_.gap_along(pair.nodes, pieces.between)});
  }

  // The upper bound, by points of quadratics or by a proof of contact.
  void improve(const NodePair& pair, const PiecePair& pieces) {
    if (pieces.near_distance < near_.near_distance) {
      near_ = pieces;
      bounds_.reduce_upper(pieces.near_distance);
      direction_ = pieces.between;
    }
    const double radii = pieces.radii[0] + pieces.radii[1];
    const bool flat =
        radii <= static_cast<double>(std::min(walk_.size(pair, 0), walk_.size(pair, 1))) / 16;
    if (pieces.near.certain_distance == 0 && flat && attempts_ < max_attempts) {
      ++attempts_;
      if (certainly_cross(frames_, pieces)) bounds_.reduce_upper(0);
    }
  }

  Distance result() {
    Distance answer;
    const Witness witness = pieces_.witness(near_);
    bounds_.reduce_upper(witness.distance);
    answer.stats = stats_;
    const PowerOfTwo back = frames_.to_mesh_units();
    answer.distance = {unscaled_down(bounds_.lower(), back),
                       require_representable(unscaled_up(bounds_.upper(), back))};
    answer.reached = near_enough(answer.distance, options_);
    pieces_.tell(witness, answer);
    return answer;
  }

  PairFrames frames_;
  SearchStats stats_;
  PairWalk walk_{frames_, stats_};
  PiecePairs pieces_{frames_, stats_};
  const DistanceOptions& options_;
  const WorkMonitor& monitor_;
  DistanceBounds bounds_;
  NearestFirst<NodePair> open_;
  std::vector<NodePair> children_;
  PiecePair near_{.near_distance = INFINITY};  // the two that came nearest
  Vector3 direction_;                          // between them
  int attempts_ = 0;
};

}  // namespace

Distance distance(const PlacedBvh& a, const PlacedBvh& b, const DistanceOptions& options,
                  const WorkMonitor& monitor) {
  const DistanceOptions wanted = with_precision(options, a.model.surface().size(), b.model.surface().size());
  if (options.solid) require_solids(a, b);
  Distance answer = Query(a, b, wanted, monitor).run();
  if (!options.solid || answer.distance.upper == 0) return answer;
  const Nesting found = answer.distance.lower > 0 ? nesting(a, b, monitor) : common_point(a, b, monitor);
  if (found.inner) {
    found.tell(answer);
    answer.reached = true;
  } else if (!found.certain) {
    answer.distance.lower = 0;
    answer.reached = near_enough(answer.distance, wanted);
  }
  return answer;
}

}  // namespace snug
