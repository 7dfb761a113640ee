#include <snug/distance.h>
#include <snug/scene.h>

#include <gtest/gtest.h>
#include <support/error.h>

#include <atomic>
#include <random>
#include <set>

#include <testing/placements.h>
#include <testing/surfaces.h>

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

  Surface a = testing::public_surface(oracle::meshes::icosahedron()),
          b = testing::public_surface(oracle::meshes::bipyramid(7));
  std::vector<PosePair> list;
};

TEST_F(poses, are_answered_as_one_by_one_whatever_the_threads) {
  CollideOptions touch{.tolerance = 1e-3, .prove_contact = false, .measure = false};
  touch.prove_contact = true;
  const DistanceOptions far{.absolute = 1e-3};
  for (const int threads : {1, 2, 3, 8}) {
    const std::vector<Collision> collisions = collide(a, b, list, touch, {.threads = threads});
    const std::vector<Distance> distances = distance(a, b, list, far, {.threads = threads});
    ASSERT_EQ(collisions.size(), list.size());
    std::set<Verdict> verdicts;
    for (std::size_t i = 0; i < list.size(); ++i) {
      Workspace empty;
      const PlacedSurface at_a = a.at(list[i].a), at_b = b.at(list[i].b);
      const Collision collision = collide(at_a, at_b, touch, {.workspace = &empty});
      verdicts.insert(collision.verdict);
      ASSERT_EQ(collisions[i].verdict, collision.verdict) << i;
      ASSERT_EQ(collisions[i].distance.lower, collision.distance.lower) << i;
      ASSERT_EQ(collisions[i].distance.upper, collision.distance.upper) << i;
      ASSERT_EQ(collisions[i].witness, collision.witness) << i;
      ASSERT_EQ(collisions[i].stats.splits, collision.stats.splits) << i;
      const Distance apart = distance(at_a, at_b, far, {.workspace = &empty});
      ASSERT_EQ(distances[i].distance.lower, apart.distance.lower) << i;
      ASSERT_EQ(distances[i].distance.upper, apart.distance.upper) << i;
      ASSERT_EQ(distances[i].witness, apart.witness) << i;
    }
    EXPECT_GE(verdicts.size(), 2u);
  }
}

// What other threads of the outer loop have in use must not move.
TEST_F(poses, may_be_asked_while_a_scene_is) {
  const std::vector<Collision> expected = collide(a, b, list);
  Scene scene;
  for (int i = 0; i < 12; ++i)
    scene.parts.push_back((i % 2 == 0 ? a : b).at(Motion::translation({0.4 * i, 0, 0})));
  std::size_t asked = 0;
  static_cast<void>(collide(scene, {},
                            [&](const PairCollision&) {
                              const std::vector<Collision> found = collide(a, b, list, {}, {.threads = 4});
                              for (std::size_t i = 0; i < list.size(); ++i)
                                EXPECT_EQ(found[i].distance, expected[i].distance);
                              ++asked;
                            },
                            {.threads = 3}));
  EXPECT_GT(asked, 5u);
}

TEST_F(poses, keep_what_their_threads_found_out) {
  Workspace workspace;
  static_cast<void>(collide(a, b, list, {.tolerance = 1e-7, .prove_contact = true},
                            {.threads = 3, .workspace = &workspace}));
  const std::size_t bytes = workspace.bytes();
  EXPECT_GT(bytes, 0u);
  static_cast<void>(collide(a, b, list, {.tolerance = 1e-7, .prove_contact = true},
                            {.threads = 3, .workspace = &workspace}));
  EXPECT_GE(workspace.bytes(), bytes);
  workspace.clear();
  EXPECT_EQ(workspace.bytes(), 0u);
}

TEST_F(poses, none_have_no_answers) { EXPECT_TRUE(collide(a, b, std::span<const PosePair>{}).empty()); }

TEST_F(poses, an_error_ends_all) {
  EXPECT_THROW(static_cast<void>(collide(a, b, list, {.tolerance = -1})), InputError);
}

TEST_F(poses, stop_when_asked) {
  std::atomic<bool> stop{true};
  const WorkMonitor monitor{.on_progress = {}, .stop = &stop};
  EXPECT_THROW(static_cast<void>(collide(a, b, list, {}, {.threads = 2, .monitor = &monitor})), Interrupted);
}

}  // namespace
}  // namespace snug::poses_test
