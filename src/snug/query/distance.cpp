#include <algorithm>
#include <array>
#include <cmath>
#include <span>

#include <snug/certificate/certify.h>
#include <snug/query/nesting.h>
#include <snug/query/pair_queries.h>
#include <snug/search/crossing.h>
#include <snug/search/pair_frames.h>
#include <snug/search/precision.h>
#include <snug/surface/unscale.h>
#include <support/ordering.h>
#include <support/run.h>

namespace snug {
namespace {

constexpr int max_crossing_attempts = 64;
// Proofs of surfaces that overlap a little took less; where surfaces coincide there is none, and no end.
constexpr std::uint64_t max_crossing_splits = 256;
// Pairs that are followed down at the same time for a first upper bound.
constexpr std::size_t beam = 4;
// Limit points are evaluated where they may be nearer by so much of the precision.
constexpr double min_gain = 0.125;
// Bounds of gaps err by some hundred roundings of what is about 4 large.
constexpr double gap_noise = 0x1p-43;

bool nearer(const NodePair& x, const NodePair& y) { return x.gap < y.gap; }
bool farther_pair(const NodePair& x, const NodePair& y) { return x.gap > y.gap; }

class DistanceSearch {
 public:
  DistanceSearch(const PlacedBvh& a, const PlacedBvh& b, const DistanceOptions& options, const Run& run)
      : frames_(a, b),
        options_(options),
        monitor_(monitor_of(run)),
        max_splits_(run.max_splits.value_or(default_splits::distance)),
        bounds_(frames_.length_down(*options.absolute), *options.relative, gap_noise) {
    bounds_.raise_lower(frames_.length_down(outer_gap(a, b)));
  }

  // Depth first, the nearest first, from an upper bound on.
  Distance run() {
    dive();
    open_.start(Order::last_first, walk_.roots());
    search(open_, *this);
    // Pairs not visited, since the bounds are near enough or the budget has ended.
    for (const NodePair& pair : open_.items()) bounds_.prune(gap_of(pair));
    return result();
  }

  Verb look_at(const NodePair& pair) {
    double gap = gap_of(pair);
    if (bounds_.done()) return stop(gap);
    if (pair.bounded() && gap < bounds_.prune_distance()) {
      monitor_.checkpoint();
      gap = std::max(gap, gap_of_pieces(pair));
      if (gap < bounds_.prune_distance() && PiecePairs::at_single_precision(pair)) {
        gap = std::max(gap, gap_in_double(pair));
      }
    }
    const PairWalk::May may = walk_.may(pair, max_splits_);
    if (gap >= bounds_.prune_distance() || may == PairWalk::May::not_open) {
      bounds_.prune(gap);
      return Verb::drop;
    }
    if (may == PairWalk::May::open) return Verb::open;
    budget_spent_ = stats_.splits >= max_splits_;
    return stop(gap_of(pair));
  }
  void open(const NodePair& pair) {
    const std::size_t before = open_.size();
    bounds_.prune(static_cast<double>(walk_.open(pair, bounds_.prune_distance(), open_)));
    const std::span<NodePair> opened = open_.items().subspan(before);
    ordering::sort(opened.data(), opened.size(), farther_pair);
  }

 private:
  [[nodiscard]] static double gap_of(const NodePair& pair) {
    return std::max(static_cast<double>(pair.gap), 0.0);
  }
  Verb stop(double gap) {
    bounds_.prune(gap);
    return Verb::stop;
  }

  // Straight down to pieces that are near each other, so that there is an upper bound from the beginning.
  void dive() {
    std::array<NodePair, beam> front{walk_.roots()};
    std::size_t count = 1;
    const auto whole = [](const NodePair& pair) { return pair.bounded(); };
    while (!std::all_of(front.data(), front.data() + count, whole)) {
      open_.start(Order::last_first);
      for (const NodePair& pair : std::span(front).first(count)) {
        if (whole(pair)) {
          open_.add(pair);
        } else {
          static_cast<void>(walk_.open(pair, INFINITY, open_));
        }
      }
      const std::span<NodePair> next = open_.items();
      count = std::min(beam, next.size());
      ordering::partial_sort(next.data(), count, next.size(), nearer);
      std::copy_n(next.begin(), count, front.begin());
    }
    for (std::size_t i = 0; i < count; ++i) improve(front[i], pieces_.nearest(front[i]));
  }

  // A lower bound of the distance of two pieces; improves the upper one.
  double gap_of_pieces(const NodePair& pair) {
    const double along = pieces_.gap_along(pair.nodes);
    if (along >= bounds_.prune_distance()) return along;
    const PiecePair pieces = pieces_.nearest(pair);
    improve(pair, pieces);
    return std::max({along, pieces.gap, pieces_.gap_along(pair.nodes, pieces.between)});
  }

