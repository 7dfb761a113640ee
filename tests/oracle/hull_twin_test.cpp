#include <oracle/hull_twin.h>
#include <oracle/polyhedron_twin.h>

#include <gtest/gtest.h>

#include <random>

namespace oracle::hull_twin_test {
namespace {

const std::vector<Triangle> tetrahedron{{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {2, 0, 3}};

TEST(hull_twin, winds_as_rationals_tell) {
  std::mt19937_64 random(3);
  std::size_t inside = 0;
  for (int trial = 0; trial < 800; ++trial) {
    const auto lattice = [&] {
      return Point{static_cast<double>(random() % 5), static_cast<double>(random() % 5),
                   static_cast<double>(random() % 5)};
    };
    const std::vector<Point> points{lattice(), lattice(), lattice(), lattice()};
    const HullTwin hull(points, tetrahedron);
    if (hull.contacts().size() > 0) continue;  // flat
    const PolyhedronTwin exact(points, tetrahedron);
    for (int i = 0; i < 5; ++i) {
      const Point q = lattice();
      EXPECT_EQ(hull.winding(q), exact.winding(q));
      inside += hull.winding(q).value_or(0) != 0;
      EXPECT_NEAR(hull.distance(q) * hull.distance(q), exact.squared_distance(q).get_d(), 1e-12);
    }
  }
  EXPECT_GT(inside, 10u);
}

TEST(hull_twin, tells_contacts_of_each_kind) {
  const std::vector<Point> points{{0, 0, 0}, {4, 0, 0}, {0, 4, 0}, {0, 0, 4}, {1, 1, 0},
                                  {5, 5, 0}, {1, 1, 4}, {4, 4, 0}, {2, 2, 0}, {8, 0, 0}};
  const auto touch = [&](const Triangle& a, const Triangle& b) {
    return !HullTwin(points, {a, b}).contacts().empty();
  };
  EXPECT_FALSE(touch({0, 1, 2}, {1, 0, 3}));  // on an edge, at an angle
  EXPECT_FALSE(touch({0, 1, 2}, {2, 1, 7}));  // in a plane, side by side
  EXPECT_TRUE(touch({0, 1, 2}, {0, 1, 4}));   // on the same side
  EXPECT_TRUE(touch({0, 1, 2}, {1, 0, 2}));
  EXPECT_TRUE(touch({0, 1, 2}, {0, 5, 6}));   // on a vertex, through the far side
  EXPECT_FALSE(touch({0, 1, 2}, {1, 9, 3}));  // on a vertex, no more
  EXPECT_TRUE(touch({0, 1, 2}, {8, 5, 6}));   // a vertex on the far side
  EXPECT_FALSE(touch({0, 1, 2}, {7, 5, 6}));
  EXPECT_TRUE(touch({0, 1, 2}, {4, 3, 6}));  // a vertex inside
  EXPECT_TRUE(touch({0, 1, 9}, {2, 3, 7}));  // without area
}

TEST(hull_twin, counts_open_edges) {
  const std::vector<Point> points{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  EXPECT_EQ(HullTwin(points, tetrahedron).open_edges(), 0u);
  EXPECT_EQ(HullTwin(points, {{0, 2, 1}, {0, 1, 3}}).open_edges(), 4u);
  EXPECT_EQ(HullTwin(points, {{0, 2, 1}, {0, 3, 1}}).open_edges(), 5u);
}

}  // namespace
}  // namespace oracle::hull_twin_test
