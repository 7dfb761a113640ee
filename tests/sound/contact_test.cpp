// The promises of collide: every verdict and every bound, on placements that graze, nest, share boundaries or
// lie a hair apart, against what is known of them and against a twin that refines by itself.
//
//   SNUG_PLACEMENTS=1000000 build/release/bin/tests/sound_test --gtest_filter=contact.verdicts_and_bounds_are_true
//
// runs a million, in some forty minutes on one core; progress goes to standard error. SNUG_FIRST=N begins
// with trial N: with SNUG_PLACEMENTS=1 one that failed alone, and SNUG_DUMP=FOLDER writes its meshes there.
// SNUG_SHOW=1 names what stayed undecided.

#include <snug/collide.h>
#include <snug/search/surface_data.h>
#include <snug/search/winding.h>

#include <gtest/gtest.h>
#include <testing/contact_trials.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <iostream>
#include <map>

#include "testing/verdict_only.h"

namespace snug::contact_test {
namespace {

using oracle::ContactBounds;
using oracle::ContactGoal;
using oracle::Point;
using testing::Contestants;
using testing::Trial;

constexpr int max_failures = 20;

/// A reply in twin units.
struct Reply {
  Verdict verdict;
  double lower;
  std::optional<double> upper;
  std::optional<std::array<Point, 2>> witness;
  double witness_error;
  std::optional<std::size_t> inner;
};

class Checks {
 public:
  /// False once too much has failed.
  bool run(Trial& trial) {
    trial_ = &trial;
    pair_ = trial.pair;
    CollideOptions options = testing::verdict_only();
    options.tolerance = pair_->scaled(trial.tolerance);
    options.margin = pair_->scaled(trial.margin);
    const Run effort{.max_splits = trial.budget};
    options.prove_contact = trial.prove_contact;
    options.solid = trial.solid;
    const auto start = std::chrono::steady_clock::now();
    const Collision answer = collide(pair_->placed(0, trial.a), pair_->placed(1, trial.b), options, effort);
    const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    asked_ += seconds;
    if (seconds > slowest_) slowest_ = seconds, slowest_trial_ = trial.number;
    reply_ = {
        answer.verdict,
        pair_->back(answer.distance.lower),
        {},
        {},
        pair_->back(answer.witness ? std::max((*answer.witness)[0].error, (*answer.witness)[1].error) : 0),
        answer.contained};
    if (std::isfinite(answer.distance.upper)) reply_.upper = pair_->back(answer.distance.upper);
    if (answer.witness)
      reply_.witness = {pair_->back((*answer.witness)[0].point), pair_->back((*answer.witness)[1].point)};
    ++counts_[trial.family][static_cast<std::size_t>(reply_.verdict)];
    seconds_[trial.family] += seconds;
    ++total_;
    check_itself();
    check_what_is_known();
    if (trial.number % 16 == 5) check_same(options, effort, answer);
    // Of what is known, every fourth trial.
    if (!trial.truth.whole() || trial.number % 4 == 0) check_with_twin();
    if (trial.solid) check_solids();
    if (trial.truth.crossing && trial.tolerance == 0 && trial.budget >= 1000) {
      ++crossing_;
      crossing_undecided_ += reply_.verdict == Verdict::undecided;
    }
    if (reply_.verdict == Verdict::undecided && (trial.truth.crossing || !trial.hair)) {
      ++missed_;
      if (std::getenv("SNUG_SHOW")) std::cerr << "undecided: " << testing::describe(trial) << '\n';
    }
    // A third of the trials, and others by chance.
    if (trial.family == "pulled") {
      ++pulled_;
      between_ +=
          reply_.verdict == Verdict::within || (reply_.lower > 0 && reply_.lower <= 2 * trial.tolerance);
    }
    return failures_ < max_failures;
  }

