#include <algorithm>
#include <cmath>
#include <optional>
#include <vector>

#include <snug/geometry/rounding.h>
#include <snug/query/moving_body.h>
#include <snug/query/nesting.h>
#include <snug/query/pair_queries.h>
#include <snug/query/swept_pairs.h>
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
  double lower = 0, upper = INFINITY;  // of the distance
  bool crossing = false;
  // The likely distance: points found are mostly the nearest ones.
  [[nodiscard]] double likely() const { return upper < INFINITY ? upper : lower; }
};

// The first contact during one piece of both motions, and what came before.
class FirstContactSearch {
 public:
  FirstContactSearch(const MovingBvh& a, const MovingBvh& b, const TimeOfContactOptions& options,
                     const Run& run)
      : body_{MovingBody(a), MovingBody(b)},
        options_(options),
        monitor_(monitor_of(run)),
        max_splits_(run.max_splits.value_or(default_splits::time_of_contact)),
        tolerance_(*options.tolerance),
        size_(share_of_size(1, a.model.surface().size(), b.model.surface().size())),
        duration_(std::max(body_[0].duration(), body_[1].duration())) {
    resolution_ = std::max(share_of_tolerance * tolerance_, min_resolution * size_);
  }

  TimeOfContact run() {
    enter_piece(0);
    if (!start()) {
      for (std::size_t piece = 0; static_cast<double>(piece) < duration_; ++piece) {
        if (piece > 0) enter_piece(piece);
        if (!cross_piece(static_cast<double>(piece) + 1)) break;
      }
    }
    return result();
  }

 private:
  void enter_piece(std::size_t piece) {
    place_in_piece(piece);
    find_speed();
    spent_ = 0;
    looks_in_piece_ = 0;
    looks_before_ = 0;
    began_.reset();
    ahead_.clear();
    last_.reset();
    closing_ = 1;
  }

  void place_in_piece(std::size_t piece) {
    first_ = static_cast<double>(piece);
    for (MovingBody& body : body_) body.enter_piece(piece);
  }

  void find_speed() {
    MovingBody &a = body_[0], &b = body_[1];
    if (a.deforms() || b.deforms()) {
      linear_ = {a.linear_patches(), b.linear_patches()};
      if (linear_[0] && linear_[1]) {
        speed_ = 0;
        narrow(first_ + 1);
        return;
      }
      linear_ = {};
    }
    speed_ = enlarged(a.speed() + b.speed());
    if (!a.deforms() && !b.deforms() && a.piece().straight() && b.piece().straight()) {
      speed_ = std::min(speed_, PieceMotion::relative_speed(a.piece(), a.model(), b.piece(), b.model()));
    }
  }

  // Where all patches go along lines, only those count that may meet from lower_ on.
  void narrow(double end) {
    const double to = std::min(end, crossing_);
    if (!linear_[0] || !linear_[1] || narrowed_ == Interval(lower_, to)) return;
    narrowed_ = {lower_, to};
    const std::optional<double> speed =
        LinearPatches::meeting_speed(*linear_[0], *linear_[1], lower_ - first_, to - first_);
    if (!speed) {
      speed_ = 0;
      lower_ = to;
      return;
    }
    if (speed_ > 0 && *speed > 0) closing_ = std::min(1.0, closing_ * speed_ / *speed);
    speed_ = *speed;
  }