  double gap_in_double(const NodePair& pair) {
    const PiecePair pieces = pieces_.nearest_in_double(pair);
    take(PiecePairs::approximate_witness(pieces));
    try_crossing(pair, pieces);
    return pieces.gap;
  }

  // The upper bound, by limit points near each other or by a proof of contact.
  void improve(const NodePair& pair, PiecePair pieces) {
    if (length(pieces.between) < bounds_.upper()) {
      pieces_.approach(pieces);
      const double gain = bounds_.upper() == INFINITY ? 0 : min_gain * bounds_.precision();
      if (length(pieces.between) < bounds_.upper() - gain) take(pieces_.witness(pieces));
    }
    try_crossing(pair, pieces);
  }

  void take(const Witness& witness) {
    if (!(witness.distance < bounds_.upper())) return;
    witness_ = witness;
    bounds_.reduce_upper(witness.distance);
    pieces_.look_along(witness.points[1] - witness.points[0]);
  }

  void try_crossing(const NodePair& pair, const PiecePair& pieces) {
    const double radii = pieces.radii[0] + pieces.radii[1];
    const bool flat = radii <= static_cast<double>(std::min(walk_.size(pair, 0), walk_.size(pair, 1))) / 16;
    if (pieces.near.certain_distance == 0 && flat && attempts_ < max_crossing_attempts) {
      ++attempts_;
      if (proves_crossing(frames_, pieces)) bounds_.reduce_upper(0);
    }
  }

  Distance result() {
    Distance answer;
    answer.stats = stats_;
    const PowerOfTwo back = frames_.to_mesh_units();
    answer.distance = {unscaled_down(bounds_.lower(), back),
                       require_representable(unscaled_up(bounds_.upper(), back))};
    answer.outcome = outcome_of(near_enough(answer.distance, options_), budget_spent_);
    pieces_.write_to(witness_, answer);
    return answer;
  }

  PairFrames frames_;
  SearchStats stats_;
  PairWalk walk_{frames_, stats_, WideNode::Gaps::lines};
  PiecePairs pieces_{frames_, stats_};
  Frontier<NodePair>& open_ = frames_.cache(0).open_pairs();
  const DistanceOptions& options_;
  const WorkMonitor& monitor_;
  std::uint64_t max_splits_;
  DistanceBounds bounds_;
  Witness witness_;
  int attempts_ = 0;
  bool budget_spent_ = false;
};

// A search ends once its bounds are near enough, before it is seen that surfaces meet: a search for a common point alone.
void prove_contact(const PlacedBvh& a, const PlacedBvh& b, const Run& run, Distance& answer) {
  const std::uint64_t budget = run.max_splits.value_or(default_splits::distance);
  const Run rest{.monitor = run.monitor,
                 .max_splits = std::min(max_crossing_splits, budget - std::min(budget, answer.stats.splits))};
  const Collision found = collide(a, b, {.tolerance = answer.distance.upper, .prove_contact = true}, rest);
  answer.stats.box_tests += found.stats.box_tests;
  answer.stats.triangle_tests += found.stats.triangle_tests;
  answer.stats.evaluations += found.stats.evaluations;
  answer.stats.splits += found.stats.splits;
  if (found.verdict != Verdict::intersecting) return;
  answer.distance = 0;
  answer.witness = *found.witness;
  answer.outcome = Outcome::complete;
}

}  // namespace

Distance distance(const PlacedBvh& a, const PlacedBvh& b, const DistanceOptions& options, const Run& run) {
  const DistanceOptions wanted = with_precision(options, a.model.surface().size(), b.model.surface().size());
  if (options.solid) require_solids(a, b);
  Distance answer = DistanceSearch(a, b, wanted, run).run();
  if (answer.distance.lower == 0 && answer.distance.upper > 0) prove_contact(a, b, run, answer);
  if (!options.solid || answer.distance.upper == 0) return answer;
  const Nesting found =
      answer.distance.lower > 0 ? nesting(a, b, monitor_of(run)) : common_point(a, b, monitor_of(run));
  if (found.inner) {
    found.write_to(answer);
    answer.outcome = Outcome::complete;
  } else if (!found.certain) {
    answer.distance.lower = 0;
    if (!near_enough(answer.distance, wanted)) answer.outcome = worse(answer.outcome, Outcome::at_rounding);
  }
  return answer;
}

Distance distance(const PlacedSurface& a, const PlacedSurface& b, const DistanceOptions& options,
                  const Run& run) {
  const PlacedPair at(a, b, workspace_of(run));
  const Distance answer = distance(at.a, at.b, options, run);
  certify(run, a, b, options, answer);
  return answer;
}

std::vector<Distance> distance(const Surface& a, const Surface& b, std::span<const PosePair> poses,
                               const DistanceOptions& options, const Run& run) {
  const std::vector<Distance> answers = answers_to(distance, a, b, poses, options, run);
  certify(run, a, b, poses, options, answers);
  return answers;
}

}  // namespace snug
