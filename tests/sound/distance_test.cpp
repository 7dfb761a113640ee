// The promises of distance, on the placements of sound/contact_test.cpp:
//
//   SNUG_PLACEMENTS=100000 build/release/bin/tests/sound_test --gtest_filter=distance.intervals_hold_the_truth

#include <snug/distance.h>

#include <gtest/gtest.h>
#include <testing/contact_trials.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <map>

namespace snug::distance_test {
namespace {

using oracle::ContactBounds;
using oracle::ContactGoal;
using oracle::Point;
using testing::Contestants;
using testing::Trial;

double between(const Point& p, const Point& q) { return std::hypot(p[0] - q[0], p[1] - q[1], p[2] - q[2]); }

struct Counts {
  std::size_t asked = 0, reached = 0;
  double seconds = 0;
};

TEST(distance, intervals_hold_the_truth) {
  const std::uint64_t first = testing::first_trial(), count = testing::trial_count(250);
  constexpr int max_failures = 20;
  int failures = 0;
  std::size_t open = 0;
  std::map<std::string, Counts> counts;
  double slowest = 0;
  std::uint64_t slowest_trial = 0;
  testing::Trials trials;
  const auto start = std::chrono::steady_clock::now();
  for (std::uint64_t i = 0; i < count && failures < max_failures; ++i) {
    Trial trial = trials.make(first + i);
    Contestants& pair = *trial.pair;
    const double size = pair.size();
    // Relative, absolute, both, or as near as it gets.
    DistanceOptions options{.absolute = 0, .relative = 0};
    const std::uint64_t choice = trial.random() % 8;
    if (choice < 4) options.relative = choice == 0 ? 1e-9 : choice == 1 ? 1e-6 : 1e-2;
    if (choice >= 3 && choice < 7)
      options.absolute = pair.scaled(size * (choice == 5 ? 1e-9 : choice == 6 ? 1e-6 : 1e-3));
    const snug::Run run{.max_splits = choice == 7 ? 1000 : trial.hair ? 1000 : 10'000};
    const auto asked = std::chrono::steady_clock::now();
    const Distance answer = distance(pair.placed(0, trial.a), pair.placed(1, trial.b), options, run);
    const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - asked).count();
    if (seconds > slowest) slowest = seconds, slowest_trial = trial.number;
    char precision[100];
    std::snprintf(precision, sizeof precision, "not a hair apart, to %g of the distance or %g of the size",
                  options.relative.value_or(0), pair.back(options.absolute.value_or(0)) / size);
    for (const std::string& name : {trial.family, std::string(trial.hair ? "a hair apart" : precision)}) {
      Counts& group = counts[name];
      ++group.asked;
      group.reached += (answer.outcome == Outcome::complete);
      group.seconds += seconds;
    }

    const double lower = pair.back(answer.distance.lower), upper = pair.back(answer.distance.upper),
                 error = pair.back(std::max(answer.witness[0].error, answer.witness[1].error));
    const std::array<Point, 2> witness{pair.back(answer.witness[0].point),
                                       pair.back(answer.witness[1].point)};
    const auto expect = [&](bool holds, const char* claim, double found, double bound) {
      if (holds) return;
      ++failures;
      char numbers[200];
      std::snprintf(numbers, sizeof numbers, " (%.17g, %.17g): [%.17g, %.17g] absolute %g relative %g ",
                    found, bound, lower, upper, pair.back(options.absolute.value_or(0)),
                    options.relative.value_or(0));
      ADD_FAILURE() << claim << numbers << testing::describe(trial);
    };
    if (trial.number % 16 == 5) {  // no answer depends on what was asked before
      Workspace empty;
      const Distance fresh = distance(pair.placed(0, trial.a), pair.placed(1, trial.b), options,
                                      {.workspace = &empty, .max_splits = run.max_splits});
      expect(fresh.distance.lower == answer.distance.lower && fresh.distance.upper == answer.distance.upper &&
                 fresh.witness == answer.witness,
             "the same answer from fresh scratch memory", pair.back(fresh.distance.lower),
             pair.back(fresh.distance.upper));
    }
    double coordinates = size;
    for (const oracle::Placement* m : {&trial.a, &trial.b})
      for (std::size_t r = 0; r < 3; ++r) coordinates = std::max(coordinates, std::abs((*m)[4 * r + 3]));
    const double rounding = 0x1p-50 * coordinates;

    expect(lower >= 0 && lower <= upper && std::isfinite(upper), "an interval", lower, upper);
    if (answer.outcome == Outcome::complete) {
      const double width =
          std::max(pair.back(options.absolute.value_or(0)), options.relative.value_or(0) * upper);
      expect(upper - lower <= width * (1 + 1e-12) + 1e-300, "reached is reached", upper - lower, width);
    }
    expect(upper >= trial.truth.lower, "upper is at least the distance", upper, trial.truth.lower);
    expect(lower <= trial.truth.upper, "lower is at most the distance", lower, trial.truth.upper);
    if (trial.truth.meet) expect(lower == 0, "a common point leaves no lower bound", lower, 0);
    if (upper > 0) {
      expect(between(witness[0], witness[1]) <= upper * (1 + 1e-12) + rounding,
             "witnesses are at most upper apart", between(witness[0], witness[1]), upper);
    } else {  // contact is proved
      expect(!trial.truth.apart, "false contact", upper, trial.truth.lower);
      ContactGoal goal;
      goal.effort = 3000;
      goal.threshold = 0;
      goal.precision = {1e-6 * size, 0};
      const ContactBounds found = contact_bounds(pair.twin(0), trial.a, pair.twin(1), trial.b, goal);
      expect(found.lower <= 0, "the twin proves a gap", found.lower, 0);
      open += found.spent;
    }
    const bool closely = trial.number % 10 == 3;
    const double near = closely ? std::max(2 * error, 1e-11 * size) + rounding : 1e-9 * size;
    expect(pair.twin(0).on_surface(trial.a, witness[0], near), "the witness on A is on the surface", near,
           error);
    expect(pair.twin(1).on_surface(trial.b, witness[1], near), "the witness on B is on the surface", near,
           error);
    for (std::size_t s = 0; s < 2; ++s) {
      const Place at = answer.witness[s].at.value();
      const oracle::Placement& m = s == 0 ? trial.a : trial.b;
      const Point local = pair.twin(s).limit_point(at.owner, at.u, at.v);
      Point placed;
      for (std::size_t r = 0; r < 3; ++r) {
        placed[r] = m[4 * r] * local[0] + m[4 * r + 1] * local[1] + m[4 * r + 2] * local[2] + m[4 * r + 3];
      }
      expect(between(placed, witness[s]) <= 2 * error + 1e-12 * size + 4 * rounding,
             "face, u and v are those of the witness", between(placed, witness[s]), error);
    }
    ContactGoal goal;
    goal.effort = 4000;
    goal.threshold = lower > 0 ? std::optional<double>(lower) : std::nullopt;
    goal.precision = {1e-14 * size, closely ? 1e-9 : 1e-3};
    if (lower > 0) {
      const ContactBounds found = contact_bounds(pair.twin(0), trial.a, pair.twin(1), trial.b, goal);
      expect(found.upper >= lower - 2 * rounding, "the twin finds points nearer than lower", found.upper,
             lower);
      open += found.spent;
    }
    if ((i + 1) % 20'000 == 0)
      std::fprintf(stderr, "%llu placements, %.0f s\n", static_cast<unsigned long long>(i + 1),
                   std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count());
  }
  for (const auto& [family, c] : counts)
    std::printf("  %s: %zu asked, %zu reached, %.2f ms each\n", family.c_str(), c.asked, c.reached,
                1e3 * c.seconds / static_cast<double>(c.asked));
  std::printf("  slowest %.0f ms (trial %llu); the twin left %zu open\n", 1e3 * slowest,
              static_cast<unsigned long long>(slowest_trial), open);
  for (const char* family : {"random", "pulled", "shells"}) {
    const Counts& c = counts[family];
    EXPECT_GE(c.reached * 10, c.asked * 5) << family;
  }
}

}  // namespace
}  // namespace snug::distance_test
