#include <snug/search/triangle_sides.h>

#include <vector>

#include <gtest/gtest.h>

namespace snug {
namespace {

using Triangles = std::vector<std::array<std::uint32_t, 3>>;

TEST(triangle_sides, a_tetrahedron_has_no_border) {
  const TriangleSides sides = sides_of(Triangles{{0, 1, 2}, {0, 3, 1}, {1, 3, 2}, {2, 3, 0}});
  EXPECT_FALSE(sides.border);
  EXPECT_FALSE(sides.same_way);
}

TEST(triangle_sides, a_face_that_is_missing_leaves_a_border) {
  EXPECT_TRUE(sides_of(Triangles{{0, 1, 2}, {0, 3, 1}, {1, 3, 2}}).border);
  EXPECT_TRUE(sides_of(Triangles{{0, 1, 2}}).border);
  EXPECT_FALSE(sides_of({}).border);
}

TEST(triangle_sides, a_face_the_other_way_round_is_named_with_one_beside_it) {
  const TriangleSides sides = sides_of(Triangles{{4, 5, 6}, {0, 1, 2}, {1, 2, 3}});
  ASSERT_TRUE(sides.same_way);
  EXPECT_EQ(*sides.same_way, (std::array<std::size_t, 2>{1, 2}));  // both run from 1 to 2
}

}  // namespace
}  // namespace snug
