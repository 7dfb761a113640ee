#include <algorithm>
#include <cmath>
#include <optional>
#include <vector>

#include <snug/geometry/rounding.h>
#include <snug/query/moving_pair.h>
#include <snug/query/nesting.h>
#include <snug/query/pair_queries.h>
#include <snug/search/pair_frames.h>
#include <snug/search/precision.h>
#include <snug/search/solid.h>
#include <snug/surface/unscale.h>
#include <support/error.h>
#include <support/run.h>

namespace snug {
namespace {

// Precision of distances: of the distance, and of the tolerance.
constexpr double relative = 0.25, share_of_tolerance = 0.125;
// The least share of it, where surfaces come together slowly while they move fast.
constexpr double least_share = 0x1p-9;
// Without a tolerance: of the size.
constexpr double min_resolution = 0x1p-36;
// Share of the reach of two evaluated times that their distance may take, so that they surely meet.
constexpr double reach_share = 0.8;
// Times after the surfaces have come within the tolerance that are tried for a crossing.
constexpr int max_probes = 7;
// Most queries at one time beyond the first one, where there is a margin.
constexpr int max_queries = 8;
// Times in a row without a result.
constexpr int max_blocked = 8;
// Budget that one evaluation takes besides its splits: some hundred microseconds of work. None may take more than a
// part of the whole budget.
constexpr std::uint64_t cost_of_look = 1000, looks_of_budget = 16;
// Pairs of nodes are followed through time after this many looks in a piece, if this many more are expected; at once
// where that finished a piece before. The first allowance of pairs and splits.
constexpr int first_patience = 8, looks_too_many = 12;
constexpr std::uint64_t first_allowance = 1000;
// Part of the goal that surfaces move by in the shortest step of theirs.
constexpr double share_of_step = 0.125;

// Bounds at one time, of the exact motion.
struct Look {
  double time = 0;
  double lower = 0, upper = INFINITY;  // of the distance, less the margin
  bool apart = false, crossing = false;
  // The likely distance: points found are mostly the nearest ones.
  [[nodiscard]] double likely() const { return upper < INFINITY ? upper : lower; }
};

// An upper bound of the speed against each other of any two points that may be within the margin of each other later in the
// piece, and the share of it at which distances shrank.
class ClosingSpeed {
 public:
  ClosingSpeed() = default;
  explicit ClosingSpeed(MovingPair& bodies) {
    if (bodies.deforms()) {
      linear_ = {bodies[0].linear_patches(), bodies[1].linear_patches()};
      if (linear_[0] && linear_[1]) return;
      linear_ = {};
    }
    most_ = bodies.speed();
  }
  // Where all patches go along lines, only those that may be within `margin` of each other in [from, to] of the piece count.
  // False if there are none.
  [[nodiscard]] bool narrow(double from, double to, double margin) {
    if (!linear_[0] || !linear_[1] || span_ == Interval(from, to)) return true;
    span_ = {from, to};
    const std::optional<double> narrowed =
        LinearPatches::meeting_speed(*linear_[0], *linear_[1], from, to, margin);
    if (narrowed && most_ > 0 && *narrowed > 0) share_ = std::min(1.0, share_ * most_ / *narrowed);
    most_ = narrowed.value_or(0);
    return narrowed.has_value();
  }
  void see(const Look& before, const Look& now) {
    if (!(before.time < now.time && most_ > 0)) return;
    const double share = (before.likely() - now.likely()) / (now.time - before.time) / most_;
    share_ = std::clamp(share, 0.0, 1.0);
  }

