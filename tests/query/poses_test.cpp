#include <snug/query/pair_queries.h>

#include <gtest/gtest.h>
#include <support/error.h>

#include <atomic>
#include <chrono>
#include <mutex>
#include <random>
#include <set>
#include <thread>

#include <testing/patches.h>
#include <testing/placements.h>

namespace snug::poses_test {
namespace {

class poses : public ::testing::Test {
 protected:
  poses() {
    std::mt19937_64 random(61);
    for (int i = 0; i < 100; ++i) {
      list.push_back({testing::random_placement(random, testing::random_vector(random, 0.5)),
                      testing::random_placement(random, testing::random_vector(random, 1.5))});
    }
  }

  LimitSurface surface_a = testing::surface_of(oracle::meshes::icosahedron()),
               surface_b = testing::surface_of(oracle::meshes::bipyramid(7));
  SurfaceBvh a{surface_a}, b{surface_b};
  std::vector<PosePair> list;
};

TEST_F(poses, are_answered_as_one_by_one_whatever_the_threads) {
  CollideOptions touch{.tolerance = 1e-3, .prove_contact = false, .measure = false};
  touch.prove_contact = true;
  const DistanceOptions far{.absolute = 1e-3};
  for (const int threads : {1, 2, 3, 8}) {
    PairWorkspaces scratches(a, b, threads);
    const std::vector<Collision> collisions = scratches.answers(collide, list, touch);
    const std::vector<Distance> distances = scratches.answers(distance, list, far);
    ASSERT_EQ(collisions.size(), list.size());
    std::set<Verdict> verdicts;
    for (std::size_t i = 0; i < list.size(); ++i) {
      SurfaceWorkspace scratch_a(a), scratch_b(b);
      const PlacedBvh at_a{a, scratch_a, list[i].a}, at_b{b, scratch_b, list[i].b};
      const Collision collision = collide(at_a, at_b, touch);
      verdicts.insert(collision.verdict);
      ASSERT_EQ(collisions[i].verdict, collision.verdict) << i;
      ASSERT_EQ(collisions[i].distance.lower, collision.distance.lower) << i;
      ASSERT_EQ(collisions[i].distance.upper, collision.distance.upper) << i;
      ASSERT_EQ(collisions[i].witness, collision.witness) << i;
      ASSERT_EQ(collisions[i].stats.splits, collision.stats.splits) << i;
      const Distance apart = distance(at_a, at_b, far);
      ASSERT_EQ(distances[i].distance.lower, apart.distance.lower) << i;
      ASSERT_EQ(distances[i].distance.upper, apart.distance.upper) << i;
      ASSERT_EQ(distances[i].witness, apart.witness) << i;
    }
    EXPECT_GE(verdicts.size(), 2u);
  }
}

TEST_F(poses, none_have_no_answers) {
  PairWorkspaces scratches(a, b, 2);
  EXPECT_TRUE(scratches.answers(collide, {}, CollideOptions{}).empty());
}

TEST_F(poses, are_asked_once_each_and_never_by_two_threads_in_one_scratch) {
  PairWorkspaces scratches(a, b, 4);
  std::vector<std::atomic<int>> asked(1000);
  std::mutex guard;
  std::set<const SurfaceWorkspace*> busy;
  scratches.for_each(asked.size(),
                     [&](SurfaceWorkspace& x, SurfaceWorkspace&, std::size_t i) {
                       {
                         const std::lock_guard lock(guard);
                         EXPECT_TRUE(busy.insert(&x).second);
                       }
                       ++asked[i];
                       std::this_thread::sleep_for(std::chrono::microseconds(100));  // lets the others in
                       const std::lock_guard lock(guard);
                       busy.erase(&x);
                     },
                     {});
  for (const auto& count : asked) ASSERT_EQ(count, 1);
}

TEST_F(poses, an_error_ends_all) {
  PairWorkspaces scratches(a, b, 3);
  std::atomic<int> asked{0};
  EXPECT_THROW(scratches.for_each(1'000'000,
                                  [&](SurfaceWorkspace&, SurfaceWorkspace&, std::size_t i) {
                                    ++asked;
                                    if (i == 1000) throw InputError(InputProblem::value, "here");
                                  },
                                  {}),
               InputError);
  EXPECT_LT(asked, 1'000'000);
  EXPECT_THROW(static_cast<void>(scratches.answers(collide, list, CollideOptions{.tolerance = -1})),
               InputError);
}

TEST_F(poses, stop_when_asked) {
  std::atomic<bool> stop{true};
  const WorkMonitor monitor{.on_progress = {}, .stop = &stop};
  PairWorkspaces scratches(a, b, 2);
  EXPECT_THROW(static_cast<void>(scratches.answers(collide, list, CollideOptions{}, {.monitor = &monitor})),
               Interrupted);
}

}  // namespace
}  // namespace snug::poses_test
