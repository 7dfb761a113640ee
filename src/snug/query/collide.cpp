#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include <snug/certificate/certify.h>
#include <snug/geometry/rounding.h>
#include <snug/query/nesting.h>
#include <snug/query/pair_queries.h>
#include <snug/search/crossing.h>
#include <snug/search/near_pairs.h>
#include <snug/search/pair_frames.h>
#include <snug/search/precision.h>
#include <snug/surface/unscale.h>
#include <support/error.h>
#include <support/names.h>
#include <support/run.h>

namespace snug {
namespace {

constexpr auto outcome_names = std::to_array<Named<Outcome>>({{"complete", Outcome::complete},
                                                              {"budget-spent", Outcome::budget_spent},
                                                              {"at-rounding", Outcome::at_rounding}});
constexpr auto verdict_names = std::to_array<Named<Verdict>>({{"separated", Verdict::separated},
                                                              {"within", Verdict::within},
                                                              {"intersecting", Verdict::intersecting},
                                                              {"undecided", Verdict::undecided}});

// Attempts to prove that surfaces intersect: of surfaces that nearly lie in each other every pair looks like
// a crossing.
constexpr int max_attempts = 2000, max_attempts_within = 64;
// Where only nearness matters: pairs of pieces that wait for others before one of them is split, and Newton
// steps towards a common point of two pieces, on their quadratics and on the limit surfaces.
constexpr std::size_t max_waiting = 16;
constexpr int quadratic_steps = 2, limit_steps = 2;

// Pairs of pieces that are not split before others have been looked at.
class WaitingPairs {
 public:
  [[nodiscard]] bool empty() const { return count_ == 0; }
  [[nodiscard]] bool full() const { return count_ == pairs_.size(); }
  // `apart`: how far points of them are.
  void add(const NodePair& pair, double apart) { pairs_[count_++] = {pair, apart}; }
  // Those that come nearest.
  [[nodiscard]] NodePair take_nearest() {
    Waiting* const end = pairs_.data() + count_;
    Waiting* const nearest = std::min_element(
        pairs_.data(), end, [](const Waiting& x, const Waiting& y) { return x.apart < y.apart; });
    const NodePair pair = nearest->pair;
    std::move(nearest + 1, end, nearest);
    --count_;
    return pair;
  }

 private:
  struct Waiting {
    NodePair pair;
    double apart;
  };
  std::array<Waiting, max_waiting + 1> pairs_;
  std::size_t count_ = 0;
};

class CollideSearch {
 public:
  CollideSearch(const PlacedBvh& a, const PlacedBvh& b, const CollideOptions& options, const Run& run)
      : frames_(a, b), options_(options), run_(run) {
    margin_ = frames_.length_up(options.margin);
    reach_ = frames_.length_down((options.margin + *options.tolerance) * (1 - unit_roundoff));
  }

  // Depth first; the pair that overlaps more deeply first.
  Collision run() {
    const NodePair roots = walk_.roots();
    // Points so near cannot be found sooner than a crossing is proved.
    crossing_.wanted =
        options_.prove_contact ||
        reach_ <= 0x1p-14 * static_cast<double>(std::max(walk_.size(roots, 0), walk_.size(roots, 1)));
    NearPairs near(frames_, stats_, margin_);
    open_pairs().start(Order::last_first);
    if (!near.usable()) open_pairs().add(roots);
    do search(open_pairs(), *this);
    while (take_more(near));
    known_.lower = std::min(known_.lower, std::max(0.0, near.others()));
    // An attempt costs about what a split does.
    if (known_.near_enough && !crossing_.wanted && stats_.splits > 0 && is_flat(*known_.pieces) &&
        known_.pieces->near.certain_distance == 0) {
      crossing_.proved = proves_crossing(frames_, *known_.pieces);
    }
    return result();
  }