  // How far that is in some time, rounded up.
  [[nodiscard]] double way(double time) const { return enlarged(most_ * time); }
  // How long a distance lasts, rounded down.
  [[nodiscard]] double time_for(double distance) const {
    if (most_ == 0) return distance > 0 ? INFINITY : 0;
    return std::max(0.0, rounded_down(rounded_down(distance / most_)));
  }
  // The time after which a distance that goes on shrinking as it did is likely to last just back to now.
  [[nodiscard]] double likely_step(double distance) const {
    return reach_share * time_for(distance) * (1 - share_) / (1 + share_);
  }
  [[nodiscard]] double most() const { return most_; }
  // Of it, at which distances shrank.
  [[nodiscard]] double share() const { return std::max(share_, least_share); }

 private:
  double most_ = 0, share_ = 1;
  std::array<std::optional<LinearPatches>, 2> linear_;  // both or none
  Interval span_{-1, -1};                               // the times that most_ is of, if they are
};

// How well distances are to be known, and the time.
struct Accuracy {
  double tolerance, size, resolution = share_of_tolerance * tolerance;
  // The way in a time that is short enough.
  [[nodiscard]] double goal() const { return std::max(tolerance, 8 * min_resolution * size); }
  [[nodiscard]] DistanceOptions wanted() const {
    return {.absolute = std::max(resolution, min_resolution * size), .relative = relative};
  }
};

// The work that was done, and the rest of the budget, which each piece has anew.
struct Work {
  const WorkMonitor& monitor;
  std::uint64_t budget, spent = 0;
  int looks = 0;
  SearchStats stats{};

  void count_look() {
    ++looks;
    spent += cost_of_look;
  }
  void add(const SearchStats& more) {
    stats.box_tests += more.box_tests;
    stats.triangle_tests += more.triangle_tests;
    stats.evaluations += more.evaluations;
    stats.splits += more.splits;
    spent += more.splits;
  }
  [[nodiscard]] std::uint64_t left() const { return spent < budget ? budget - spent : 0; }
  [[nodiscard]] std::uint64_t most_of_look() const { return budget / looks_of_budget; }
  [[nodiscard]] Run for_look() const {
    return {.monitor = &monitor, .max_splits = std::min(left(), most_of_look())};
  }
};

// Times at which it is not known whether there is contact.
struct Undecided {
  double first = INFINITY, last = 0;
  int count = 0;
  void add(double time) {
    first = std::min(first, time);
    last = std::max(last, time);
    ++count;
  }
};

// The first times known with contact at or before, within the tolerance, and undecided.
struct UpperTimes {
  double crossing = INFINITY, within = INFINITY;
  Undecided undecided{};
  [[nodiscard]] double near() const { return std::min(within, undecided.first); }
};

// How looks in a piece get on, and when pairs of nodes are followed through time instead.
struct Progress {
  int looks = 0, followed_at = 0;             // all, and those before pairs were followed
  std::optional<Look> first{}, last{};        // that raised the lower bound; the first one since then
  int patience = first_patience;              // looks before pairs are followed
  std::uint64_t allowance = first_allowance;  // of work to follow them

  void add(const Look& look) {
    last = look;
    if (!first) first = look;
  }
  void follow(bool to_end) {
    first.reset();
    followed_at = looks;
    patience = to_end ? 1 : std::max(2 * looks, first_patience);
  }
  // Will looks take many more to `end` or to a distance of `goal`, if both get nearer as since the first one?
  [[nodiscard]] bool slow(double lower, double end, double goal) const {
    if (looks < patience || !first) return false;
    if (patience <= 1) return true;
    const double count = looks - followed_at, near = last->likely();
    const double shrunk = std::log(first->likely() / near), to_shrink = std::log(std::max(near / goal, 1.0));
    return count * (end - lower) > looks_too_many * (lower - first->time) &&
           count * to_shrink > looks_too_many * shrunk;
  }
};

// The surfaces at time 0, as far as they are known.
struct Start {
  bool apart = false, clear = false;  // as surfaces; farther than the margin
  std::optional<bool> outside{};      // of each other, once known
  Nesting nested{};                   // of solids

