#include <snug/clearance.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include <snug/geometry/rounding.h>
#include <snug/query/moving_pair.h>
#include <snug/query/pair_queries.h>
#include <support/error.h>
#include <support/run.h>

namespace snug {
namespace {

constexpr double usual_absolute = 1e-3, usual_relative = 0.1;  // the former of the size
// Of the size: nothing narrower is asked for.
constexpr double min_share = 0x1p-36;
// What distances at the ends of a span may take of its precision.
constexpr double share_of_look = 0.25;
// A span in which surfaces move by less of its precision gains nothing by another look.
constexpr double share_of_way = 0.125;
// As for a time of contact: what a look costs besides its splits, and the part of the budget that none exceeds.
constexpr std::uint64_t cost_of_look = 1000, looks_of_budget = 16;
// Pairs of nodes are followed through a span of every third level that would take so many more looks.
constexpr int levels_between = 3;
constexpr double looks_too_many = 8;

// Bounds of the distance at one time, of the exact motion.
struct Look {
  double time = 0, lower = 0, upper = INFINITY;
};

struct Span {
  Look first, last;
  std::size_t piece = 0;
  double lower = 0;  // of the distance at all times from the first to the last look
  int level = 0;
  [[nodiscard]] double upper() const { return std::min(first.upper, last.upper); }
  [[nodiscard]] double duration() const { return rounded_up(last.time - first.time); }
};
// A heap has the span with the least lower end first, of equal ones the earliest.
bool comes_later(const Span& x, const Span& y) {
  return x.lower != y.lower ? x.lower > y.lower : x.first.time > y.first.time;
}

class ClearanceSearch {
 public:
  ClearanceSearch(const MovingBvh& a, const MovingBvh& b, const ClearanceOptions& options, const Run& run)
      : bodies_(a, b),
        options_(options),
        monitor_(monitor_of(run)),
        pieces_(static_cast<std::size_t>(std::max(1.0, bodies_.duration()))),
        budget_(run.max_splits.value_or(default_splits::time_of_contact)) {}

  Clearance run() {
    Look first = look_at(0, 0);
    if (bodies_.duration() == 0) {
      add({first, first});
    } else {
      for (std::size_t piece = 0; piece < pieces_; ++piece) {
        const Look last = look_at(piece, static_cast<double>(piece) + 1);
        speeds_.push_back(bodies_.speed());
        add({first, last, piece});
        first = last;
      }
      while (!open_.empty() && left() > 0) {
        std::pop_heap(open_.begin(), open_.end(), comes_later);
        const Span span = open_.back();
        open_.pop_back();
        if (!follow(span)) halve(span);
      }
    }
    return result();
  }

 private:
  [[nodiscard]] double precision(double upper) const {
    return std::max({*options_.absolute, *options_.relative * upper, min_share * size_});
  }
  [[nodiscard]] bool narrow_enough(const Span& span) const {
    return span.upper() - span.lower <= precision(span.upper());
  }
  // How far points move against each other in a span, rounded up.
  [[nodiscard]] double way(const Span& span) const {
    return speeds_.empty() ? 0 : enlarged(speeds_[span.piece] * span.duration());
  }
  [[nodiscard]] std::uint64_t whole_budget() const {
    const double whole = static_cast<double>(budget_) * static_cast<double>(pieces_);
    return whole < 0x1p62 ? budget_ * pieces_ : std::uint64_t{1} << 62;
  }
  [[nodiscard]] std::uint64_t left() const {
    const std::uint64_t whole = whole_budget(), done = spent_ + stats_.splits;
    return done < whole ? whole - done : 0;
  }

  // Bounds at a time, also of the least distance.
  Look look_at(std::size_t piece, double time) {
    enter(piece);
    ++steps_;
    spent_ += cost_of_look;
    const PlacesInTime at = bodies_.at(time);
    const Run run{.monitor = &monitor_, .max_splits = std::min(left(), budget_ / looks_of_budget)};
    const Distance found = distance(at.a, at.b,
                                    {.absolute = share_of_look * *options_.absolute,
                                     .relative = share_of_look * *options_.relative,
                                     .solid = options_.solid},
                                    run);
    stats_.box_tests += found.stats.box_tests;
    stats_.triangle_tests += found.stats.triangle_tests;
    stats_.evaluations += found.stats.evaluations;
    stats_.splits += found.stats.splits;
    const Look look{.time = time,
                    .lower = std::max(0.0, rounded_down(found.distance.lower - at.doubt())),
                    .upper = found.distance.upper == 0 ? 0 : enlarged(found.distance.upper + at.doubt())};
    if (steps_ == 1 || look.upper < answer_.distance.upper) {
      answer_.distance.upper = look.upper;
      answer_.time = time;
      answer_.witness = found.witness;
      for (LimitPoint& point : answer_.witness) point.error = enlarged(point.error + at.doubt());
      answer_.contained = found.contained;
    }
    return look;
  }
  void enter(std::size_t piece) {
    if (steps_ > 0 && piece == entered_) return;
    bodies_.enter_piece(piece);
    entered_ = piece;
  }

