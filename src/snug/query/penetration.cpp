#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <vector>

#include <snug/geometry/rounding.h>
#include <snug/query/closest.h>
#include <snug/query/pair_queries.h>
#include <snug/search/precision.h>
#include <support/direction.h>
#include <support/error.h>
#include <support/ordering.h>
#include <support/run.h>

namespace snug {
namespace {

// Steps in which a length is doubled until a translation separates, and halved towards the last that did not.
constexpr int doublings = 12, halvings = 5;
constexpr std::size_t max_descended = 4;  // of the best directions, along the normals of their contacts
constexpr int max_descents = 24;
// Steps of the search for a point deep in both solids, each of six neighbours, and how it shrinks.
constexpr int max_steps = 40;
constexpr double smallest_step = 1e-3;
// Where the precision is missed: lengths along each direction, up to twice the best one, at which ways through gaps
// and into holes may begin; and the most translations that are tried then.
constexpr double touching_share = 0x1p-28;
constexpr int lengths_tried = 16, max_tried = 4000;

struct Candidate {
  Vector3 translation;
  double length;
};

std::vector<Vector3> some_directions() {
  std::vector<Vector3> directions;
  for (const double x : {-1.0, 0.0, 1.0}) {
    for (const double y : {-1.0, 0.0, 1.0}) {
      for (const double z : {-1.0, 0.0, 1.0}) {
        if (const Vector3 d{x, y, z}; d != Vector3{}) directions.push_back(normalized(d));
      }
    }
  }
  return directions;
}

class PenetrationSearch {
 public:
  PenetrationSearch(const PlacedBvh& a, const PlacedBvh& b, const PenetrationOptions& options, const Run& run)
      : a_(a), b_(b), options_(options), run_(run), monitor_(monitor_of(run)) {}

  Penetration run() {
    Penetration answer;
    if (separated({})) return answer;
    shorten();
    const double below = deepest_common_balls();
    for (const Vector3& w : outward_) {
      if (const std::optional<double> t = shortest_along(w, 2 * best_.length)) descend({*t * w, *t});
    }
    if (best_.length - below > std::max(options_.relative * best_.length, min_width())) search_further();
    answer.translation = best_.translation;
    const double above = std::max(length_up(best_.translation), enlarged(length(best_.translation)));
    answer.depth = {std::min(below, above), above};
    const bool narrow = above - answer.depth.lower <= std::max(options_.relative * above, min_width());
    answer.outcome = outcome_of(narrow, budget_spent_ || splits_ >= max_splits());
    return answer;
  }

 private:
  [[nodiscard]] std::uint64_t max_splits() const {
    return run_.max_splits.value_or(default_splits::penetration);
  }
  void note(Outcome outcome) { budget_spent_ = budget_spent_ || outcome == Outcome::budget_spent; }
  // For one query of the search.
  [[nodiscard]] Run each() const { return {.monitor = &monitor_, .max_splits = max_splits()}; }
  // Of the exact difference of the poses' translations: its coordinates are each within a rounding of these.
  [[nodiscard]] double length_up(const Vector3& d) const {
    return enlarged(length((b_.pose.offset() + d) - b_.pose.offset()));
  }

  // Solids that touch have no relative precision.
  [[nodiscard]] double min_width() const {
    return share_of_size(touching_share, a_.model.surface().size(), b_.model.surface().size());
  }

  [[nodiscard]] PlacedBvh moved(const Vector3& d) const {
    return {b_.model, b_.scratch, b_.pose.with_offset(b_.pose.offset() + d)};
  }
  [[nodiscard]] bool separated(const Vector3& d) {
    monitor_.checkpoint();
    if (!is_finite(b_.pose.offset() + d)) return false;
    const CollideOptions options{.tolerance = 0, .solid = true};
    const Collision answer = collide(a_, moved(d), options, each());
    splits_ += answer.stats.splits;
    note(answer.outcome);
    ++tried_;
    return answer.verdict == Verdict::separated;
  }
  // How far apart the surfaces are after a translation, to shares of its length and of the distance.
  [[nodiscard]] Distance gap_after(const Candidate& at, double share, double relative) {
    const Distance gap = snug::distance(a_, moved(at.translation),
                                        {.absolute = share * at.length, .relative = relative}, each());
    note(gap.outcome);
    return gap;
  }

