#include <snug/tree/obb_tree.h>

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <set>

namespace snug {
namespace {

std::vector<OffsetTriangle> strip(std::size_t count) {
  std::vector<OffsetTriangle> triangles;
  for (std::size_t i = 0; i < count; ++i) {
    const double x = std::pow(static_cast<double>(i) / static_cast<double>(count), 8);  // crowded at one end
    triangles.push_back({{Point3{x, 0, 0}, {x + 1e-4, 0, 0}, {x, 1e-4, 0}}, 1e-5});
  }
  return triangles;
}

std::size_t depth(const ObbTree& tree, std::size_t node) {
  const ObbTree::Node& n = tree.node(node);
  return n.is_leaf() ? 1 : 1 + std::max(depth(tree, n.first_child), depth(tree, n.first_child + 1));
}

TEST(obb_tree, has_every_triangle_in_one_leaf) {
  for (const std::size_t count : {1u, 2u, 3u, 1000u}) {
    const ObbTree tree(strip(count));
    EXPECT_EQ(tree.size(), 2 * count - 1);
    std::set<std::uint32_t> leaves;
    for (std::size_t i = 0; i < tree.size(); ++i) {
      if (tree.node(i).is_leaf()) leaves.insert(tree.node(i).leaf);
    }
    EXPECT_EQ(leaves.size(), count);
  }
  EXPECT_TRUE(ObbTree(std::vector<OffsetTriangle>{}).empty());
}

TEST(obb_tree, stays_shallow_where_the_mean_splits_badly) {
  EXPECT_LE(depth(ObbTree(strip(4096)), 0), 60u);
  EXPECT_LE(depth(ObbTree(std::vector<OffsetTriangle>(4096, strip(1)[0])), 0), 13u);  // all alike
}

TEST(obb_tree, boxes_of_nodes_contain_the_corners_below) {
  const auto triangles = strip(300);
  const ObbTree tree(triangles);
  const auto check = [&](auto&& self, std::size_t node) -> std::vector<std::uint32_t> {
    std::vector<std::uint32_t> leaves;
    const ObbTree::Node& n = tree.node(node);
    if (n.is_leaf()) {
      leaves = {n.leaf};
    } else {
      leaves = self(self, n.first_child);
      const auto more = self(self, n.first_child + 1);
      leaves.insert(leaves.end(), more.begin(), more.end());
    }
    for (const std::uint32_t leaf : leaves) {
      for (const Point3& p : triangles[leaf].base) {
        for (std::size_t k = 0; k < 3; ++k)
          EXPECT_LE(std::fabs(dot(n.box.axes[k], p - n.box.centre)), n.box.half[k]);
      }
    }
    return leaves;
  };
  EXPECT_EQ(check(check, 0).size(), 300u);
}

}  // namespace
}  // namespace snug