  void report() const {
    constexpr const char* names[] = {"separated", "within", "intersecting", "undecided"};
    std::printf("%zu placements, of which %zu were moved to between half and twice the tolerance\n", total_,
                pulled_);
    for (const auto& [family, counts] : counts_) {
      std::printf("  %s:", family.c_str());
      for (std::size_t v = 0; v < 4; ++v) std::printf("  %s %zu", names[v], counts[v]);
      std::printf(
          "  (%.2f ms each)\n",
          1e3 * seconds_.at(family) / static_cast<double>(counts[0] + counts[1] + counts[2] + counts[3]));
    }
    std::printf("  undecided on transversal contacts at tolerance 0: %zu of %zu (%.2f %%)\n",
                crossing_undecided_, crossing_,
                100.0 * static_cast<double>(crossing_undecided_) /
                    static_cast<double>(std::max<std::size_t>(crossing_, 1)));
    std::printf(
        "  undecided on these at any tolerance, or on others that are not a hair apart: %zu;\n"
        "  within 1 %% not found with a budget of 2000: %zu\n",
        missed_, more_undecided_);
    std::printf(
        "  collide %.3f ms each, slowest %.0f ms (trial %llu); %zu interrupted; the twin left %zu open\n",
        1e3 * asked_ / static_cast<double>(total_), 1e3 * slowest_,
        static_cast<unsigned long long>(slowest_trial_), interrupted_, open_);
    std::fflush(stdout);
  }
  [[nodiscard]] std::size_t crossing() const { return crossing_; }
  [[nodiscard]] std::size_t crossing_undecided() const { return crossing_undecided_; }
  [[nodiscard]] std::size_t open() const { return open_; }

 private:
  void expect(bool holds, const char* claim, double found = 0, double bound = 0) {
    if (holds) return;
    ++failures_;
    char numbers[80];
    std::snprintf(numbers, sizeof numbers, " (%.17g, %.17g)", found, bound);
    ADD_FAILURE() << claim << numbers << ": " << name_of(reply_.verdict) << ' ' << reply_.lower << ' '
                  << reply_.upper.value_or(-1) << "; " << testing::describe(*trial_);
  }

  void check_itself() {
    const Trial& t = *trial_;
    expect(reply_.lower >= 0 && std::isfinite(reply_.lower), "lower is a length", reply_.lower);
    if (reply_.upper)
      expect(reply_.lower <= *reply_.upper, "lower is at most upper", reply_.lower, *reply_.upper);
    expect(reply_.upper.has_value() == reply_.witness.has_value(), "an upper bound comes with witnesses");
    switch (reply_.verdict) {
      case Verdict::separated:
        expect(reply_.lower > t.margin || (t.margin == 0 && reply_.lower >= 0),
               "separated: lower exceeds the margin", reply_.lower, t.margin);
        break;
      case Verdict::within:
        expect(reply_.upper && *reply_.upper <= (t.margin + t.tolerance) * (1 + 1e-15),
               "within: upper is at most what was asked", reply_.upper.value_or(-1), t.margin + t.tolerance);
        break;
      case Verdict::intersecting:
        expect(reply_.lower == 0 || t.solid, "intersecting: nothing is between them", reply_.lower);
        break;
      case Verdict::undecided:
        break;
    }
    if (reply_.witness && reply_.verdict != Verdict::intersecting) {
      // The surfaces are only as far apart as the points that the witnesses stand for.
      const double between = distance_of((*reply_.witness)[0], (*reply_.witness)[1]);
      expect(between <= *reply_.upper * (1 + 1e-12) + rounding(), "the witnesses are at most upper apart",
             between, *reply_.upper);
    }
  }

  /// No answer depends on what was asked before, nor on a question that was interrupted.
  void check_same(const CollideOptions& options, const Run& effort, const Collision& answer) {
    const PlacedSurface a = pair_->placed(0, trial_->a), b = pair_->placed(1, trial_->b);
    Workspace empty;
    const std::atomic<bool> stop = true;
    const WorkMonitor monitor{{}, &stop};
    try {
      (void)collide(a, b, options,
                    {.monitor = &monitor, .workspace = &empty, .max_splits = effort.max_splits});
    } catch (const Interrupted&) {
      ++interrupted_;
    }
    const Collision fresh = collide(a, b, options, {.workspace = &empty, .max_splits = effort.max_splits});
    expect(fresh.verdict == answer.verdict && fresh.distance.lower == answer.distance.lower &&
               fresh.distance.upper == answer.distance.upper && fresh.witness == answer.witness &&
               fresh.outcome == answer.outcome && fresh.stats.splits == answer.stats.splits,
           "the same answer from fresh scratch memory", pair_->back(fresh.distance.lower),
           std::isfinite(fresh.distance.upper) ? pair_->back(fresh.distance.upper) : -1);
  }