  void shorten() {
    const double reach = reach_of_both();
    std::vector<Candidate> found;
    for (const Vector3& w : some_directions()) {
      if (const std::optional<double> t = shortest_along(w, reach)) found.push_back({*t * w, *t});
    }
    if (found.empty()) {
      throw InputError(
          InputProblem::unrepresentable,
          "penetration: no translation that separates the solids fits doubles; scale the meshes down");
    }
    ordering::sort(found.data(), found.size(),
                   [](const Candidate& x, const Candidate& y) { return x.length < y.length; });
    found.resize(std::min(found.size(), max_descended));
    best_ = found[0];
    for (const Candidate& start : found) descend(start);
  }

  // A length that surely separates, but for roundings.
  [[nodiscard]] double reach_of_both() const {
    const Ball &ball_a = a_.model.ball(), &ball_b = b_.model.ball();
    const double between = distance(a_.pose.apply(ball_a.centre), b_.pose.apply(ball_b.centre));
    return 1.01 * (between + ball_a.radius + ball_b.radius);
  }

  // The first of some lengths along w that separates, made shorter. Nothing longer than the best is tried.
  std::optional<double> shortest_along(const Vector3& w, double reach) {
    double blocked = 0;
    for (int k = doublings; k >= 0; --k) {
      double free = std::ldexp(reach, -k);
      if (blocked >= 2 * best_.length) return std::nullopt;
      if (!separated(free * w)) {
        blocked = free;
        continue;
      }
      for (int i = 0; i < halvings; ++i) {
        const double middle = blocked + (free - blocked) / 2;
        (separated(middle * w) ? free : blocked) = middle;
      }
      if (free < best_.length) best_ = {free * w, free};
      return free;
    }
    return std::nullopt;
  }

  // Along the normal of the contact that a translation leaves, the shortest one that stays on its side of the
  // plane; where that is blocked, straight back.
  void descend(Candidate at) {
    for (int i = 0; i < max_descents; ++i) {
      const Distance gap = gap_after(at, 1e-3, 0.05);
      const Vector3 n = normalized(gap.witness[1].point - gap.witness[0].point);
      if (n == Vector3{}) return;
      const double along = dot(n, at.translation) - gap.distance.lower;
      const double before = at.length;
      for (const Vector3& next :
           {(1 + 1e-4) * std::max(along, 0.0) * n, at.translation - gap.distance.lower * n,
            (1 - 0.9 * gap.distance.lower / at.length) * at.translation, 0.98 * at.translation}) {
        const double shorter = length(next);
        if (!(shorter < at.length) || !separated(next)) continue;
        at = {next, shorter};
        if (shorter < best_.length) best_ = at;
        break;
      }
      if (!(at.length < (1 - 1e-3) * before)) return;
    }
  }

  // From places between others, such as holes: translations that separate although shorter ones along them may not.
  void search_further() {
    splits_ = 0;
    tried_ = 0;
    const std::vector<Vector3> directions = some_directions();
    std::vector<Candidate> starts;
    for (const Vector3& w : directions) {
      bool before = false;
      for (int k = 1; k < lengths_tried && may_go_on(); ++k) {
        const double length = 2 * best_.length * k / lengths_tried;
        const bool now = separated(length * w);
        if (now && !before) starts.push_back({length * w, length});
        before = now;
      }
    }
    ordering::sort(starts.data(), starts.size(),
                   [](const Candidate& x, const Candidate& y) { return x.length < y.length; });
    for (const Candidate& start : starts) shorten_by_steps(start, directions);
  }
  [[nodiscard]] bool may_go_on() const { return tried_ < max_tried && splits_ < max_splits(); }

  // To a translation that no step in any of the directions makes shorter.
  void shorten_by_steps(Candidate at, const std::vector<Vector3>& directions) {
    for (double step = at.length / 2; step > smallest_step * best_.length && may_go_on();) {
      const double before = at.length;
      for (const Vector3& w : directions) {
        const Vector3 next = at.translation + step * w;
        if (length(next) < at.length && separated(next)) at = {next, length(next)};
      }
      if (at.length == before) step /= 2;
    }
    if (at.length < best_.length) best_ = at;
    descend(at);
  }

