#include <experiments/printed_hierarchy.h>

#include <gtest/gtest.h>
#include <snug/bound.h>
#include <testing/patches.h>
#include <testing/surfaces.h>

namespace snug::printed_hierarchy_test {
namespace {

std::uint64_t bound_count(BoundMethod method, double tolerance) {
  return bound(testing::public_surface(oracle::meshes::icosahedron(), {.bounds = method}),
               {.error = tolerance}, [](const PatchEnclosure&) {})
      .count;
}

TEST(leaves, are_as_many_as_bound_makes) {
  const LimitSurface surface = testing::surface_of(oracle::meshes::icosahedron());
  for (const double tolerance : {0.2, 0.02}) {
    const auto rows = leaves(surface, {tolerance, {}});
    EXPECT_EQ(rows.size(), bound_count(BoundMethod::rows, tolerance));
    for (const OffsetTriangle& leaf : rows) EXPECT_LE(leaf.radius, tolerance / 2);
    const auto tables = leaves(surface, {tolerance, BoundMethod::table});
    EXPECT_EQ(tables.size(), bound_count(BoundMethod::table, tolerance));
    EXPECT_GE(tables.size(), rows.size());
  }
}

// Each face is split once, and then no more: every corner of an icosahedron has valence 5, two of each face
// of this bipyramid have valence 4.
TEST(leaves, have_one_extraordinary_corner_on_request) {
  const LimitSurface surface = testing::surface_of(oracle::meshes::icosahedron());
  EXPECT_EQ(leaves(surface, {100, BoundMethod::table}).size(), 20u);
  EXPECT_EQ(leaves(surface, {100, BoundMethod::table, true}).size(), 80u);
  const LimitSurface bipyramid = testing::surface_of(oracle::meshes::bipyramid(6));
  EXPECT_EQ(leaves(bipyramid, {100, BoundMethod::table, true}).size(), 48u);
}

TEST(leaves, refuse_what_rounding_forbids) {
  const LimitSurface surface = testing::surface_of(oracle::meshes::octahedron());
  EXPECT_THROW(static_cast<void>(leaves(surface, {1e-300, {}})), InputError);
}

TEST(printed_hierarchy, tells_surfaces_that_are_apart_from_those_that_cross) {
  const LimitSurface a = testing::surface_of(oracle::meshes::icosahedron()),
                     b = testing::surface_of(oracle::meshes::octahedron());
  const PrintedHierarchy tree_a(a, {0.05, BoundMethod::table}), tree_b(b, {0.05, BoundMethod::table});
  EXPECT_EQ(tree_a.leaves().size(), leaves(a, {0.05, BoundMethod::table}).size());
  const auto says = [&](double x, double epsilon) {
    const Motion moved = Motion::translation({x, 0, 0});
    return PrintedHierarchy::says_separated(tree_a, {}, tree_b, moved, epsilon);
  };
  EXPECT_TRUE(says(2.5, 0));
  EXPECT_FALSE(says(0.7, 0));
  EXPECT_FALSE(says(2.5, 2));  // so near that its tolerance says they meet
}

}  // namespace
}  // namespace snug::printed_hierarchy_test