  [[nodiscard]] Nesting nest(MovingPair& bodies, const WorkMonitor& monitor) const {
    return apart ? nesting(bodies[0].at_start(), bodies[1].at_start(), monitor)
                 : common_point(bodies[0].at_start(), bodies[1].at_start(), monitor);
  }
  // Are closed surfaces known to be outside of each other? Then one that has a point inside of the other one later has
  // met it. Asked only where no crossing is found.
  [[nodiscard]] bool known_outside(MovingPair& bodies, const WorkMonitor& monitor) {
    if (!outside) {
      const auto closed = [](const MovingBody& body) { return is_closed(body.model().surface()); };
      outside = apart && closed(bodies[0]) && closed(bodies[1]);
      if (*outside) {
        const Nesting found = nest(bodies, monitor);
        outside = !found.inner && found.certain;
      }
    }
    return *outside;
  }
};

// The first contact, in one piece of both motions after the other.
class FirstContactSearch {
 public:
  FirstContactSearch(const MovingBvh& a, const MovingBvh& b, const TimeOfContactOptions& options,
                     const Run& run)
      : bodies_(a, b),
        options_(options),
        work_{monitor_of(run), run.max_splits.value_or(default_splits::time_of_contact)} {}

  TimeOfContact run() {
    enter_piece(0);
    if (!start()) {
      for (std::size_t piece = 0; static_cast<double>(piece) < bodies_.duration(); ++piece) {
        if (piece > 0) enter_piece(piece);
        if (!cross_piece(static_cast<double>(piece) + 1)) break;
      }
    }
    return result();
  }

 private:
  void enter_piece(std::size_t piece) {
    bodies_.enter_piece(piece);
    speed_ = ClosingSpeed(bodies_);
    narrow(bodies_.begin() + 1);
    work_.spent = 0;
    progress_ = {.patience = progress_.patience, .allowance = progress_.allowance};
    ahead_.clear();
  }

  // Only what may meet from lower_ on counts.
  void narrow(double end) {
    const double to = std::min(end, upper_.crossing), begin = bodies_.begin();
    if (!speed_.narrow(lower_ - begin, to - begin, options_.margin)) lower_ = to;
  }

  [[nodiscard]] PlacesInTime begin_look(double time) {
    ++progress_.looks;
    work_.count_look();
    return bodies_.at(time);
  }

  Look look_at(double time, double end) {
    work_.monitor.report(time / std::max(bodies_.duration(), 1.0));
    const PlacesInTime at = begin_look(time);
    Look look{.time = time};
    const double gap = beyond_margin(root_gap(at.a, at.b, INFINITY) * (1 - 4 * unit_roundoff) - at.doubt());
    if (gap > speed_.way(end - time)) {  // enough for all that is left of the piece
      look.lower = gap;
      look.apart = true;
      return look;
    }
    const Distance found = distance_at(at, work_.for_look());
    look.crossing = found.distance.upper == 0;
    look.apart = rounded_down(found.distance.lower - at.doubt()) > 0;
    look.lower = std::max(0.0, beyond_margin(rounded_down(found.distance.lower - at.doubt())));
    look.upper = look.crossing ? 0 : upper_beyond_margin(found.distance.upper + at.doubt());
    return look;
  }
  [[nodiscard]] double beyond_margin(double lower) const {
    return options_.margin == 0 ? lower : rounded_down(lower - options_.margin);
  }
  [[nodiscard]] double upper_beyond_margin(double upper) const {
    return std::max(0.0, rounded_up(enlarged(upper) - options_.margin));
  }
  // A relative precision is of what is beyond the margin: asked again while that is less than was thought.
  Distance distance_at(const PlacesInTime& at, const Run& run) {
    const DistanceOptions usual = accuracy_.wanted();
    Distance found = distance(at.a, at.b, usual, run);
    work_.add(found.stats);
    for (int i = 0; i < max_queries && options_.margin > 0; ++i) {
      const double rest = relative * std::max(0.0, found.distance.upper - options_.margin),
                   wanted = std::max(*usual.absolute, rest);
      const bool narrow = found.distance.upper - found.distance.lower <= wanted;
      if (narrow || found.distance.lower >= options_.margin + 2 * rest) break;
      found = distance(at.a, at.b, {.absolute = wanted}, run);
      work_.add(found.stats);
    }
    return found;
  }

