#include <snug/geometry/point_triangle.h>

#include <gtest/gtest.h>
#include <oracle/polyhedron_twin.h>
#include <snug/geometry/double_double.h>
#include <testing/counts.h>

#include <cmath>
#include <random>

namespace snug::point_triangle_test {
namespace {

double unit(std::mt19937_64& random) { return static_cast<double>(random() >> 11) * 0x1p-52 - 1; }

oracle::Point of(const Point3& p) { return {p.x, p.y, p.z}; }

mpq_class exact(DoubleDouble x) { return mpq_class(x.high) + mpq_class(x.low); }

TEST(double_double, sums_and_products_are_exact_and_the_rest_nearly_so) {
  std::mt19937_64 random(3);
  for (int trial = 0; trial < static_cast<int>(testing::fewer(20000)); ++trial) {
    const auto any = [&] { return std::ldexp(unit(random), static_cast<int>(random() % 80) - 60); };
    const double x = any(), y = trial % 5 == 0 ? -x * (1 + 0x1p-50 * unit(random)) : any();
    ASSERT_EQ(exact(exact_sum(x, y)), mpq_class(x) + mpq_class(y));
    ASSERT_EQ(exact(exact_product(x, y)), mpq_class(x) * mpq_class(y));
    const DoubleDouble a = exact_product(x, any()), b = exact_product(y, any());
    const auto near = [&](const mpq_class& found, const mpq_class& wanted) {
      return abs(found - wanted) <= mpq_class(0x1p-100) * abs(wanted);
    };
    EXPECT_TRUE(near(exact(a + b), exact(a) + exact(b))) << trial;
    EXPECT_TRUE(near(exact(a - b), exact(a) - exact(b))) << trial;
    EXPECT_TRUE(near(exact(a * b), exact(a) * exact(b))) << trial;
    if (b.high == 0) continue;
    EXPECT_TRUE(near(exact(a / b), exact(a) / exact(b))) << trial;
  }
}

// Triangles, needles, segments and points of all sizes; points above faces, edges and corners, far, near, and on them.
struct Drawn {
  Triangle triangle;
  Point3 point;
};
Drawn draw(std::mt19937_64& random) {
  const double size = std::ldexp(1.0, -static_cast<int>(random() % 40));
  const auto any = [&](double by) { return by * Vector3{unit(random), unit(random), unit(random)}; };
  const Point3 centre = random() % 3 == 0 ? Point3{} : Point3{} + any(1);
  Drawn drawn{};
  for (Point3& p : drawn.triangle) p = centre + any(size);
  Triangle& t = drawn.triangle;
  if (random() % 4 == 0) t[2] = t[0] + std::ldexp(1.0, -static_cast<int>(random() % 50)) * (t[2] - t[0]);
  if (random() % 4 == 0) t[2] = t[1] + std::ldexp(1.0, -static_cast<int>(random() % 60)) * any(size);
  if (random() % 16 == 0) t[2] = t[1];
  if (random() % 40 == 0) t[1] = t[2] = t[0];
  std::array<double, 3> weights{std::fabs(unit(random)), std::fabs(unit(random)), std::fabs(unit(random))};
  for (double& w : weights) w = random() % 3 == 0 ? 0 : w;
  const double sum = std::max(weights[0] + weights[1] + weights[2], 1e-300);
  drawn.point = t[0] + (weights[1] / sum) * (t[1] - t[0]) + (weights[2] / sum) * (t[2] - t[0]);
  switch (random() % 4) {
    case 0:
      break;
    case 1:
      drawn.point = drawn.point + any(std::ldexp(size, -static_cast<int>(random() % 60)));
      break;
    case 2:
      drawn.point = drawn.point + any(4 * size);
      break;
    default:
      drawn.point = drawn.point + any(std::ldexp(1.0, static_cast<int>(random() % 40)));
  }
  return drawn;
}

TEST(point_triangle, bounds_hold_and_are_some_roundings_apart) {
  std::mt19937_64 random(4);
  int narrow = 0, all = 0;
  for (int trial = 0; trial < static_cast<int>(testing::fewer(12000)) && !HasFailure(); ++trial) {
    const auto [triangle, point] = draw(random);
    const oracle::PolyhedronTwin twin({of(triangle[0]), of(triangle[1]), of(triangle[2])}, {{0, 1, 2}});
    const mpq_class square = twin.squared_distance(of(point));
    double coordinates = max_abs(point - Point3{});
    for (const Point3& p : triangle) coordinates = std::max(coordinates, max_abs(p - Point3{}));
    for (const double size : {coordinates, 0.0}) {
      const auto [lower, upper, foot] = distance_between(point, triangle, size);
      ASSERT_LE(mpq_class(lower) * mpq_class(lower), square) << trial;
      ASSERT_GE(mpq_class(upper) * mpq_class(upper), square) << trial;
      ASSERT_GE(lower, 0);
      // The foot is in the triangle, and as near.
      const mpq_class b(foot.b), c(foot.c);
      ASSERT_TRUE(b >= 0 && c >= 0 && b + c <= 1) << trial;
      mpq_class there = 0;
      for (std::size_t k = 0; k < 3; ++k) {
        const mpq_class p0(triangle[0][k]), p1(triangle[1][k]), p2(triangle[2][k]);
        const mpq_class off = mpq_class(point[k]) - p0 - b * (p1 - p0) - c * (p2 - p0);
        there += off * off;
      }
      ASSERT_LE(there, mpq_class(upper) * mpq_class(upper)) << trial;
      if (size > 0) {
        ASSERT_LE(upper - lower, 0x1p-46 * std::max(upper, size)) << trial;
      } else {
        ++all;
        narrow += upper - lower <= 0x1p-46 * upper;
      }
    }
  }
  EXPECT_GT(20 * narrow, 14 * all);  // all others are on the triangle, or nearly so
}

TEST(facing, of_facets_at_a_corner_the_steepest_edge_counts_first) {
  // A steep facet over a flatter one, on one side of a corner: it is steep the other way.
  const Triangle above{{{0, 0, 0}, {1, 0, -0.35}, {0.98, 0.2, -0.73}}},
      below{{{0, 0, 0}, {1, 0.2, -0.5}, {1, -0.2, -0.5}}};
  const Point3 point{0, 0, 1};
  EXPECT_LT(facing(point, above, {0, 0}).cosine, facing(point, below, {0, 0}).cosine);
  EXPECT_TRUE(facing(point, above, {0, 0}).better_than(facing(point, below, {0, 0})));
  EXPECT_FALSE(facing(point, below, {0, 0}).better_than(facing(point, above, {0, 0})));
  // At an edge the one that is seen more from above.
  const Triangle roof{{{0, 0, 0}, {1, 0, 0}, {0, 1, -0.1}}}, wall{{{1, 0, 0}, {0, 0, 0}, {0, -1, -3}}};
  EXPECT_TRUE(facing({0.5, 0, 1}, roof, {0.5, 0}).better_than(facing({0.5, 0, 1}, wall, {0.5, 0})));
}

}  // namespace
}  // namespace snug::point_triangle_test