  void check_what_is_known() {
    const Trial& t = *trial_;
    const testing::Truth& truth = t.truth;
    expect(reply_.lower <= truth.upper, "lower is at most the distance", reply_.lower, truth.upper);
    if (reply_.upper && !reply_.inner)
      expect(*reply_.upper >= truth.lower, "upper is at least the distance", *reply_.upper, truth.lower);
    if (truth.meet) {
      expect(reply_.verdict != Verdict::separated, "false separated");
      expect(reply_.lower == 0, "a common point leaves no lower bound", reply_.lower);
    }
    if (truth.apart && !t.solid) expect(reply_.verdict != Verdict::intersecting, "false intersecting");
    if (truth.upper <= t.margin)
      expect(reply_.verdict != Verdict::separated, "false separated, nearer than the margin", truth.upper,
             t.margin);
    if (truth.lower > t.margin + t.tolerance)
      expect(reply_.verdict != Verdict::within, "false within", truth.lower, t.margin + t.tolerance);
  }

  void check_with_twin() {
    const Trial& t = *trial_;
    const bool closely = t.number % 10 == 3;
    ContactGoal goal;
    goal.effort = 3000;
    if (reply_.lower > 0) {
      goal.threshold = reply_.lower;
      goal.precision = {1e-14 * size(), closely ? 1e-9 : 1e-3};
      const ContactBounds found = contact(goal);
      expect(found.upper >= reply_.lower - 2 * twin_rounding(), "the twin finds points nearer than lower",
             found.upper, reply_.lower);
      open_ += found.spent;
    }
    if (reply_.verdict == Verdict::intersecting && !t.solid) {
      goal.threshold = 0;
      goal.precision = {closely ? 1e-9 * size() : 1e-5 * size(), 0};
      const ContactBounds found = contact(goal);
      expect(found.lower <= 0, "the twin proves a gap", found.lower);
      open_ += found.spent;
    }
    if (reply_.witness) {
      const double near =
          closely ? std::max(2 * reply_.witness_error, 1e-11 * size()) + twin_rounding() : 1e-9 * size();
      for (std::size_t side = 0; side < 2; ++side) {
        if (reply_.inner && side != *reply_.inner) continue;  // in the solid, not on its surface
        const oracle::Placement& place = side == 0 ? t.a : t.b;
        expect(pair_->twin(side).on_surface(place, (*reply_.witness)[side], near),
               side == 0 ? "the witness on A is on the surface" : "the witness on B is on the surface", near);
      }
    }
    if (reply_.verdict == Verdict::separated && closely && t.margin == 0) {
      // Asked for more than the truth, it must not be called separated.
      goal.threshold.reset();
      goal.precision = {1e-12 * size(), 1e-6};
      const ContactBounds truth = contact(goal);
      CollideOptions options = testing::verdict_only();
      options.margin = pair_->scaled(truth.upper * (1 + 1e-6));
      options.tolerance = pair_->scaled(0.01 * size());
      const Collision again =
          collide(pair_->placed(0, t.a), pair_->placed(1, t.b), options, {.max_splits = 2000});
      expect(again.verdict != Verdict::separated, "separated by more than the twin's points", truth.upper);
      more_undecided_ += again.verdict == Verdict::undecided && !t.hair;
      if (again.verdict == Verdict::undecided && !t.hair && std::getenv("SNUG_SHOW"))
        std::cerr << "within is not found: " << testing::describe(t) << '\n';
    }
  }

