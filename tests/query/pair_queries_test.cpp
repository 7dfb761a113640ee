// Trees placed within a deviation, and the workspaces of many poses.

#include <snug/query/pair_queries.h>

#include <gtest/gtest.h>
#include <support/error.h>
#include <testing/cad_parts.h>
#include <testing/placements.h>
#include <testing/scheme_surfaces.h>
#include <testing/surfaces.h>

#include <atomic>
#include <chrono>
#include <cmath>
#include <mutex>
#include <set>
#include <thread>
#include <vector>

namespace snug::pair_queries_test {
namespace {

using testing::random_placement;
using testing::unit;

TEST(placed_trees, crossings_are_proved_for_all_places_within_the_deviation) {
  std::mt19937_64 random(4);
  const Surface a(testing::box({-1, -1, -1}, {1, 1, 1}, true), {.scheme = Scheme::flat}),
      b(testing::box({0, -0.2, -0.3}, {2, 0.2, 0.3}, true), {.scheme = Scheme::flat});
  const SurfaceBvh &model_a = a.data()->bvh(), &model_b = b.data()->bvh();
  PieceCache scratch_a(model_a), scratch_b(model_b);
  int proved = 0;
  for (int trial = 0; trial < 200; ++trial) {
    // B reaches so deep into A through its side.
    const double depth = std::exp2(-10 * unit(random)), deviation = std::exp2(2 * unit(random) - 1) * depth;
    const Motion turn = random_placement(random, {});
    const Motion pose_a = turn, pose_b = turn * Motion::translation({1 - depth, 0.1, 0.2});
    const bool on_a = random() % 2 != 0;
    const PlacedBvh placed_a{model_a, scratch_a, pose_a, on_a ? deviation : 0},
        placed_b{model_b, scratch_b, pose_b, on_a ? 0 : deviation};
    const CollideOptions options{.tolerance = 0, .prove_contact = true, .solid = trial % 2 != 0};
    const snug::Run run{.max_splits = 20'000};
    const Verdict verdict = collide(placed_a, placed_b, options, run).verdict;
    // Moved out by more than its depth, it is apart.
    if (deviation > depth * (1 + 1e-6)) {
      EXPECT_NE(verdict, Verdict::intersecting) << trial;
    }
    proved += verdict == Verdict::intersecting;
    const PlacedBvh exact{model_b, scratch_b, pose_b};
    EXPECT_EQ(collide({model_a, scratch_a, pose_a}, exact, options, run).verdict, Verdict::intersecting)
        << trial;
  }
  EXPECT_GT(proved, 10);
}

}  // namespace
}  // namespace snug::pair_queries_test
