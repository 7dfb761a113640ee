#include <picture/polyhedron.h>

#include <gtest/gtest.h>

#include <map>
#include <random>
#include <set>
#include <utility>

namespace snug::polyhedron_test {
namespace {

Box3 box(Point3 lower, Vector3 sides) { return {lower, lower + sides}; }

IntervalTriangle translates(Point3 a, Point3 b, Point3 c, Vector3 sides) {
  return {{box(a, sides), box(b, sides), box(c, sides)}};
}

std::vector<Point3> corners_of(const IntervalTriangle& triangle) {
  std::vector<Point3> corners;
  for (const Box3& b : triangle.corner) {
    for (unsigned i = 0; i < 8; ++i) {
      corners.push_back(
          {i & 1 ? b.upper.x : b.lower.x, i & 2 ? b.upper.y : b.lower.y, i & 4 ? b.upper.z : b.lower.z});
    }
  }
  return corners;
}

// Twice the area of a polygon, along its normal.
Vector3 area(const Polyhedron& solid, const std::vector<std::uint32_t>& facet) {
  Vector3 sum;
  for (std::size_t i = 1; i + 1 < facet.size(); ++i) {
    sum = sum + cross(solid.points[facet[i]] - solid.points[facet[0]],
                      solid.points[facet[i + 1]] - solid.points[facet[0]]);
  }
  return sum;
}

double volume(const Polyhedron& solid) {
  double sum = 0;
  for (const auto& facet : solid.facets)
    sum += dot(area(solid, facet), solid.points[facet[0]] - solid.points[0]) / 6;
  return sum;
}

// Each half-edge once, with its twin; every point in use; Euler's formula.
void expect_closed(const Polyhedron& solid) {
  std::set<std::pair<std::uint32_t, std::uint32_t>> half_edges;
  std::set<std::uint32_t> used;
  for (const auto& facet : solid.facets) {
    EXPECT_GE(facet.size(), 3u);
    for (std::size_t i = 0; i < facet.size(); ++i) {
      used.insert(facet[i]);
      EXPECT_TRUE(half_edges.emplace(facet[i], facet[(i + 1) % facet.size()]).second);
    }
  }
  for (const auto& [from, to] : half_edges) EXPECT_TRUE(half_edges.contains({to, from}));
  EXPECT_EQ(used.size(), solid.points.size());
  EXPECT_EQ(solid.points.size() + solid.facets.size(), half_edges.size() / 2 + 2);
}

// No corner of the boxes is above a facet's plane by more than the lattice explains, and facets are planar
// and convex.
void expect_contains(const Polyhedron& solid, const IntervalTriangle& triangle) {
  const double tolerance = 1e-12;
  for (const auto& facet : solid.facets) {
    const Vector3 twice = area(solid, facet), normal = (1 / length(twice)) * twice;
    const Point3 on = solid.points[facet[0]];
    for (const Point3& p : corners_of(triangle)) EXPECT_LE(dot(normal, p - on), tolerance);
    for (std::size_t i = 0; i < facet.size(); ++i) {
      const Point3 a = solid.points[facet[i]], b = solid.points[facet[(i + 1) % facet.size()]],
                   c = solid.points[facet[(i + 2) % facet.size()]];
      EXPECT_NEAR(dot(normal, a - on), 0, tolerance);
      EXPECT_GT(dot(cross(b - a, c - b), normal), 0);
    }
  }
}

TEST(polyhedron, of_a_generic_interval_triangle_has_17_facets) {
  const IntervalTriangle t = translates({0, 0, 0}, {1, 0.2, 0.1}, {0.3, 0.9, 0.4}, {0.1, 0.15, 0.2});
  const Polyhedron solid = hull_of_boxes(t);
  EXPECT_EQ(solid.facets.size(), 17u);  // 6 of the boxes, 2 of the triangle, 3 an edge of it
  std::map<std::size_t, int> sizes;
  for (const auto& facet : solid.facets) ++sizes[facet.size()];
  EXPECT_EQ(sizes[3], 2);
  expect_closed(solid);
  expect_contains(solid, t);
}

TEST(polyhedron, contains_all_corners_of_random_boxes) {
  constexpr unsigned seed = 20240517;
  SCOPED_TRACE(seed);
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> coordinate(-0.5, 0.5), side(0, 0.3);
  std::uniform_int_distribution<int> coarse(-2, 2), choice(0, 3);
  for (int trial = 0; trial < 1500; ++trial) {
    IntervalTriangle t;
    const bool on_grid = choice(random) < 2;  // ties everywhere
    const bool equal = choice(random) == 0;
    Vector3 shared;
    for (std::size_t k = 0; k < 3; ++k) {
      Point3 lower;
      Vector3 sides;
      for (std::size_t axis = 0; axis < 3; ++axis) {
        lower[axis] = on_grid ? 0.125 * coarse(random) : coordinate(random);
        sides[axis] = choice(random) == 0 ? 0 : on_grid ? 0.0625 * (coarse(random) + 2) : side(random);
      }
      if (k == 0) shared = sides;
      t.corner[k] = box(lower, equal ? shared : sides);
    }
    const Polyhedron solid = hull_of_boxes(t);
    EXPECT_LE(solid.facets.size(), equal ? 17u : 38u);
    if (solid.facets.empty()) continue;
    expect_closed(solid);
    expect_contains(solid, t);
    ASSERT_FALSE(::testing::Test::HasFailure()) << "trial " << trial;
  }
}

TEST(polyhedron, of_three_equal_boxes_is_the_box) {
  const Polyhedron solid = hull_of_boxes(translates({1, 2, 3}, {1, 2, 3}, {1, 2, 3}, {0.5, 0.25, 0.125}));
  EXPECT_EQ(solid.points.size(), 8u);
  EXPECT_EQ(solid.facets.size(), 6u);
  expect_closed(solid);
  EXPECT_DOUBLE_EQ(volume(solid), 0.5 * 0.25 * 0.125);
}

TEST(polyhedron, of_boxes_in_a_row_merges_their_coplanar_sides) {
  const Polyhedron solid = hull_of_boxes(translates({0, 0, 0}, {2, 0, 0}, {1, 0, 0}, {1, 1, 1}));
  EXPECT_EQ(solid.points.size(), 8u);
  EXPECT_EQ(solid.facets.size(), 6u);
  expect_closed(solid);
  EXPECT_DOUBLE_EQ(volume(solid), 3);
}

TEST(polyhedron, of_points_is_the_triangle_from_both_sides) {
  const Polyhedron solid = hull_of_boxes(translates({0, 0, 0}, {1, 0, 0.5}, {0, 1, 0.25}, {0, 0, 0}));
  EXPECT_EQ(solid.points.size(), 3u);
  ASSERT_EQ(solid.facets.size(), 2u);
  expect_closed(solid);
  EXPECT_EQ(area(solid, solid.facets[0]), -area(solid, solid.facets[1]));
}

TEST(polyhedron, of_flat_boxes_in_a_plane_is_a_polygon_from_both_sides) {
  const Polyhedron solid = hull_of_boxes(translates({0, 0, 1}, {1, 0.5, 1}, {0.25, 2, 1}, {0.25, 0.25, 0}));
  EXPECT_EQ(solid.facets.size(), 2u);
  expect_closed(solid);
}

TEST(polyhedron, of_a_segment_or_a_point_has_no_facets) {
  const Polyhedron segment = hull_of_boxes(translates({0, 0, 0}, {1, 1, 1}, {0.5, 0.5, 0.5}, {0, 0, 0}));
  EXPECT_TRUE(segment.facets.empty());
  EXPECT_EQ(segment.points.size(), 2u);
  const Polyhedron point = hull_of_boxes(translates({7, 7, 7}, {7, 7, 7}, {7, 7, 7}, {0, 0, 0}));
  EXPECT_TRUE(point.facets.empty());
  ASSERT_EQ(point.points.size(), 1u);
  EXPECT_EQ(point.points[0], (Point3{7, 7, 7}));
}

TEST(polyhedron, far_from_the_origin_and_of_any_size_is_the_same) {
  const Vector3 sides{0.125, 0.25, 0.375};
  const Point3 a{0, 0, 0}, b{1, 0.25, 0.125}, c{0.25, 1, 0.5};
  const Polyhedron near = hull_of_boxes(translates(a, b, c, sides));
  for (const double scale : {0x1p-1000, 1.0, 0x1p+900}) {
    for (const double offset : {0.0, 0x1p+40}) {
      const auto moved = [&](Point3 p) {
        return Point3{} + scale * (p - Point3{} + Vector3{offset, -offset, offset});
      };
      const Polyhedron solid = hull_of_boxes(translates(moved(a), moved(b), moved(c), scale * sides));
      EXPECT_EQ(solid.facets, near.facets);
      ASSERT_EQ(solid.points.size(), near.points.size());
      for (std::size_t i = 0; i < near.points.size(); ++i) EXPECT_EQ(solid.points[i], moved(near.points[i]));
    }
  }
}

}  // namespace
}  // namespace snug::polyhedron_test
