#include <snug/search/facet_rows.h>

#include <random>
#include <vector>

#include <gtest/gtest.h>

namespace snug {
namespace {

Triangle random_triangle(std::mt19937& random) {
  std::uniform_real_distribution<double> coordinate(-1, 1), offset(-0.1, 0.1);
  const Point3 at{coordinate(random), coordinate(random), coordinate(random)};
  Triangle result;
  for (Point3& p : result) p = at + Vector3{offset(random), offset(random), offset(random)};
  return result;
}

Box3 box_of(const Triangle& triangle, double growth = 0) {
  Box3 box;
  for (const Point3& p : triangle) box.add(p);
  const double more = growth * longest_side(box);
  for (std::size_t k = 0; k < 3; ++k) {
    box.lower[k] -= more;
    box.upper[k] += more;
  }
  return box;
}

// Marked, not marked; in whole rows and the last one, which is not; grown or not.
TEST(facet_rows, triangles_whose_boxes_meet_one_are_visited_and_no_others) {
  std::mt19937 random(11);
  for (const std::size_t count : {0, 1, 63, 64, 65, 200, 640}) {
    for (const double growth : {0.0, 2.0}) {
      std::vector<Triangle> triangles(count);
      std::vector<std::uint8_t> marks(count);
      for (std::size_t t = 0; t < count; ++t) {
        triangles[t] = random_triangle(random);
        marks[t] = random() % 3 != 0;
      }
      const FacetRows rows(marks, growth, [&](std::size_t t) { return triangles[t]; });
      std::size_t met = 0;
      for (int question = 0; question < 50; ++question) {
        const Box3 box = box_of(random_triangle(random));
        std::vector<std::size_t> visited, expected;
        rows.visit(box, [&](std::size_t t) { visited.push_back(t); });
        for (std::size_t t = 0; t < count; ++t) {
          if (marks[t] != 0 && overlap(box_of(triangles[t], growth), box)) expected.push_back(t);
        }
        EXPECT_EQ(visited, expected);
        EXPECT_TRUE(expected.empty() || rows.meet(box));
        met += expected.size();
      }
      EXPECT_TRUE(count < 200 || met > 5);
    }
  }
}

}  // namespace
}  // namespace snug
