#include <snug/search/surface_bvh.h>

#include <gtest/gtest.h>
#include <oracle/test_meshes.h>
#include <testing/patches.h>

#include <array>
#include <cstring>
#include <random>
#include <thread>
#include <vector>

namespace snug::surface_bvh_test {
namespace {

LimitSurface some_surface() {
  std::mt19937_64 random(33);
  return testing::surface_of(
      oracle::meshes::disturbed(oracle::meshes::quartered(oracle::meshes::icosahedron()), 10, 0.1, random));
}

void expect_same(const LeafNode& x, const LeafNode& y) {
  ASSERT_EQ(x.count(), y.count());
  EXPECT_EQ(x.origin(), y.origin());
  EXPECT_EQ(x.names, y.names);
  EXPECT_EQ(std::memcmp(x.bounds.data(), y.bounds.data(), sizeof(x.bounds)), 0);
  WideNode::Distances of_x, of_y;
  x.distances(Point3{3, -2, 1}, 0, of_x);
  y.distances(Point3{3, -2, 1}, 0, of_y);
  EXPECT_EQ(of_x, of_y);
}

TEST(surface_bvh, leaves_made_by_threads_at_once_are_those_of_one) {
  const LimitSurface surface = some_surface();
  const SurfaceBvh alone(surface, {.threads = 1}), tight(surface, {.tight = true, .threads = 2});
  const auto count = static_cast<std::uint32_t>(alone.tree().leaf_count());
  ASSERT_GT(count, 8u);
  for (int round = 0; round < 40; ++round) {
    const SurfaceBvh shared(surface, {.threads = 1});
    std::array<std::vector<const LeafNode*>, 3> seen;
    std::vector<std::thread> threads;
    for (auto& own : seen) {
      threads.emplace_back([&] {
        for (std::uint32_t i = 0; i < count; ++i) own.push_back(&shared.leaf(i));
      });
    }
    for (std::thread& thread : threads) thread.join();
    for (std::uint32_t i = 0; i < count; ++i) {
      EXPECT_EQ(seen[0][i], seen[1][i]);  // one of them is kept, for all
      EXPECT_EQ(seen[0][i], seen[2][i]);
      EXPECT_EQ(seen[0][i], &shared.leaf(i));
      expect_same(*seen[0][i], alone.leaf(i));
    }
    EXPECT_EQ(shared.bytes(), alone.bytes()) << "a leaf counts once";
  }
  // Tight trees have leaves of their own, all made beforehand.
  const std::size_t before = tight.bytes();
  for (std::uint32_t i = 0; i < tight.tree().leaf_count(); ++i) static_cast<void>(tight.leaf(i));
  EXPECT_EQ(tight.bytes(), before);
}

TEST(surface_bvh, takes_memory_for_leaves_that_are_made) {
  const LimitSurface surface = some_surface();
  const SurfaceBvh model(surface, {.threads = 1});
  const std::size_t before = model.bytes();
  EXPECT_LT(before, surface.patch_count() * 60);
  std::size_t made = 0;
  for (const std::uint32_t i : {0u, 5u, 0u, 2u, 5u}) {
    const std::size_t was = model.bytes();
    static_cast<void>(model.leaf(i));
    made += model.bytes() != was;
    EXPECT_EQ(model.bytes(), before + made * sizeof(LeafNode));
  }
  EXPECT_EQ(made, 3u);
}

// Each patch is in one leaf, and its leaf says which.
TEST(surface_bvh, has_every_patch_in_one_leaf) {
  const LimitSurface surface = some_surface();
  const SurfaceBvh model(surface, {.threads = 1});
  std::vector<int> found(surface.patch_count());
  for (std::uint32_t i = 0; i < model.tree().leaf_count(); ++i) {
    for (std::size_t place = 0; place < model.leaf(i).count(); ++place) {
      ++found[model.patch(i, place).index()];
      const Triangle base = model.leaf(i).bounds[place].base(model.leaf(i).origin());
      const Point3 middle = surface.middle(model.patch(i, place));
      for (const Point3& corner : base) EXPECT_LT(distance(corner, middle), model.leaf(i).size_of(place));
    }
  }
  for (const int times : found) EXPECT_EQ(times, 1);
}

}  // namespace
}  // namespace snug::surface_bvh_test