  // Both as doubles, with what these are off by where the surfaces may meet.
  struct Places {
    PlacedBvh a, b;
    [[nodiscard]] double doubt() const { return a.deviation + b.deviation; }
  };
  [[nodiscard]] Places places_at(double time) {
    const double s = time - first_;  // exact: both are at most a factor of 2 apart, or first_ is 0
    const MovingBody::Place a = body_[0].at(s), b = body_[1].at(s);
    const Ball &ball_a = a.shape.model.ball(), &ball_b = b.shape.model.ball();
    // A common point is at most so far from the origin of either surface, and so are all its own.
    const double between = distance(a.pose.pose.apply(ball_a.centre), b.pose.pose.apply(ball_b.centre));
    const double beyond = 2 * (between + ball_a.radius + ball_b.radius + a.shape.error + b.shape.error);
    const double reach_a = enlarged(max_abs(ball_a.centre - Point3{}) + ball_a.radius + beyond),
                 reach_b = enlarged(max_abs(ball_b.centre - Point3{}) + ball_b.radius + beyond);
    return {{a.shape.model, a.shape.scratch, a.pose.pose, a.deviation(reach_a)},
            {b.shape.model, b.shape.scratch, b.pose.pose, b.deviation(reach_b)}};
  }

  void count(const SearchStats& stats) {
    stats_.box_tests += stats.box_tests;
    stats_.triangle_tests += stats.triangle_tests;
    stats_.evaluations += stats.evaluations;
    stats_.splits += stats.splits;
    spent_ += stats.splits;
  }
  void count_look() {
    ++looks_;
    ++looks_in_piece_;
    spent_ += cost_of_look;
  }
  // Of the budget.
  [[nodiscard]] std::uint64_t left() const { return spent_ < max_splits_ ? max_splits_ - spent_ : 0; }
  [[nodiscard]] Run for_look() const {
    return {.monitor = &monitor_, .max_splits = std::min(left(), max_splits_ / looks_of_budget)};
  }

  // Is the surfaces' distance at that time enough for all that is left of the piece?
  [[nodiscard]] bool far_enough(const Places& at, double time, double end, Look& look) const {
    const double gap = root_gap(at.a, at.b, INFINITY) * (1 - 4 * unit_roundoff) - at.doubt();
    if (!(gap > enlarged(speed_ * (end - time)))) return false;
    look.lower = gap;
    return true;
  }

  Look look_at(double time, double end) {
    monitor_.report(time / std::max(duration_, 1.0));
    count_look();
    const Places at = places_at(time);
    Look look{.time = time};
    if (far_enough(at, time, end, look)) return look;
    const DistanceOptions wanted{.absolute = resolution_, .relative = relative};
    const Distance found = distance(at.a, at.b, wanted, for_look());
    count(found.stats);
    look.crossing = found.distance.upper == 0;
    look.lower = std::max(0.0, rounded_down(found.distance.lower - at.doubt()));
    look.upper = look.crossing ? 0 : enlarged(found.distance.upper + at.doubt());
    return look;
  }

  // Tries to prove contact at a time, by a crossing or by a point of one surface inside of the other one that
  // was not inside at the beginning.
  bool probe(double time) {
    monitor_.checkpoint();
    count_look();
    const Places at = places_at(time);
    const CollideOptions wanted{.tolerance = 0, .witness = WitnessKind::none, .prove_contact = true};
    const Collision found = collide(at.a, at.b, wanted, for_look());
    count(found.stats);
    if (found.verdict == Verdict::intersecting) return true;
    if (enlarged(found.distance.upper + at.doubt()) <= tolerance_) within_ = std::min(within_, time);
    return found.verdict != Verdict::separated && (options_.solid || outside()) &&
           common_point(at.a, at.b, monitor_).inner.has_value();
  }

  // Are closed surfaces known to be outside of each other at time 0? Then one that has a point inside of the
  // other one later has met it. Asked only where no crossing is found.
  bool outside() {
    if (!outside_) {
      const auto closed = [](const MovingBody& body) { return is_closed(body.model().surface()); };
      outside_ = apart_ && closed(body_[0]) && closed(body_[1]);
      if (*outside_) {
        const Nesting found = nesting_at_start();
        outside_ = !found.inner && found.certain;
      }
    }
    return *outside_;
  }
  [[nodiscard]] Nesting nesting_at_start() const {
    return apart_ ? nesting(body_[0].at_start(), body_[1].at_start(), monitor_)
                  : common_point(body_[0].at_start(), body_[1].at_start(), monitor_);
  }