  // The sum of the radii of two balls around one point, each in one of the solids.
  double depth_at(const Point3& local) {
    const Precision precision{.absolute = {}, .relative = 0.02};
    const Point3 world = a_.pose.apply(local);
    const Motion back = b_.pose.inverse();
    const Point3 other = back.apply(world);
    // How far `other` may be from the exact preimage of the exact image of `local`, measured forwards.
    const Point3 again = b_.pose.apply(other);
    const double magnitude = max_abs(local - Point3{}) + max_abs(other - Point3{}) +
                             max_abs(a_.pose.offset()) + max_abs(b_.pose.offset());
    const double off =
        spatial_error(max_abs(again - world) + 64 * unit_roundoff * magnitude + 8 * underflow_error);
    const SignedDistance in_a = signed_distance(a_.scratch, local, precision, each());
    const SignedDistance in_b = signed_distance(b_.scratch, other, precision, each());
    // A motion shrinks lengths by at most its defect.
    const double radius_a = -in_a.distance.upper * (1 - 2 * a_.pose.defect()),
                 radius_b = -in_b.distance.upper * (1 - 2 * b_.pose.defect()) - off;
    guide_ = std::min(-in_a.distance.lower, -in_b.distance.lower);
    const Vector3 from_a = a_.pose.rotate(in_a.nearest.point - local),
                  to_b = b_.pose.rotate(other - in_b.nearest.point);
    ways_out_ = {from_a, to_b};
    return radius_a > 0 && radius_b > 0 ? (radius_a + radius_b) * (1 - 16 * unit_roundoff) : 0;
  }

  // Looks for a point deep in both, from the middle of what the found translation has to clear.
  double deepest_common_balls() {
    double best = 0;
    for (const Point3& start : starts()) {
      Point3 at = start;
      double step = best_.length, deepest = depth_at(at), guide = guide_;
      for (int i = 0; i < max_steps && step > smallest_step * best_.length; ++i) {
        bool better = false;
        for (std::size_t axis = 0; axis < 3 && !better; ++axis) {
          for (const double side : {-step, step}) {
            Point3 next = at;
            next[axis] += side;
            const double depth = depth_at(next);
            if (!(depth > deepest || (deepest == 0 && guide_ > guide))) continue;
            at = next;
            deepest = depth;
            guide = guide_;
            better = true;
            break;
          }
        }
        if (!better) step /= 2;
      }
      if (!(deepest > best)) continue;
      best = deepest;
      static_cast<void>(depth_at(at));
      outward_.clear();
      for (const Vector3& way : ways_out_) {
        if (const Vector3 n = normalized(way); n != Vector3{}) outward_.push_back(n);
      }
    }
    return best;
  }

  // Points of A's frame that may lie in both: where the surfaces touch once they are separated, half the way
  // back, and the middles of both.
  std::vector<Point3> starts() {
    const Distance gap = gap_after(best_, 1e-2, 0.1);
    const Motion back = a_.pose.inverse();
    const Point3 touch = gap.witness[0].point - 0.5 * best_.translation;
    return {back.apply(touch), back.apply(b_.pose.apply(b_.model.ball().centre)), a_.model.ball().centre};
  }

  const PlacedBvh &a_, &b_;
  const PenetrationOptions& options_;
  Run run_;
  const WorkMonitor& monitor_;
  Candidate best_{{}, INFINITY};
  std::uint64_t splits_ = 0;  // of translations tried
  int tried_ = 0;
  bool budget_spent_ = false;  // by one of the queries
  // For the last point of depth_at(): its depth in the shallower solid, negative outside;
  // from it to the surface of A, and to it from that of B.
  double guide_ = 0;
  std::array<Vector3, 2> ways_out_;
  std::vector<Vector3> outward_;  // directions of the same, of the deepest point
};

}  // namespace

Penetration penetration(const PlacedSurface& a, const PlacedSurface& b, const PenetrationOptions& options,
                        const Run& run) {
  const PlacedPair at(a, b, workspace_of(run));
  require_length(options.relative, "penetration: the precision");
  return PenetrationSearch(at.a, at.b, options, run).run();
}

}  // namespace snug
