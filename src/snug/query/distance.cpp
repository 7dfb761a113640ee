#include <algorithm>
#include <cmath>
#include <vector>

#include <snug/geometry/direction.h>
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
    const auto whole = [&](const NodePair& pair) { return pair.of_pieces(); };
    while (!std::all_of(front.begin(), front.end(), whole)) {
      next.clear();
      for (const NodePair& pair : front) {
        if (whole(pair)) {
          next.push_back(pair);
        } else {
          static_cast<void>(walk_.open(pair, walk_.opening(pair, PairWalk::Bounding::eager), INFINITY, next));
        }
      }
      const auto end = next.begin() + static_cast<std::ptrdiff_t>(std::min(beam, next.size()));
      std::partial_sort(next.begin(), end, next.end(), nearer);
      front.assign(next.begin(), end);
    }
    double least = INFINITY;
    NodePair best = front[0];
    for (const NodePair& pair : front) {
      const double distance = pieces_.nearest(pair).near.certain_distance;
      if (distance < least) {
        least = distance;
        best = pair;
      }
    }
    follow(best);
  }

  // From two pieces on to smaller ones, until limit points there are as near as the surfaces come there.
  void follow(NodePair pair) {
    while (pieces_.radii(pair) > bounds_.precision() / 8) {
      const PairWalk::Opening opening = walk_.opening(pair, PairWalk::Bounding::eager);
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
    if (pair.of_pieces()) {
      monitor_.checkpoint();
      gap = std::max(gap, gap_of_pieces(pair));
      pair.gap = single_down(gap);
    }
    const PairWalk::Opening opening = walk_.opening(pair, PairWalk::Bounding::eager);
    if (opening == PairWalk::Opening::none || gap >= bounds_.prune_distance()) {
      bounds_.prune(gap);
      return true;
    }
    if (!walk_.may_open(pair, opening, options_.budget)) return false;
    children_.clear();
    bounds_.prune(static_cast<double>(walk_.open(pair, opening, bounds_.prune_distance(), children_)));
    for (std::size_t at = 0; at < children_.size();) {
      NodePair& child = children_[at];
      if (child.of_pieces()) {
        const double along = pieces_.gap_along(child);
        if (along >= bounds_.prune_distance()) {
          bounds_.prune(along);
          child = children_.back();
          children_.pop_back();
          continue;
        }
        child.gap = std::max(child.gap, single_down(along));
      }
      open_.add(child);
      ++at;
    }
    return true;
  }

  // A lower bound of the distance of two pieces; improves the upper one.
  double gap_of_pieces(const NodePair& pair) {
    const double along = pieces_.gap_along(pair);
    if (along >= bounds_.prune_distance()) return along;
    const PiecePair pieces = pieces_.nearest(pair);
    improve(pair, pieces);
    // Base triangles lie in the middle of what pieces may be.
    const double likely = pieces.near.certain_distance + (pieces.radii[0] + pieces.radii[1]) / 2;
    if (likely < bounds_.prune_distance()) follow(pair);
    return std::max({along, pieces.gap, pieces_.hull_gap(pair, pieces.direction())});
  }

  // The upper bound, by limit points or by a proof of contact.
  void improve(const NodePair& pair, const PiecePair& pieces) {
    if (pieces.near.certain_distance < bounds_.upper()) {
      const Witness witness = pieces_.witness(pieces);
      if (witness.distance < witness_.distance) {
        witness_ = witness;
        look_along_witness();
      }
      bounds_.reduce_upper(witness.distance);
    }
    const double radii = pieces.radii[0] + pieces.radii[1];
    const bool flat = radii <= static_cast<double>(std::min(pair.sizes[0], pair.sizes[1])) / 16;
    if (pieces.near.certain_distance == 0 && flat && attempts_ < max_attempts) {
      ++attempts_;
      if (certainly_cross(frames_, pieces)) bounds_.reduce_upper(0);
    }
  }

  // What is known of a direction is kept until a better one shows more than the precision (angle squared).
  void look_along_witness() {
    const Vector3 direction = normalized(witness_.points[1] - witness_.points[0]);
    if (direction == Vector3{}) return;
    if (length_sq(direction - direction_) <= bounds_.precision() / 8) return;
    direction_ = direction;
    pieces_.look_along(direction);
  }

  Distance result() {
    Distance answer;
    answer.stats = stats_;
    const PowerOfTwo back = frames_.to_mesh_units();
    answer.distance = {unscaled_down(bounds_.lower(), back),
                       require_representable(unscaled_up(bounds_.upper(), back))};
    answer.reached = near_enough(answer.distance, options_);
    pieces_.tell(witness_, answer);
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
  Witness witness_;
  Vector3 direction_;
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