  // At time 0. True if that is the answer.
  bool start() {
    const double clear = lower_;
    const Look look = look_at(0, duration_ > 0 ? 1 : 0);
    apart_ = look.lower > 0 || clear > 0;
    if (options_.solid && !look.crossing) {
      inside_ = nesting_at_start();
      if (inside_.inner) {
        crossing_ = 0;
        return true;
      }
      if (apart_ && !inside_.certain) {
        lower_ = 0;  // of the surfaces it may be known to be later
        return true;
      }
      outside_ = apart_;
    }
    take(look, duration_ > 0 ? 1 : 0);
    if (duration_ == 0) over_ = apart_;
    return look.crossing || duration_ == 0;
  }

  // How long a distance lasts, rounded down.
  [[nodiscard]] double time_for(double distance) const {
    if (speed_ == 0) return distance > 0 ? INFINITY : 0;
    return std::max(0.0, rounded_down(rounded_down(distance / speed_)));
  }
  // Is the time between two so short that it is not worth making shorter?
  [[nodiscard]] bool short_enough(double from, double to) const {
    return from >= to || enlarged(speed_ * (to - from)) <= goal();
  }
  [[nodiscard]] double goal() const { return std::max(tolerance_, 8 * min_resolution * size_); }

  // Takes into account what is known at a time.
  void take(const Look& look, double end) {
    if (look.crossing) {
      meet(look.time);
      return;
    }
    if (look.upper <= tolerance_) within_ = std::min(within_, look.time);
    if (look.lower > 0) {
      ahead_.push_back(look);
      connect(end);
    } else {
      block(look.time);
    }
  }
  // Times beyond a contact are of no use.
  void meet(double time) {
    crossing_ = std::min(crossing_, time);
    std::erase_if(ahead_, [this](const Look& look) { return look.time > crossing_; });
  }
  void block(double time) {
    blocked_ = std::min(blocked_, time);
    blocked_to_ = std::max(blocked_to_, time);
    ++blocks_;
  }

  // Looks ahead that reach back to `lower_` raise it.
  void connect(double end) {
    while (!ahead_.empty()) {
      const Look& next = ahead_.back();
      const double last = time_for(next.lower);
      if (rounded_up(next.time - last) > lower_ && next.time > lower_) return;
      lower_ = std::clamp(rounded_down(next.time + last), std::max(lower_, next.time),
                          std::max({lower_, next.time, std::min(end, crossing_)}));
      if (last_ && last_->time < next.time && speed_ > 0) {
        const double share = (last_->likely() - next.likely()) / (next.time - last_->time) / speed_;
        closing_ = std::clamp(share, 0.0, 1.0);
      }
      last_ = next;
      if (!began_) began_ = next;
      ahead_.pop_back();
    }
  }

  // The next time to look at, from lower_ on.
  [[nodiscard]] double next_time(double end) const {
    if (!ahead_.empty()) {
      const double from = ahead_.back().time - time_for(ahead_.back().lower);
      return middle_of(lower_, blocked_ > lower_ ? std::min(blocked_, from) : from);
    }
    if (crossing_ <= end && blocked_to_ < crossing_ && blocked_ - lower_ < crossing_ - blocked_to_) {
      return middle_of(std::max(lower_, blocked_to_), crossing_);
    }
    if (!last_) return lower_;
    // The next look is to reach back to lower_ with a distance that shrinks as it did before.
    const double time = lower_ + reach_share * time_for(last_->lower) * (1 - closing_) / (1 + closing_);
    double limit = std::min(crossing_, blocked_);
    if (within_ > lower_) limit = std::min(limit, within_);
    return limit <= end ? std::min(time, middle_of(lower_, limit)) : std::min(time, end);
  }
  [[nodiscard]] static double middle_of(double from, double to) { return from + (to - from) / 2; }

