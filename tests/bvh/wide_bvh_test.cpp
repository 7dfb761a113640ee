#include <snug/bvh/wide_bvh.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <vector>

namespace snug {
namespace {

std::vector<Point3> scattered(std::size_t count) {
  std::mt19937_64 random(5);
  std::uniform_real_distribution<double> unit(-1, 1);
  std::vector<Point3> points;
  for (std::size_t i = 0; i < count; ++i)
    points.push_back({unit(random), 0.5 * unit(random), 0.1 * unit(random)});
  return points;
}

WideBvh tree_of(Volume volume, const std::vector<Point3>& points, int threads = 1) {
  return {volume, points, threads, [&](std::span<const std::uint32_t> items) {
            struct Items final : Enclosed {
              std::vector<Point3> all;
              [[nodiscard]] Extent extent(const Vector3& d) const override {
                Extent e{INFINITY, -INFINITY};
                for (const Point3& p : all) {
                  e.lower = std::min(e.lower, dot(d, p - Point3{}) - 1e-15);
                  e.upper = std::max(e.upper, dot(d, p - Point3{}) + 1e-15);
                }
                return e;
              }
              [[nodiscard]] std::span<const Point3> points() const override { return all; }
            } set;
            for (const std::uint32_t i : items) set.all.push_back(points[i]);
            return fit(volume, set);
          }};
}

// Counts items below and checks that the lane's set is not certainly apart from any of them.
void walk(const WideBvh& tree, const std::vector<Point3>& points, std::uint32_t name, std::size_t depth,
          std::vector<std::uint32_t>& below, std::size_t& deepest) {
  deepest = std::max(deepest, depth);
  if ((name & WideBvh::cluster_bit) != 0) {
    const auto items = tree.cluster(name & ~WideBvh::cluster_bit);
    below.insert(below.end(), items.begin(), items.end());
    return;
  }
  for (std::uint32_t l = 0; l < tree.blocks().count(name); ++l) {
    std::vector<std::uint32_t> here;
    walk(tree, points, tree.blocks().name({name, l}), depth + 1, here, deepest);
    for (const std::uint32_t i : here) {
      Blocks::Distances found;
      tree.blocks().distances(name, points[i], 0, found);
      EXPECT_LE(found[l], 0) << i;
    }
    below.insert(below.end(), here.begin(), here.end());
  }
}

TEST(bounding_tree, holds_every_item_once_below_sets_that_contain_it) {
  for (const Volume volume : all_volumes) {
    for (const std::size_t count : {1u, 7u, 8u, 9u, 64u, 65u, 513u, 3000u}) {
      const std::vector<Point3> points = scattered(count);
      const WideBvh tree = tree_of(volume, points);
      std::vector<std::uint32_t> below;
      std::size_t deepest = 0;
      walk(tree, points, tree.blocks().name(tree.root()), 0, below, deepest);
      std::sort(below.begin(), below.end());
      ASSERT_EQ(below.size(), count);
      for (std::uint32_t i = 0; i < count; ++i) EXPECT_EQ(below[i], i);
      EXPECT_LE(deepest, 4u);
      for (const Point3& p : points) EXPECT_LE(distance(p, tree.ball().centre), tree.ball().radius);
    }
  }
}

TEST(bounding_tree, is_as_deep_for_items_all_alike) {
  const std::vector<Point3> points(4096, Point3{0.5, 0.5, 0.5});
  const WideBvh tree = tree_of(Volume::obb, points);
  std::vector<std::uint32_t> below;
  std::size_t deepest = 0;
  walk(tree, points, tree.blocks().name(tree.root()), 0, below, deepest);
  EXPECT_EQ(below.size(), 4096u);
  EXPECT_EQ(deepest, 3u);
}

TEST(bounding_tree, is_the_same_for_any_number_of_threads) {
  const std::vector<Point3> points = scattered(20000);
  const WideBvh one = tree_of(Volume::obb, points, 1), two = tree_of(Volume::obb, points, 4);
  ASSERT_EQ(one.cluster_count(), two.cluster_count());
  for (std::size_t c = 0; c < one.cluster_count(); ++c) {
    EXPECT_TRUE(std::ranges::equal(one.cluster(c), two.cluster(c)));
  }
  for (std::uint32_t block = 0; block < one.blocks().size(); ++block) {
    Blocks::Distances x, y;
    one.blocks().distances(block, Point3{3, 2, 1}, 0, x);
    two.blocks().distances(block, Point3{3, 2, 1}, 0, y);
    EXPECT_EQ(x, y);
  }
}

}  // namespace
}  // namespace snug
