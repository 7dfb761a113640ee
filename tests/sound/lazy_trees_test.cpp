// Trees that are made part by part where queries come, which otherwise takes surfaces of 8,192 patches: on half of the
// placements of sound/contact_test.cpp they agree with what is known and with trees that are made at once.
//
//   SNUG_PLACEMENTS=100000 build/release/bin/tests/sound_test --gtest_filter='lazy_trees.*'

#include <snug/query/closest.h>
#include <snug/query/pair_queries.h>
#include <snug/search/surface_data.h>

#include <gtest/gtest.h>
#include <testing/contact_trials.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>

namespace snug::lazy_trees_test {
namespace {

using testing::Contestants;
using testing::Trial;

void expect_same_number(const Interval& x, const Interval& y, const char* query, const Trial& trial) {
  EXPECT_LE(x.lower, y.upper) << query << ": " << testing::describe(trial);
  EXPECT_LE(y.lower, x.upper) << query << ": " << testing::describe(trial);
}

void expect_true(const Collision& found, const Collision& other, const Trial& trial) {
  for (const Verdict meet : {found.verdict, other.verdict}) {
    if (meet != Verdict::intersecting) continue;
    EXPECT_NE(found.verdict, Verdict::separated) << testing::describe(trial);
    EXPECT_NE(other.verdict, Verdict::separated) << testing::describe(trial);
  }
  if (trial.truth.meet || trial.truth.upper <= trial.margin) {
    EXPECT_NE(found.verdict, Verdict::separated) << testing::describe(trial);
  }
  if (trial.truth.apart && !trial.solid) {
    EXPECT_NE(found.verdict, Verdict::intersecting) << testing::describe(trial);
  }
  if (trial.truth.lower > trial.margin + trial.tolerance) {
    EXPECT_NE(found.verdict, Verdict::within) << testing::describe(trial);
  }
  EXPECT_LE(trial.pair->back(found.distance.lower), trial.truth.upper) << testing::describe(trial);
  if (!found.contained && std::isfinite(found.distance.upper)) {
    EXPECT_GE(trial.pair->back(found.distance.upper), trial.truth.lower) << testing::describe(trial);
  }
}

TEST(lazy_trees, give_true_answers) {
  testing::Trials trials;
  std::array<std::size_t, 4> verdicts{};
  const std::uint64_t first = testing::first_trial(), count = testing::trial_count(2000);
  for (std::uint64_t i = first; i < first + count && !HasFailure(); ++i) {
    Trial trial = trials.make(i);
    Contestants& pair = *trial.pair;
    const testing::ContestantOptions& how = pair.options();
    if (how.part_level == 0) continue;
    const SurfaceBvhOptions lazy{
        .method = how.bounds, .tight = how.tight, .threads = 1, .min_lazy = 0, .part_level = how.part_level};
    const SurfaceBvh model_a(pair.surface(0).data()->limit(), lazy),
        model_b(pair.surface(1).data()->limit(), lazy);
    PieceCache scratch_a(model_a), scratch_b(model_b);
    const PlacedBvh a{model_a, scratch_a, pair.scaled(trial.a)}, b{model_b, scratch_b, pair.scaled(trial.b)};
    const PlacedSurface whole_a = pair.placed(0, trial.a), whole_b = pair.placed(1, trial.b);
    const CollideOptions options{.tolerance = pair.scaled(trial.tolerance),
                                 .margin = pair.scaled(trial.margin),
                                 .prove_contact = trial.prove_contact,
                                 .solid = trial.solid,
                                 .measure = false};
    const Collision found = collide(a, b, options, {.max_splits = trial.budget});
    expect_true(found, collide(whole_a, whole_b, options, {.max_splits = trial.budget}), trial);
    ++verdicts[static_cast<std::size_t>(found.verdict)];
    if (i % 4 != 0) continue;
    const DistanceOptions near{.relative = 1e-2};
    const Distance apart = distance(a, b, near, {.max_splits = 1000});
    expect_same_number(apart.distance, distance(whole_a, whole_b, near, {.max_splits = 1000}).distance,
                       "distance", trial);
    EXPECT_LE(pair.back(apart.distance.lower), trial.truth.upper) << testing::describe(trial);
    EXPECT_GE(pair.back(apart.distance.upper), trial.truth.lower) << testing::describe(trial);
    const oracle::Point& p = pair.mesh(0).points[trial.random() % pair.mesh(0).points.size()];
    const Point3 to{pair.scaled(p[0]), pair.scaled(p[1]), pair.scaled(p[2])};
    const Precision precision{.relative = 1e-3};
    expect_same_number(closest_point(scratch_a, to, precision, {.max_splits = 1000}).distance,
                       closest_point(pair.surface(0), to, precision, {.max_splits = 1000}).distance,
                       "closest point", trial);
  }
  std::printf("  %zu separated, %zu within, %zu intersecting, %zu undecided\n", verdicts[0], verdicts[1],
              verdicts[2], verdicts[3]);
  EXPECT_GT(std::min({verdicts[0], verdicts[1], verdicts[2]}), count / 100);
}

}  // namespace
}  // namespace snug::lazy_trees_test