  // Tries to prove contact at a time, by a crossing or by a point of one surface inside of the other one that
  // was not inside at the beginning.
  bool probe(double time) {
    work_.monitor.checkpoint();
    const PlacesInTime at = begin_look(time);
    const CollideOptions wanted{.tolerance = 0, .witness = WitnessKind::none, .prove_contact = true};
    const Collision found = collide(at.a, at.b, wanted, work_.for_look());
    work_.add(found.stats);
    if (found.verdict == Verdict::intersecting) return true;
    note_distance(time, enlarged(found.distance.upper + at.doubt()));
    return found.verdict != Verdict::separated &&
           (options_.solid || start_.known_outside(bodies_, work_.monitor)) &&
           common_point(at.a, at.b, work_.monitor).inner.has_value();
  }
  void note_distance(double time, double upper) {
    if (upper <= accuracy_.tolerance) upper_.within = std::min(upper_.within, time);
  }

  // At time 0. True if that is the answer.
  bool start() {
    const double clear = lower_, end = bodies_.duration() > 0 ? 1 : 0;
    const Look look = look_at(0, end);
    start_.apart = look.apart || clear > 0;
    start_.clear = look.lower > 0 || clear > 0;
    if (options_.solid && !look.crossing) {
      start_.nested = start_.nest(bodies_, work_.monitor);
      if (start_.nested.inner) {
        upper_.crossing = 0;
        return true;
      }
      if (start_.apart && !start_.nested.certain) {
        lower_ = 0;  // of the surfaces it may be known to be later
        return true;
      }
      start_.outside = start_.apart;
    }
    take(look, end);
    // Where nothing moves there is no later time to look for a crossing at.
    const bool may_touch = end == 0 && options_.margin == 0 && upper_.crossing > 0 && upper_.within == 0;
    if (may_touch && options_.prove_contact && probe(0)) meet(0);
    return upper_.crossing == 0 || end == 0;
  }

  // Is the time between two so short that it is not worth making shorter?
  [[nodiscard]] bool short_enough(double from, double to) const {
    return from >= to || speed_.way(to - from) <= accuracy_.goal();
  }

  // Takes into account what is known at a time.
  void take(const Look& look, double end) {
    if (look.crossing && options_.margin == 0) return meet(look.time);
    note_distance(look.time, look.upper);
    if (look.lower > 0) {
      ahead_.push_back(look);
      connect(end);
    } else {
      upper_.undecided.add(look.time);
    }
  }
  // Times beyond a contact are of no use.
  void meet(double time) {
    upper_.crossing = std::min(upper_.crossing, time);
    std::erase_if(ahead_, [this](const Look& look) { return look.time > upper_.crossing; });
  }

  // Looks ahead that reach back to `lower_` raise it.
  void connect(double end) {
    while (!ahead_.empty()) {
      const Look& next = ahead_.back();
      const double lasts = speed_.time_for(next.lower), least = std::max(lower_, next.time);
      if (rounded_up(next.time - lasts) > lower_ && next.time > lower_) return;
      lower_ =
          std::clamp(rounded_down(next.time + lasts), least, std::max(least, std::min(end, upper_.crossing)));
      if (progress_.last) speed_.see(*progress_.last, next);
      progress_.add(next);
      ahead_.pop_back();
    }
  }

