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

WideBvh tree_of(const std::vector<Point3>& points, int threads = 1) {
  return {points, threads,
          [&](std::size_t leaf, std::span<const std::uint32_t> items, std::vector<Obb>& boxes) {
            // One box for all items of a leaf, or one each.
            const std::size_t together = leaf % 2 == 0 ? items.size() : 1;
            for (std::size_t at = 0; at < items.size(); at += together) {
              std::vector<Point3> own;
              for (const std::uint32_t i : items.subspan(at, together)) own.push_back(points[i]);
              boxes.push_back(fit_box(principal_axes(own), [&](const Vector3& d) {
                Extent extent;
                for (const Point3& p : own) {
                  extent.add({dot(d, p - Point3{}) - 1e-15, dot(d, p - Point3{}) + 1e-15});
                }
                return extent;
              }));
            }
          }};
}

// Counts items below and checks that the child's box is not certainly apart from any of them.
void walk(const WideBvh& tree, const std::vector<Point3>& points, std::uint32_t name, std::size_t depth,
          std::vector<std::uint32_t>& below, std::size_t& deepest) {
  deepest = std::max(deepest, depth);
  if ((name & WideBvh::leaf_bit) != 0) {
    const auto items = tree.leaf(name & ~WideBvh::leaf_bit);
    below.insert(below.end(), items.begin(), items.end());
    return;
  }
  const TreeNode& node = tree.node(name);
  for (std::uint32_t l = 0; l < node.count(); ++l) {
    std::vector<std::uint32_t> here;
    walk(tree, points, node.names[l], depth + 1, here, deepest);
    for (const std::uint32_t i : here) {
      WideNode::Distances found;
      node.distances(points[i], 0, found);
      EXPECT_LE(found[l], 0) << i;
    }
    below.insert(below.end(), here.begin(), here.end());
  }
}

TEST(bounding_tree, holds_every_item_once_below_boxes_that_contain_it) {
  for (const std::size_t count : {1u, 7u, 8u, 9u, 64u, 65u, 513u, 3000u}) {
    const std::vector<Point3> points = scattered(count);
    const WideBvh tree = tree_of(points);
    std::vector<std::uint32_t> below;
    std::size_t deepest = 0;
    walk(tree, points, tree.root().names[0], 0, below, deepest);
    std::sort(below.begin(), below.end());
    ASSERT_EQ(below.size(), count);
    for (std::uint32_t i = 0; i < count; ++i) EXPECT_EQ(below[i], i);
    EXPECT_LE(deepest, 4u);
    for (const Point3& p : points) EXPECT_LE(distance(p, tree.ball().centre), tree.ball().radius);
  }
}

TEST(bounding_tree, is_as_deep_for_items_all_alike) {
  const std::vector<Point3> points(4096, Point3{0.5, 0.5, 0.5});
  const WideBvh tree = tree_of(points);
  std::vector<std::uint32_t> below;
  std::size_t deepest = 0;
  walk(tree, points, tree.root().names[0], 0, below, deepest);
  EXPECT_EQ(below.size(), 4096u);
  EXPECT_EQ(deepest, 3u);
}

void expect_same(const WideBvh& one, const WideBvh& two, const TreeNode& x, const TreeNode& y) {
  ASSERT_EQ(x.count(), y.count());
  EXPECT_EQ(x.names, y.names);
  EXPECT_EQ(x.origin(), y.origin());
  WideNode::Distances of_x, of_y;
  x.distances(Point3{3, 2, 1}, 0, of_x);
  y.distances(Point3{3, 2, 1}, 0, of_y);
  EXPECT_EQ(of_x, of_y);
  for (std::size_t l = 0; l < x.count(); ++l) {
    EXPECT_EQ(x.size_of(l), y.size_of(l));
    if ((x.names[l] & WideBvh::leaf_bit) != 0) continue;
    expect_same(one, two, one.node(x.names[l]), two.node(y.names[l]));
  }
}

TEST(bounding_tree, is_the_same_for_any_number_of_threads) {
  const std::vector<Point3> points = scattered(20000);
  const WideBvh one = tree_of(points, 1), two = tree_of(points, 4);
  ASSERT_EQ(one.leaf_count(), two.leaf_count());
  for (std::size_t c = 0; c < one.leaf_count(); ++c) {
    EXPECT_TRUE(std::ranges::equal(one.leaf(c), two.leaf(c)));
  }
  expect_same(one, two, one.root(), two.root());
}

}  // namespace
}  // namespace snug