  // To the end of a piece. False if there is an answer, or none can be found.
  bool cross_piece(double end) {
    for (narrow(end); lower_ < end; narrow(end)) {
      if (crossing_ <= end && short_enough(lower_, crossing_)) return false;
      const double near = std::min(within_, blocked_);
      if (near <= end && (short_enough(lower_, near) || blocks_ >= max_blocked)) {
        if (!probed_ && options_.prove_contact && find_crossing(std::min(end, crossing_))) continue;
        if (crossing_ > end || blocks_ >= max_blocked) return false;
      }
      if (left() == 0) return false;
      if (slow(std::min(end, crossing_)) && follow(std::min(end, crossing_))) continue;
      const double before = lower_;
      const Look look = look_at(next_time(end), end);
      take(look, end);
      // Too slow to get anywhere.
      const bool slow = lower_ - before <= 0x1p-48 * std::max(1.0, before);
      if (look.lower > 0 && ahead_.empty() && slow) block(lower_);
    }
    if (end == duration_) over_ = true;
    return true;
  }

  // Will looks take many more, if time goes on and the distance shrinks as since the first of these?
  [[nodiscard]] bool slow(double end) const {
    if (body_[0].deforms() || body_[1].deforms() || looks_in_piece_ < patience_ || !began_) return false;
    if (patience_ <= 1) return true;
    const double looks = looks_in_piece_ - looks_before_, near = last_->likely();
    const double shrunk = std::log(began_->likely() / near),
                 to_shrink = std::log(std::max(near / goal(), 1.0));
    return looks * (end - lower_) > looks_too_many * (lower_ - began_->time) &&
           looks * to_shrink > looks_too_many * shrunk;
  }

  // Follows pairs of nodes through time, while that gets on faster than looks did. True if that has raised lower_.
  bool follow(double end) {
    const double before = lower_, looked = began_ ? before - began_->time : 0,
                 least = share_of_step * goal() / speed_;
    SweptPairs pairs({body_[0].model(), body_[0].scratch(), body_[0].piece()},
                     {body_[1].model(), body_[1].scratch(), body_[1].piece()}, stats_);
    bool faster = true;
    for (; faster && lower_ < end && left() > 0; allowance_ *= 2) {
      const double from = lower_, until = pairs.clear(from - first_, end - first_, least,
                                                      std::min(allowance_, left()), monitor_);
      spent_ += pairs.spent();
      lower_ = until == end - first_ ? end : std::max(from, rounded_down(first_ + until));
      faster = lower_ - from > looked && pairs.spent() >= allowance_;
    }
    if (blocked_ < lower_) {
      blocked_ = INFINITY;
      blocked_to_ = 0;
      blocks_ = 0;
    }
    connect(end);
    began_.reset();
    looks_before_ = looks_in_piece_;
    patience_ = lower_ >= end ? 1 : std::max(2 * looks_in_piece_, first_patience);
    return lower_ > before;
  }

  // A little after the surfaces have come near each other.
  bool find_crossing(double end) {
    probed_ = true;
    const double closing = std::max(closing_, least_share) * speed_;
    const double base = std::max(lower_, last_ ? last_->time + last_->likely() / closing : 0);
    resolution_ = std::max(resolution_ * std::clamp(closing_, least_share, 1.0), min_resolution * size_);
    double step = 0.25 * goal() / speed_;
    for (int i = 0; i < max_probes; ++i, step *= 2) {
      const double time = std::min(base + step, end);
      if (probe(time)) {
        meet(time);
        blocked_ = INFINITY;
        blocked_to_ = 0;
        blocks_ = 0;
        return true;
      }
      if (time == end) return false;
    }
    return false;
  }

  // Nesting of solids whose surfaces turned out only later to be apart at first.
  void resolve_nesting() {
    if (!options_.solid || outside_.value_or(true) || lower_ == 0) return;
    inside_ = nesting(body_[0].at_start(), body_[1].at_start(), monitor_);
    if (inside_.inner) crossing_ = 0;
    if (!inside_.inner && inside_.certain) return;
    lower_ = 0;
    over_ = false;
  }

