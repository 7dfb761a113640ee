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

class CollideSearch {
 public:
  CollideSearch(const PlacedBvh& a, const PlacedBvh& b, const CollideOptions& options, const Run& run)
      : frames_(a, b),
        options_(options),
        monitor_(monitor_of(run)),
        max_splits_(run.max_splits.value_or(default_splits::collide)) {
    margin_ = frames_.length_up(options.margin);
    reach_ = frames_.length_down((options.margin + *options.tolerance) * (1 - unit_roundoff));
  }

  // Depth first; the pair that overlaps more deeply first.
  Collision run() {
    const NodePair roots = walk_.roots();
    // Points so near cannot be found sooner than a crossing is proved.
    proving_ = options_.prove_contact ||
               reach_ <= 0x1p-14 * static_cast<double>(std::max(walk_.size(roots, 0), walk_.size(roots, 1)));
    NearPairs near(frames_, stats_, margin_);
    open_.start(Order::last_first);
    if (!near.usable()) open_.add(roots);
    do search(open_, *this);
    while (take_more(near));
    lower_ = std::min(lower_, std::max(0.0, near.others()));
    // An attempt costs about what a split does.
    if (found_ && !proving_ && stats_.splits > 0 && is_flat(*near_) && near_->near.certain_distance == 0) {
      crossing_ = proves_crossing(frames_, *near_);
    }
    return result();
  }

  // Rules (a), (b) and (c).
  Verb look_at(const NodePair& pair) {
    if (!pair.bounded()) return to_open(pair);
    monitor_.checkpoint();
    const PiecePair pieces = pieces_.nearest(pair);
    if (!stays_open(pair, pieces)) return after_a_look();
    if (PiecePairs::at_single_precision(pair)) {
      return stays_open(pair, pieces_.nearest_in_double(pair)) ? to_open(pair) : after_a_look();
    }
    // Others may show at once what a split may show.
    if (proving_) return to_open(pair);
    waiting_[waiting_count_++] = {pair, length(pieces.between)};
    return waiting_count_ == waiting_.size() ? open_nearest_waiting() : Verb::drop;
  }
  void open(const NodePair& pair) {
    lower_ = std::min(lower_, static_cast<double>(walk_.open(pair, margin_, open_)));
  }

 private:
  [[nodiscard]] bool finished() const {
    if (crossing_) return true;
    return found_ && (!options_.prove_contact || attempts_ >= max_attempts_within);
  }
  [[nodiscard]] Verb after_a_look() const { return finished() ? Verb::stop : Verb::drop; }

  // Where nothing is open: another pair of patches, or one that waits. False at the end.
  bool take_more(NearPairs& near) {
    if (finished() || ended_) return false;
    if (NodePair next; near.usable() && near.next(next)) {
      open_.add(next);
      return true;
    }
    return waiting_count_ > 0 && open_nearest_waiting() == Verb::drop;
  }

  // A pair of pieces as near as has waited.
  struct Waiting {
    NodePair pair;
    double apart;
  };
  Verb open_nearest_waiting() {
    Waiting* const end = waiting_.data() + waiting_count_;
    Waiting* const nearest = std::min_element(
        waiting_.data(), end, [](const Waiting& x, const Waiting& y) { return x.apart < y.apart; });
    const NodePair pair = nearest->pair;
    std::move(nearest + 1, end, nearest);
    --waiting_count_;
    const Verb verb = to_open(pair);
    if (verb == Verb::open) open(pair);
    return verb == Verb::stop ? Verb::stop : Verb::drop;
  }

