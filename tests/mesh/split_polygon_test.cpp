#include <snug/mesh/split_polygon.h>

#include <cmath>
#include <map>
#include <numbers>
#include <random>
#include <vector>

#include <gtest/gtest.h>

namespace snug::split_polygon_test {
namespace {

__extension__ using Wide = __int128;

using Polygon = std::vector<PlanePoint>;

double twice_area(const PlanePoint& a, const PlanePoint& b, const PlanePoint& c) {
  return (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);
}

double twice_area(const Polygon& polygon) {
  double sum = 0;
  for (std::size_t k = 1; k + 1 < polygon.size(); ++k)
    sum += twice_area(polygon[0], polygon[k], polygon[k + 1]);
  return sum;
}

TEST(split_polygon, sides_are_exact_a_unit_in_the_last_place_beside_a_line) {
  std::mt19937_64 random(1);
  for (int trial = 0; trial < 100'000; ++trial) {
    // Whole numbers below 2^50, so that the determinant fits 128 bits.
    const auto number = [&] { return static_cast<std::int64_t>(random() >> 14) - (std::int64_t{1} << 49); };
    const std::int64_t ax = number(), ay = number(), dx = number() >> 20, dy = number() >> 20;
    const std::int64_t t = static_cast<std::int64_t>(random() % 1000) - 500;
    const std::int64_t bx = ax + dx, by = ay + dy;
    const std::int64_t cx = ax + t * dx + static_cast<std::int64_t>(random() % 3) - 1,
                       cy = ay + t * dy + static_cast<std::int64_t>(random() % 3) - 1;
    const Wide area = static_cast<Wide>(bx - ax) * (cy - ay) - static_cast<Wide>(by - ay) * (cx - ax);
    const PlanePoint a{static_cast<double>(ax), static_cast<double>(ay)},
        b{static_cast<double>(bx), static_cast<double>(by)},
        c{static_cast<double>(cx), static_cast<double>(cy)};
    ASSERT_EQ(side_of(a, b, c), (area > 0) - (area < 0)) << trial;
  }
}

TEST(split_polygon, convex_polygons_turn_left_and_go_around_once) {
  EXPECT_TRUE(is_convex(Polygon{{0, 0}, {1, 0}, {0, 1}}));
  EXPECT_TRUE(is_convex(Polygon{{0, 0}, {1, 0}, {2, 0}, {2, 2}, {0, 2}, {0, 1}}));
  EXPECT_FALSE(is_convex(Polygon{{0, 0}, {0, 1}, {1, 0}}));                          // clockwise
  EXPECT_FALSE(is_convex(Polygon{{0, 0}, {4, 0}, {4, 2}, {2, 2}, {2, 4}, {0, 4}}));  // an L
  EXPECT_FALSE(is_convex(Polygon{{0, 0}, {2, 0}, {1, 0}, {1, 1}}));                  // runs back
  Polygon star;
  for (int k = 0; k < 5; ++k)
    star.push_back({std::cos(0.8 * std::numbers::pi * k), std::sin(0.8 * std::numbers::pi * k)});
  EXPECT_FALSE(is_convex(star));  // left turns alone, but around twice
}

void expect_split(const Polygon& polygon, std::size_t triangles_at_most) {
  const auto triangles = triangles_of(polygon);
  ASSERT_FALSE(triangles.empty());
  EXPECT_LE(triangles.size(), triangles_at_most);
  double area = 0;
  std::map<std::pair<std::uint32_t, std::uint32_t>, int> edges;
  for (const auto& t : triangles) {
    EXPECT_EQ(side_of(polygon[t[0]], polygon[t[1]], polygon[t[2]]), 1);
    area += twice_area(polygon[t[0]], polygon[t[1]], polygon[t[2]]);
    for (int k = 0; k < 3; ++k) {
      ++edges[{t[k], t[(k + 1) % 3]}];
      --edges[{t[(k + 1) % 3], t[k]}];
    }
  }
  EXPECT_NEAR(area, twice_area(polygon), 1e-9 * std::fabs(area));
  // As chains, the triangles' boundary is the polygon: with the areas positive they cover it, each point
  // once.
  for (std::uint32_t v = 0; v < polygon.size(); ++v)
    --edges[{v, static_cast<std::uint32_t>((v + 1) % polygon.size())}];
  for (const auto& [edge, count] : edges) {
    const bool reversed = edge.first == (edge.second + 1) % polygon.size();
    EXPECT_EQ(count, reversed ? -1 : 0) << edge.first << ' ' << edge.second;
  }
}

TEST(split_polygon, simple_polygons_become_triangles) {
  expect_split({{0, 0}, {4, 0}, {4, 2}, {2, 2}, {2, 4}, {0, 4}}, 4);
  expect_split({{0, 0}, {1, 0}, {2, 0}, {3, 0}, {3, 3}, {1.5, 1}}, 4);  // points on an edge
  std::mt19937_64 random(2);
  for (int trial = 0; trial < 300; ++trial) {
    Polygon
        polygon;  // seen from the middle, on a coarse grid half of the time, so that many points are in line
    const int n = 4 + trial % 40;
    for (int k = 0; k < n; ++k) {
      const double r = std::uniform_real_distribution<double>(1, 30)(random),
                   angle = 2 * std::numbers::pi * k / n;
      polygon.push_back({r * std::cos(angle), r * std::sin(angle)});
    }
    expect_split(polygon, polygon.size() - 2);
  }
}

TEST(split_polygon, combs_and_bridges_to_holes_become_triangles) {
  Polygon comb;
  for (int k = 0; k < 20; ++k)
    comb.insert(comb.end(), {{2.0 * k, 0}, {2.0 * k + 1, 0}, {2.0 * k + 1, 5}, {2.0 * k + 2, 5}});
  comb.insert(comb.end(), {{40, 9}, {0, 9}});
  expect_split(comb, comb.size() - 2);
  const Polygon bridged{{0, 0}, {6, 0}, {6, 6}, {0, 6}, {0, 0}, {2, 2}, {2, 4}, {4, 4}, {4, 2}, {2, 2}};
  const auto triangles = triangles_of(bridged);
  double area = 0;
  for (const auto& t : triangles) area += twice_area(bridged[t[0]], bridged[t[1]], bridged[t[2]]);
  EXPECT_EQ(triangles.size(), 8u);
  EXPECT_EQ(area, 2 * (36 - 4));
}

TEST(split_polygon, polygons_that_cross_themselves_are_given_back) {
  EXPECT_TRUE(triangles_of(Polygon{{0, 0}, {2, 2}, {2, 0}, {0, 2}}).empty());
  EXPECT_TRUE(triangles_of(Polygon{{0, 0}, {1, 0}, {2, 0}, {3, 0}}).empty());
}

TEST(split_polygon, dropping_a_coordinate_keeps_the_turn) {
  std::mt19937_64 random(3);
  std::normal_distribution<double> normal;
  for (int trial = 0; trial < 1000; ++trial) {
    const auto vector = [&] { return Vector3{normal(random), normal(random), normal(random)}; };
    const Vector3 a = vector(), b = vector();
    const std::vector<Point3> triangle{Point3{}, Point3{} + a, Point3{} + b};
    const auto flat = dropped_along(cross(a, b), triangle);
    EXPECT_EQ(side_of(flat[0], flat[1], flat[2]), 1);
  }
}

}  // namespace
}  // namespace snug::split_polygon_test