  // The next time to look at, from lower_ on.
  [[nodiscard]] double next_time(double end) const {
    const auto& [crossing, within, undecided] = upper_;
    if (!ahead_.empty()) {
      const double from = ahead_.back().time - speed_.time_for(ahead_.back().lower);
      return middle_of(lower_, undecided.first > lower_ ? std::min(undecided.first, from) : from);
    }
    if (crossing <= end && undecided.last < crossing &&
        undecided.first - lower_ < crossing - undecided.last) {
      return middle_of(std::max(lower_, undecided.last), crossing);
    }
    if (!progress_.last) return lower_;
    // The next look is to reach back to lower_ with a distance that shrinks as it did before.
    const double time = lower_ + speed_.likely_step(progress_.last->lower);
    double limit = std::min(crossing, undecided.first);
    if (within > lower_) limit = std::min(limit, within);
    return limit <= end ? std::min(time, middle_of(lower_, limit)) : std::min(time, end);
  }
  [[nodiscard]] static double middle_of(double from, double to) { return from + (to - from) / 2; }

  // To the end of a piece. False if there is an answer, or none can be found.
  bool cross_piece(double end) {
    for (narrow(end); lower_ < end; narrow(end)) {
      const double last = std::min(end, upper_.crossing);
      if (upper_.crossing <= end && short_enough(lower_, last)) return false;
      const bool blocked = upper_.undecided.count >= max_blocked;
      if (upper_.near() <= end && (short_enough(lower_, upper_.near()) || blocked)) {
        if (!probed_ && options_.prove_contact && options_.margin == 0 && find_crossing(last)) continue;
        if (upper_.crossing > end || blocked) return false;
      }
      if (work_.left() == 0) return false;
      if (!bodies_.deforms() && progress_.slow(lower_, last, accuracy_.goal()) && follow(last)) continue;
      const double before = lower_;
      const Look look = look_at(next_time(end), end);
      take(look, end);
      // Too slow to get anywhere.
      const bool slow = lower_ - before <= 0x1p-48 * std::max(1.0, before);
      if (look.lower > 0 && ahead_.empty() && slow) upper_.undecided.add(lower_);
    }
    return true;
  }

  // Follows pairs of nodes through time, while that gets on faster than looks did. True if that has raised lower_.
  bool follow(double end) {
    const double before = lower_, looked = progress_.first ? before - progress_.first->time : 0,
                 least = share_of_step * accuracy_.goal() / speed_.most();
    SweptPairs pairs(bodies_.swept(0), bodies_.swept(1), options_.margin, work_.stats);
    bool faster = true;
    for (std::uint64_t& most = progress_.allowance; faster && lower_ < end && work_.left() > 0; most *= 2) {
      const double begin = bodies_.begin(), from = lower_;
      const double until =
          pairs.clear(from - begin, end - begin, least, std::min(most, work_.left()), work_.monitor);
      work_.spent += pairs.spent();
      lower_ = until == end - begin ? end : std::max(from, rounded_down(begin + until));
      faster = lower_ - from > looked && pairs.spent() >= most;
    }
    if (upper_.undecided.first < lower_) upper_.undecided = {};
    connect(end);
    progress_.follow(lower_ >= end);
    return lower_ > before;
  }

  // A little after the surfaces have come near each other.
  bool find_crossing(double end) {
    probed_ = true;
    const std::optional<Look>& last = progress_.last;
    const double closing = speed_.share() * speed_.most();
    const double base = std::max(lower_, last ? last->time + last->likely() / closing : 0);
    accuracy_.resolution *= speed_.share();
    double step = 0.25 * accuracy_.goal() / speed_.most();
    for (int i = 0; i < max_probes; ++i, step *= 2) {
      const double time = std::min(base + step, end);
      if (probe(time)) {
        meet(time);
        upper_.undecided = {};
        return true;
      }
      if (time == end) return false;
    }
    return false;
  }

  // Nesting of solids whose surfaces turned out only later to be apart at first.
  void resolve_nesting() {
    if (!options_.solid || start_.outside.value_or(true) || lower_ == 0) return;
    start_.apart = true;
    start_.nested = start_.nest(bodies_, work_.monitor);
    if (start_.nested.inner) upper_.crossing = 0;
    if (start_.nested.inner || !start_.nested.certain) lower_ = 0;
  }