  // Rules (a), (b) and (c).
  Verb look_at(const NodePair& pair) {
    if (!pair.bounded()) return to_open(pair);
    monitor_of(run_).checkpoint();
    const PiecePair pieces = pieces_.nearest(pair);
    if (!stays_open(pair, pieces)) return after_a_look();
    if (PiecePairs::at_single_precision(pair)) {
      return stays_open(pair, pieces_.nearest_in_double(pair)) ? to_open(pair) : after_a_look();
    }
    // Others may show at once what a split may show.
    if (crossing_.wanted) return to_open(pair);
    waiting_.add(pair, length(pieces.between));
    return waiting_.full() ? open_nearest_waiting() : Verb::drop;
  }
  void open(const NodePair& pair) {
    known_.lower = std::min(known_.lower, static_cast<double>(walk_.open(pair, margin_, open_pairs())));
  }

 private:
  [[nodiscard]] bool finished() const {
    if (crossing_.proved) return true;
    return known_.near_enough && (!options_.prove_contact || crossing_.attempts >= max_attempts_within);
  }
  [[nodiscard]] Verb after_a_look() const { return finished() ? Verb::stop : Verb::drop; }

  // Where nothing is open: another pair of patches, or one that waits. False at the end.
  bool take_more(NearPairs& near) {
    if (finished() || end_.early) return false;
    if (NodePair next; near.usable() && near.next(next)) {
      open_pairs().add(next);
      return true;
    }
    return !waiting_.empty() && open_nearest_waiting() == Verb::drop;
  }

  Verb open_nearest_waiting() {
    const NodePair pair = waiting_.take_nearest();
    const Verb verb = to_open(pair);
    if (verb == Verb::open) open(pair);
    return verb == Verb::stop ? Verb::stop : Verb::drop;
  }

  Verb to_open(const NodePair& pair) {
    const PairWalk::May may = walk_.may(pair, max_splits());
    if (may == PairWalk::May::open) return Verb::open;
    end_.incomplete = true;
    if (may == PairWalk::May::not_open) return Verb::drop;
    end_.early = true;
    end_.budget_spent = stats_.splits >= max_splits();
    return Verb::stop;
  }

  // To prove a crossing both pieces must be flat.
  [[nodiscard]] bool is_flat(const PiecePair& pieces) const {
    const NodePair pair{pieces.nodes, 0};
    return pieces.radii[0] + pieces.radii[1] <=
           static_cast<double>(std::min(walk_.size(pair, 0), walk_.size(pair, 1))) / 16;
  }

  // Rules (a) and (b).
  bool stays_open(const NodePair& pair, const PiecePair& pieces) {
    const double gap = pieces.gap > margin_
                           ? pieces.gap
                           : std::max(pieces.gap, pieces_.gap_along(pair.nodes, pieces.between));
    if (gap > margin_) {
      known_.lower = std::min(known_.lower, gap);
      return false;
    }
    if (!known_.near_enough) {
      known_.take(pieces, reach_);
      // Limit points themselves may be near enough where quadratics are not known to be.
      if (!known_.near_enough && length(pieces.between) <= reach_) {
        known_.take(pieces_.witness(pieces), reach_);
      }
      if (!known_.near_enough && !crossing_.wanted && pieces.gap <= reach_) find_common_point(pieces);
    }
    if (crossing_.wanted && crossing_.attempts < max_attempts && is_flat(pieces)) {
      if (pieces.near.certain_distance == 0) {
        ++crossing_.attempts;
        crossing_.proved = proves_crossing(frames_, pieces);
      } else if (known_.near_enough) {
        ++crossing_.attempts;
      }
    }
    return !finished();
  }

  // Where pieces meet, points of them are near each other long before they are flat.
  void find_common_point(PiecePair pieces) {
    for (int i = 0; i < quadratic_steps && pieces.near_distance > reach_; ++i) {
      pieces_.step_together(pieces, pieces.between);
    }
    known_.take(pieces, reach_);
    if (known_.near_enough || length(pieces.between) > reach_) return;
    for (int i = 0; i < limit_steps && !known_.near_enough; ++i) {
      const Witness witness = pieces_.witness(pieces);
      known_.take(witness, reach_);
      pieces_.step_together(pieces, witness.points[1] - witness.points[0]);
    }
  }