  Verb to_open(const NodePair& pair) {
    const PairWalk::May may = walk_.may(pair, max_splits_);
    if (may == PairWalk::May::open) return Verb::open;
    incomplete_ = true;
    if (may == PairWalk::May::not_open) return Verb::drop;
    ended_ = true;
    budget_spent_ = stats_.splits >= max_splits_;
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
      lower_ = std::min(lower_, gap);
      return false;
    }
    if (!found_) {
      if (!near_ || pieces.near_distance < near_->near_distance) near_ = pieces;
      found_ = near_->near_distance <= reach_;
      // Limit points themselves may be near enough where quadratics are not known to be.
      if (!found_ && length(pieces.between) <= reach_) {
        const Witness witness = pieces_.witness(pieces);
        if (witness.distance < best_.distance) best_ = witness;
        found_ = best_.distance <= reach_;
      }
      if (!found_ && !proving_ && pieces.gap <= reach_) find_common_point(pieces);
    }
    if (proving_ && attempts_ < max_attempts && is_flat(pieces)) {
      if (pieces.near.certain_distance == 0) {
        ++attempts_;
        crossing_ = proves_crossing(frames_, pieces);
      } else if (found_) {
        ++attempts_;
      }
    }
    return !finished();
  }

  // Where pieces meet, points of them are near each other long before they are flat.
  void find_common_point(PiecePair pieces) {
    for (int i = 0; i < quadratic_steps && pieces.near_distance > reach_; ++i) {
      pieces_.step_together(pieces, pieces.between);
    }
    if (pieces.near_distance < near_->near_distance) near_ = pieces;
    found_ = near_->near_distance <= reach_;
    if (found_ || length(pieces.between) > reach_) return;
    for (int i = 0; i < limit_steps && !found_; ++i) {
      const Witness witness = pieces_.witness(pieces);
      if (witness.distance < best_.distance) best_ = witness;
      found_ = best_.distance <= reach_;
      pieces_.step_together(pieces, witness.points[1] - witness.points[0]);
    }
  }

  Collision result() {
    Collision answer;
    answer.stats = stats_;
    answer.verdict = crossing_     ? Verdict::intersecting
                     : found_      ? Verdict::within
                     : incomplete_ ? Verdict::undecided
                                   : Verdict::separated;
    answer.outcome = outcome_of(answer.verdict != Verdict::undecided, budget_spent_);
    const PowerOfTwo back = frames_.to_mesh_units();
    if (near_ && near_->near_distance < best_.distance) {
      const bool exact = options_.witness == WitnessKind::exact;
      const Witness witness = exact ? pieces_.witness(*near_) : PiecePairs::approximate_witness(*near_);
      if (witness.distance < best_.distance) best_ = witness;
    }
    // Pairs that were not visited, or not resolved, may be as near as 0.
    const bool whole = answer.verdict == Verdict::separated;
    answer.distance.lower = whole ? unscaled_down(std::min(lower_, best_.distance), back) : 0.0;
    if (best_.distance < INFINITY) {
      // Two quadratics may be nearer than their limit points as doubles.
      const double upper = near_ ? std::min(best_.distance, near_->near_distance) : best_.distance;
      answer.distance.upper = require_representable(unscaled_up(upper, back));
      if (options_.witness != WitnessKind::none) pieces_.write_to(best_, answer);
    }
    if (crossing_) answer.distance.upper = 0;
    return answer;
  }

  PairFrames frames_;
  SearchStats stats_;
  PairWalk walk_{frames_, stats_, WideNode::Gaps::axes};
  PiecePairs pieces_{frames_, stats_};
  Frontier<NodePair>& open_ = frames_.cache(0).open_pairs();
  std::array<Waiting, max_waiting + 1> waiting_;
  std::size_t waiting_count_ = 0;
  const CollideOptions& options_;
  const WorkMonitor& monitor_;
  std::uint64_t max_splits_;
  double margin_ = 0, reach_ = 0;
  double lower_ = INFINITY;
  Witness best_;
  std::optional<PiecePair> near_;  // the two that came nearest
  int attempts_ = 0;
  bool proving_ = false;
  // `incomplete_`: pairs were not opened, for the budget, which has `ended_`, or because they cannot be.
  bool found_ = false, crossing_ = false, incomplete_ = false, ended_ = false, budget_spent_ = false;
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