  // Is there no contact to the end?
  [[nodiscard]] bool over() const {
    return bodies_.duration() > 0 ? lower_ >= bodies_.duration() : start_.clear && start_.nested.certain;
  }

  TimeOfContact result() {
    resolve_nesting();
    TimeOfContact answer;
    answer.steps = work_.looks;
    if (upper_.crossing < INFINITY) {
      answer.verdict = Verdict::intersecting;
      answer.time = {std::min(lower_, upper_.crossing), upper_.crossing};
    } else if (upper_.within < INFINITY && !over()) {
      answer.verdict = Verdict::within;
      answer.time = {std::min(lower_, upper_.within), upper_.within};
    } else {
      answer.verdict = over() ? Verdict::separated : Verdict::undecided;
      answer.time = {lower_, INFINITY};
      answer.outcome = outcome_of(over(), work_.left() == 0);
    }
    if (answer.time.upper < INFINITY) {
      answer.outcome = outcome_of(short_enough(answer.time.lower, answer.time.upper), work_.left() == 0);
      set_witness(answer);
    }
    answer.stats = work_.stats;
    return answer;
  }

  void set_witness(TimeOfContact& answer) {
    if (options_.solid && start_.nested.inner) {
      answer.witness = start_.nested.witness();
      answer.contained = start_.nested.inner;
      return;
    }
    // Surfaces may have come within the tolerance in a piece before.
    const double time = answer.time.upper;
    if (time < bodies_.begin()) bodies_.enter_piece(static_cast<std::size_t>(time));
    const PlacesInTime at = bodies_.at(time);
    const Distance found = distance_at(at, {.monitor = &work_.monitor, .max_splits = work_.most_of_look()});
    if (options_.margin > 0 && found.distance.upper == 0) answer.verdict = Verdict::intersecting;
    answer.witness = found.witness;
    for (LimitPoint& point : *answer.witness) point.error = enlarged(point.error + at.doubt());
  }

  MovingPair bodies_;
  const TimeOfContactOptions& options_;
  Accuracy accuracy_{*options_.tolerance, bodies_.size()};
  Work work_;
  ClosingSpeed speed_;
  // At no time up to lower_ there is contact, or before it where it is 0 or an end of the answer.
  double lower_ = 0;
  UpperTimes upper_;
  std::vector<Look> ahead_;  // times without contact beyond lower_, the first one last
  Progress progress_;
  bool probed_ = false;  // for a crossing
  Start start_;
};

}  // namespace

TimeOfContact time_of_contact(const DeformingSurface& surface_a, const DeformingSurface& surface_b,
                              const TimeOfContactOptions& options, const Run& run) {
  const Workspace::Pieces::Pair pieces = workspace_of(run).pieces().of(surface_a.surface, surface_b.surface);
  const MovingBvh a{pieces.a.model(), pieces.a, surface_a.motion, surface_a.end},
      b{pieces.b.model(), pieces.b, surface_b.motion, surface_b.end};
  TimeOfContactOptions wanted = options;
  if (!wanted.tolerance) {
    wanted.tolerance = share_of_size(1e-3, a.model.surface().size(), b.model.surface().size());
  }
  require_length(*wanted.tolerance, "time of contact: the tolerance");
  require_length(wanted.margin, "time of contact: the margin");
  require_same_duration(a, b);
  if (options.solid) {
    static_cast<void>(a.model.solid());
    static_cast<void>(b.model.solid());
  }
  return FirstContactSearch(a, b, wanted, run).run();
}

TimeOfContact time_of_contact(const Surface& a, const Trajectory& motion_a, const Surface& b,
                              const Trajectory& motion_b, const TimeOfContactOptions& options,
                              const Run& run) {
  return time_of_contact({a, {}, motion_a}, {b, {}, motion_b}, options, run);
}

}  // namespace snug