  Collision result() {
    Collision answer;
    answer.stats = stats_;
    answer.verdict = crossing_.proved     ? Verdict::intersecting
                     : known_.near_enough ? Verdict::within
                     : end_.incomplete    ? Verdict::undecided
                                          : Verdict::separated;
    answer.outcome = outcome_of(answer.verdict != Verdict::undecided, end_.budget_spent);
    const PowerOfTwo back = frames_.to_mesh_units();
    if (known_.pieces && known_.pieces->near_distance < known_.points.distance) {
      const bool exact = options_.witness == WitnessKind::exact;
      known_.take(exact ? pieces_.witness(*known_.pieces) : PiecePairs::approximate_witness(*known_.pieces),
                  reach_);
    }
    // Pairs that were not visited, or not resolved, may be as near as 0.
    const bool whole = answer.verdict == Verdict::separated;
    answer.distance.lower = whole ? unscaled_down(std::min(known_.lower, known_.points.distance), back) : 0.0;
    if (known_.points.distance < INFINITY) {
      // Two quadratics may be nearer than their limit points as doubles.
      const double upper = known_.pieces ? std::min(known_.points.distance, known_.pieces->near_distance)
                                         : known_.points.distance;
      answer.distance.upper = require_representable(unscaled_up(upper, back));
      if (options_.witness != WitnessKind::none) pieces_.write_to(known_.points, answer);
    }
    if (crossing_.proved) answer.distance.upper = 0;
    return answer;
  }

  [[nodiscard]] std::uint64_t max_splits() const { return run_.max_splits.value_or(default_splits::collide); }
  [[nodiscard]] Frontier<NodePair>& open_pairs() { return frames_.cache(0).open_pairs(); }

  // The distance, as far as it is known.
  struct Known {
    double lower = INFINITY;          // of what was passed over
    std::optional<PiecePair> pieces;  // whose quadratics came nearest
    Witness points;                   // of limit points
    bool near_enough = false;         // are the last ones of either, for a verdict?

    void take(const PiecePair& found, double reach) {
      if (!pieces || found.near_distance < pieces->near_distance) pieces = found;
      near_enough = pieces->near_distance <= reach;
    }
    void take(const Witness& found, double reach) {
      if (found.distance < points.distance) points = found;
      near_enough = points.distance <= reach;
    }
  };
  struct Crossing {
    bool wanted = false, proved = false;
    int attempts = 0;
  };
  struct End {
    bool incomplete = false;    // pairs were not opened, for the budget, or because they cannot be
    bool early = false;         // for the budget, or the memory of a query
    bool budget_spent = false;  // the former
  };