  void check_solids() {
    const Trial& t = *trial_;
    if (!t.truth.nested || t.truth.meet) return;
    if (*t.truth.nested) {
      expect(reply_.verdict != Verdict::separated, "false separated: one lies inside the other");
    } else if (reply_.verdict == Verdict::intersecting) {
      ContactGoal goal;
      goal.effort = 3000;
      goal.threshold = 0;
      goal.precision = {1e-7 * size(), 0};
      const ContactBounds found = contact(goal);
      expect(found.lower <= 0, "false intersecting: apart, and none inside the other", found.lower);
    }
  }

  [[nodiscard]] ContactBounds contact(const ContactGoal& goal) {
    return contact_bounds(pair_->twin(0), trial_->a, pair_->twin(1), trial_->b, goal);
  }
  [[nodiscard]] double size() const { return pair_->size(); }
  static double distance_of(const Point& p, const Point& q) {
    return std::hypot(p[0] - q[0], p[1] - q[1], p[2] - q[2]);
  }
  /// Of coordinates as they are written.
  [[nodiscard]] double rounding() const {
    double largest = size();
    for (const oracle::Placement* m : {&trial_->a, &trial_->b})
      for (std::size_t r = 0; r < 3; ++r) largest = std::max(largest, std::abs((*m)[4 * r + 3]));
    return 0x1p-50 * largest;
  }
  /// Error that the bounds of the twin include, and those of points as written do not.
  [[nodiscard]] double twin_rounding() const { return rounding(); }