  // The distance shrinks by at most the way that points move since one look, and grows by it to the other one.
  void add(Span span) {
    const double fall = way(span), one = span.first.lower, other = span.last.lower;
    const double middle = rounded_down(rounded_down(one + other) - fall) / 2;
    span.lower =
        std::max({span.lower, rounded_down(middle), rounded_down(one - fall), rounded_down(other - fall)});
    if (narrow_enough(span)) return keep(span);
    open_.push_back(span);
    std::push_heap(open_.begin(), open_.end(), comes_later);
  }
  void keep(const Span& span) {
    closed_.push_back(span);
    kept_ += span.last.time - span.first.time;
    monitor_.report(std::min(1.0, kept_ / static_cast<double>(pieces_)));
  }

  // Looks where the bounds by both ends are least.
  void halve(const Span& span) {
    const double from = span.first.time, duration = span.last.time - from, speed = speeds_[span.piece];
    const double lean = speed > 0 ? (span.first.lower - span.last.lower) / (2 * speed) : 0;
    const double time = from + std::clamp(duration / 2 + lean, duration / 4, 3 * duration / 4);
    if (!(from < time && time < span.last.time) || way(span) <= share_of_way * precision(span.upper())) {
      stuck_ = true;
      return keep(span);
    }
    const Look middle = look_at(span.piece, time);
    add({span.first, middle, span.piece, span.lower, span.level + 1});
    add({middle, span.last, span.piece, span.lower, span.level + 1});
  }

  // Follows pairs of nodes through a span for as long as they are proved to stay as far apart as is asked for. True if
  // that has changed it.
  bool follow(const Span& span) {
    const double goal = span.upper() - precision(span.upper()) * (1 - 0x1p-30);
    const double looks = way(span) / precision(span.upper());
    if (bodies_.deforms() || span.level == 0 || span.level % levels_between != 0) return false;
    if (!(looks > looks_too_many) || !(span.first.lower > 0) || !(goal > 0)) return false;
    enter(span.piece);
    SweptPairs pairs(bodies_.swept(0), bodies_.swept(1), goal, stats_);
    const double begin = bodies_.begin(), from = span.first.time, to = span.last.time;
    const double allowance = 0.25 * std::min(looks, 1e9) * static_cast<double>(cost_of_look);
    const std::uint64_t splits = stats_.splits;
    const double until = pairs.clear(from - begin, to - begin, (to - from) / looks,
                                     std::min(left(), static_cast<std::uint64_t>(allowance)), monitor_);
    spent_ += pairs.spent() - (stats_.splits - splits);
    const double time = until == to - begin ? to : rounded_down(begin + until);
    if (!(time > from)) return false;
    if (time >= to) {
      Span done = span;
      done.lower = std::max(span.lower, goal);
      keep(done);
      return true;
    }
    const Look middle = look_at(span.piece, time);
    add({span.first, middle, span.piece, std::max(span.lower, goal), span.level + 1});
    add({middle, span.last, span.piece, span.lower, span.level + 1});
    return true;
  }

  Clearance result() {
    answer_.outcome = outcome_of(open_.empty() && !stuck_, left() == 0);
    closed_.insert(closed_.end(), open_.begin(), open_.end());
    std::sort(closed_.begin(), closed_.end(),
              [](const Span& x, const Span& y) { return x.first.time < y.first.time; });
    answer_.distance.lower = answer_.distance.upper;
    for (const Span& span : closed_) {
      answer_.distance.lower = std::min(answer_.distance.lower, span.lower);
      answer_.spans.push_back({{span.first.time, span.last.time}, {span.lower, span.upper()}});
    }
    answer_.steps = steps_;
    answer_.stats = stats_;
    return std::move(answer_);
  }

  MovingPair bodies_;
  const ClearanceOptions& options_;
  const WorkMonitor& monitor_;
  std::size_t pieces_;
  double size_ = bodies_.size();
  std::uint64_t budget_, spent_ = 0;  // without splits
  std::size_t entered_ = 0;
  int steps_ = 0;
  std::vector<double> speeds_;  // of each piece
  std::vector<Span> open_, closed_;
  double kept_ = 0;
  bool stuck_ = false;
  SearchStats stats_;
  Clearance answer_{};
};

}  // namespace

Clearance clearance(const DeformingSurface& surface_a, const DeformingSurface& surface_b,
                    const ClearanceOptions& options, const Run& run) {
  const Workspace::Pieces::Pair pieces = workspace_of(run).pieces().of(surface_a.surface, surface_b.surface);
  const MovingBvh a{pieces.a.model(), pieces.a, surface_a.motion, surface_a.end},
      b{pieces.b.model(), pieces.b, surface_b.motion, surface_b.end};
  ClearanceOptions wanted = options;
  if (!wanted.absolute && !wanted.relative) {
    wanted.absolute = share_of_size(usual_absolute, a.model.surface().size(), b.model.surface().size());
    wanted.relative = usual_relative;
  }
  wanted = with_precision(wanted, 0);
  require_same_duration(a, b);
  if (options.solid) {
    static_cast<void>(a.model.solid());
    static_cast<void>(b.model.solid());
  }
  return ClearanceSearch(a, b, wanted, run).run();
}

Clearance clearance(const Surface& a, const Trajectory& motion_a, const Surface& b,
                    const Trajectory& motion_b, const ClearanceOptions& options, const Run& run) {
  return clearance({a, {}, motion_a}, {b, {}, motion_b}, options, run);
}

}  // namespace snug