  PairFrames frames_;
  SearchStats stats_;
  PairWalk walk_{frames_, stats_, WideNode::Gaps::axes};
  PiecePairs pieces_{frames_, stats_};
  const CollideOptions& options_;
  const Run& run_;
  double margin_ = 0, reach_ = 0;
  Known known_;
  Crossing crossing_;
  WaitingPairs waiting_;
  End end_;
};

// Makes of an answer about two closed surfaces that for the solids that they bound. A point of one surface in
// the other solid is a common point of both solids, whatever is known of the surfaces.
void make_solid(const PlacedBvh& a, const PlacedBvh& b, const Run& run, Collision& answer) {
  const bool separated = answer.verdict == Verdict::separated;
  const Nesting found = separated ? nesting(a, b, monitor_of(run)) : common_point(a, b, monitor_of(run));
  if (found.inner) {
    found.write_to(answer);
    answer.verdict = Verdict::intersecting;
    answer.outcome = Outcome::complete;
  } else if (!separated && have_inner_point_in_common(a, b, monitor_of(run))) {
    answer.verdict = Verdict::intersecting;
    answer.outcome = Outcome::complete;
    answer.distance = 0;
  } else if (separated && !found.certain) {
    answer.verdict = Verdict::undecided;
    answer.outcome = Outcome::at_rounding;
    answer.distance.lower = 0;
  }
}

Collision apart_by(double gap) {
  Collision answer;
  answer.verdict = Verdict::separated;
  answer.distance.lower = gap;
  return answer;
}

// Where the roots are not apart. By itself, so that far pairs pay nothing for it.
[[gnu::noinline]] Collision search_trees(const PlacedBvh& a, const PlacedBvh& b,
                                         const CollideOptions& options, const Run& run, bool verdict_alone) {
  Collision answer = CollideSearch(a, b, options, run).run();
  if (answer.verdict == Verdict::separated && !verdict_alone) {
    answer.distance.lower = std::max(answer.distance.lower, std::min(outer_gap(a, b), answer.distance.upper));
  }
  const bool proved = answer.verdict == Verdict::intersecting ||
                      (answer.verdict == Verdict::within && !options.prove_contact);
  if (options.solid && !proved) make_solid(a, b, run, answer);
  return answer;
}

Collision ask(const PlacedBvh& a, const PlacedBvh& b, const CollideOptions& options, const Run& run) {
  const bool verdict_alone = options.witness == WitnessKind::none && !options.measure;
  if (const double gap = root_gap(a, b, options.margin); gap > options.margin) {
    return apart_by(verdict_alone ? gap : std::max(gap, outer_gap(a, b)));
  }
  return search_trees(a, b, options, run, verdict_alone);
}

// Brings the bounds of separated surfaces, which hold for their solids too, to within a factor of 2.
void measure(const PlacedBvh& a, const PlacedBvh& b, const Run& run, Collision& answer) {
  Distance found;
  try {
    found = distance(a, b, {.absolute = {}, .relative = 0.5}, run);
  } catch (const InputError& error) {
    // An upper bound that does not fit a double takes nothing from the verdict.
    if (error.problem() == InputProblem::unrepresentable) return;
    throw;
  }
  answer.distance.lower = std::max(answer.distance.lower, found.distance.lower);
  if (answer.distance.upper <= found.distance.upper) return;
  answer.distance.upper = found.distance.upper;
  answer.witness = found.witness;
}

}  // namespace

const char* name_of(Outcome outcome) { return name_in(outcome_names, outcome); }
const char* name_of(Verdict verdict) { return name_in(verdict_names, verdict); }

Collision collide(const PlacedBvh& a, const PlacedBvh& b, const CollideOptions& options, const Run& run) {
  CollideOptions wanted = options;
  if (!wanted.tolerance) {
    wanted.tolerance = share_of_size(1e-3, a.model.surface().size(), b.model.surface().size());
  }
  require_length(*wanted.tolerance, "collide: the tolerance");
  require_length(options.margin, "collide: the margin");
  if (options.solid) require_solids(a, b);
  Collision answer = ask(a, b, wanted, run);
  const bool measured =
      answer.distance.upper < INFINITY && answer.distance.lower >= answer.distance.upper / 2;
  if (options.measure && answer.verdict == Verdict::separated && !measured) {
    measure(a, b, run, answer);
  }
  if (options.witness == WitnessKind::none) answer.witness.reset();
  return answer;
}

Collision collide(const PlacedSurface& a, const PlacedSurface& b, const CollideOptions& options,
                  const Run& run) {
  const PlacedPair at(a, b, workspace_of(run));
  const Collision answer = collide(at.a, at.b, options, run);
  certify(run, a, b, options, answer);
  return answer;
}

std::vector<Collision> collide(const Surface& a, const Surface& b, std::span<const PosePair> poses,
                               const CollideOptions& options, const Run& run) {
  const std::vector<Collision> answers = answers_to(collide, a, b, poses, options, run);
  certify(run, a, b, poses, options, answers);
  return answers;
}

}  // namespace snug