  Trial* trial_ = nullptr;
  Contestants* pair_ = nullptr;
  Reply reply_{};
  std::map<std::string, std::array<std::size_t, 4>> counts_;
  std::map<std::string, double> seconds_;
  std::size_t total_ = 0, crossing_ = 0, crossing_undecided_ = 0, pulled_ = 0, between_ = 0, missed_ = 0,
              more_undecided_ = 0, open_ = 0, interrupted_ = 0;
  double asked_ = 0, slowest_ = 0;
  std::uint64_t slowest_trial_ = 0;
  int failures_ = 0;
};

TEST(contact, verdicts_and_bounds_are_true) {
  const std::uint64_t first = testing::first_trial(), count = testing::trial_count(1000);
  testing::Trials trials;
  Checks checks;
  const auto start = std::chrono::steady_clock::now();
  for (std::uint64_t i = 0; i < count; ++i) {
    Trial trial = trials.make(first + i);
    if (!checks.run(trial)) break;
    if ((i + 1) % 20'000 == 0)
      std::fprintf(stderr, "%llu placements, %.0f s\n", static_cast<unsigned long long>(i + 1),
                   std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count());
  }
  checks.report();
  if (count >= 1000) {
    EXPECT_GT(checks.crossing(), count / 100);
    EXPECT_LE(checks.open(), count / 50);
  }
  EXPECT_LE(100 * checks.crossing_undecided(), std::max<std::size_t>(checks.crossing(), 100));
}

// A triangle of size 2^a around the origin, another of size 2^b that lies h above it: the distance is h,
// whatever the sizes.
TEST(contact, bounds_hold_for_sizes_from_one_end_of_the_doubles_to_the_other) {
  const auto surface = [&](int exponent, double height) {
    ControlMesh mesh;
    for (const auto& [x, y] : {std::pair{-1, -1}, std::pair{2, -1}, std::pair{-1, 2}})
      mesh.points.push_back({std::ldexp(x, exponent), std::ldexp(y, exponent), height});
    const VertexId corners[3] = {VertexId(0u), VertexId(1u), VertexId(2u)};
    mesh.add_face(corners);
    return Surface(std::move(mesh), {.scheme = Scheme::loop, .boundary = BoundaryRule::edge_and_corner});
  };
  const Surface first = surface(0, 0);  // keeps the bounds that all of them share
  std::size_t apart = 0, near = 0, undecided = 0, turn = 0;
  for (const int a : {-1060, -600, -100, -20, 0, 20, 100, 600, 1020}) {
    for (const int b : {-1060, -600, -100, -20, 0, 20, 100, 600, 1020}) {
      for (const int c : {-1070, -1000, -500, -100, -30, 0, 30, 100, 500, 1000, 0x10000}) {
        const double h = c == 0x10000 ? 0 : std::ldexp(1.0, c);
        const bool by_placement = ++turn % 2 == 0;  // all pairs of choices, half of all combinations
        const Surface low = surface(a, 0), high = surface(b, by_placement ? 0 : h);
        const Motion place = Motion::translation({0, 0, by_placement ? h : 0});
        CollideOptions options = testing::verdict_only();
        for (const double tolerance : {0.0, h / 4, 2 * h, std::ldexp(1e-3, std::max(a, b))}) {
          options.tolerance = tolerance;
          const Collision answer = collide(low, high.at(place), options, {.max_splits = 300});
          const std::string what = "sizes 2^" + std::to_string(a) + ", 2^" + std::to_string(b) + ", h " +
                                   std::to_string(c) + ": " + name_of(answer.verdict);
          EXPECT_LE(answer.distance.lower, h) << what;
          if (std::isfinite(answer.distance.upper)) {
            EXPECT_GE(answer.distance.upper, h) << what;
          }
          if (h == 0) {
            EXPECT_NE(answer.verdict, Verdict::separated) << what;
          }
          if (h > 0) {
            EXPECT_NE(answer.verdict, Verdict::intersecting) << what;
          }
          if (tolerance < h) {
            EXPECT_NE(answer.verdict, Verdict::within) << what;
          }
          apart += answer.verdict == Verdict::separated;
          near += answer.verdict == Verdict::within;
          undecided += answer.verdict == Verdict::undecided;
        }
      }
    }
  }
  std::printf("  separated %zu, within %zu, undecided %zu\n", apart, near, undecided);
  EXPECT_GT(apart, 1000u);
  EXPECT_GT(near, 100u);
}

// Shells that are star-shaped around the origin: a point is inside if the segment to the origin misses the
// surface, outside if a ray away from it does.
TEST(contact, winding_numbers_tell_inside_from_outside) {
  testing::Trials trials;
  std::size_t inside = 0, outside = 0, undecided = 0;
  const std::uint64_t count = testing::trial_count(1200);
  for (std::uint64_t i = 0; i < count && !HasFailure(); ++i) {
    Trial trial = trials.make(testing::first_trial() + i);
    if (trial.family != "shells") continue;
    for (std::size_t side = 0; side < 2; ++side) {
      oracle::ContactSurface& twin = trial.pair->twin(side);
      const SurfaceBvh& model = trial.pair->surface(side).data()->bvh();
      PieceCache scratch(model);
      const std::uint64_t faces = model.surface().face_count();
      for (int k = 0; k < 8; ++k) {
        // Up to a hair from the surface, along a ray from the origin through a limit point.
        std::uniform_real_distribution<double> unit(-1, 1);
        const Point on = twin.limit_point(static_cast<std::uint32_t>(trial.random() % faces), 0.3,
                                          0.4 * std::abs(unit(trial.random)));
        const double t = 1 + std::ldexp(unit(trial.random), -static_cast<int>(trial.random() % 30));
        const Point p{t * on[0], t * on[1], t * on[2]}, far{9 * on[0], 9 * on[1], 9 * on[2]};
        const bool is_inside = twin.misses(oracle::kUnmoved, p, {0, 0, 0}),
                   is_outside = !is_inside && twin.misses(oracle::kUnmoved, p, far);
        if (!is_inside && !is_outside) continue;
        const PowerOfTwo scale = model.surface().scale();
        const Point3 scaled{scale.apply(trial.pair->scaled(p[0])), scale.apply(trial.pair->scaled(p[1])),
                            scale.apply(trial.pair->scaled(p[2]))};
        const std::optional<int> found = winding_number(scratch, scaled, 1e-15);
        undecided += !found && std::abs(t - 1) > 1e-5;
        inside += is_inside;
        outside += is_outside;
        if (found) {
          EXPECT_EQ(*found, is_inside ? 1 : 0) << testing::describe(trial) << ", side " << side << ", " << t;
        }
      }
    }
  }
  std::printf("  inside %zu, outside %zu, not decided though not near %zu\n", inside, outside, undecided);
  EXPECT_GT(inside, 50u);
  EXPECT_GT(outside, 50u);
  EXPECT_LE(undecided * 100, inside + outside);
}

}  // namespace
}  // namespace snug::contact_test