  TimeOfContact result() {
    resolve_nesting();
    TimeOfContact answer;
    answer.steps = looks_;
    if (crossing_ < INFINITY) {
      answer.verdict = Verdict::intersecting;
      answer.time = {std::min(lower_, crossing_), crossing_};
    } else if (within_ < INFINITY && !over_) {
      answer.verdict = Verdict::within;
      answer.time = {std::min(lower_, within_), within_};
    } else {
      answer.verdict = over_ ? Verdict::separated : Verdict::undecided;
      answer.time = {over_ ? duration_ : lower_, INFINITY};
      answer.outcome = outcome_of(over_, left() == 0);
    }
    if (answer.time.upper < INFINITY) {
      answer.outcome = outcome_of(short_enough(answer.time.lower, answer.time.upper), left() == 0);
      set_witness(answer);
    }
    answer.stats = stats_;
    return answer;
  }

  void set_witness(TimeOfContact& answer) {
    // Surfaces may have come within the tolerance in a piece before.
    if (answer.time.upper < first_) place_in_piece(static_cast<std::size_t>(answer.time.upper));
    const Places at = places_at(answer.time.upper);
    if (options_.solid && inside_.inner) {
      answer.witness = inside_.witness();
      answer.contained = inside_.inner;
      return;
    }
    const Distance found = distance(at.a, at.b, {.absolute = resolution_, .relative = relative},
                                    {.monitor = &monitor_, .max_splits = max_splits_ / looks_of_budget});
    count(found.stats);
    answer.witness = found.witness;
    for (LimitPoint& point : *answer.witness) point.error = enlarged(point.error + at.doubt());
  }

  std::array<MovingBody, 2> body_;
  const TimeOfContactOptions& options_;
  const WorkMonitor& monitor_;
  std::uint64_t max_splits_;
  double tolerance_, size_, duration_;
  double first_ = 0;  // time at which the piece begins
  // Upper bound, of any two points against each other that may be in one place from lower_ on.
  double speed_ = 0;
  std::array<std::optional<LinearPatches>, 2> linear_;  // both or none
  Interval narrowed_{-1, -1};                           // the times that speed_ is of, if they are
  double resolution_ = 0;
  // At no time up to lower_ there is contact, or before it where it is 0 or an end of the answer.
  double lower_ = 0;
  // The first times known with contact at or before, within the tolerance, and undecided.
  double crossing_ = INFINITY, within_ = INFINITY, blocked_ = INFINITY;
  double blocked_to_ = 0;     // the last of these
  std::vector<Look> ahead_;   // times without contact beyond lower_, the first one last
  std::optional<Look> last_;  // the last one that raised it
  double closing_ = 1;        // share of speed_ at which the distance shrank
  int looks_ = 0, looks_in_piece_ = 0, blocks_ = 0;
  int patience_ = first_patience;              // looks in a piece before follow()
  std::uint64_t spent_ = 0;                    // of the budget, in this piece
  std::uint64_t allowance_ = first_allowance;  // of it, for follow()
  std::optional<Look> began_;  // the first one that raised lower_, in this piece or since follow(),
  int looks_before_ = 0;       // and looks in the piece before
  bool probed_ = false, over_ = false;
  bool apart_ = false;           // at first, as surfaces
  std::optional<bool> outside_;  // of outside(), once known
  Nesting inside_;               // at first, with solids
  SearchStats stats_;
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
  const double ends_a = a.motion.duration(), ends_b = b.motion.duration();
  const bool deforms = !a.end.empty() || !b.end.empty();
  const double ends = std::max({ends_a, ends_b, deforms ? 1.0 : 0.0});
  require_value((ends_a == ends || ends_a == 0) && (ends_b == ends || ends_b == 0) && (!deforms || ends == 1),
                "time of contact: the motions last for different times; give both the same number of pieces, "
                "and one where control points move");
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
