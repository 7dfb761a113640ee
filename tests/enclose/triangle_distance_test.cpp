#include <snug/enclose/triangle_distance.h>

#include <gtest/gtest.h>
#include <testing/containment.h>

#include <random>

namespace snug {
namespace {

using testing::Extended;

Extended at(const Triangle& t, long double b, long double c) {
  Extended p;
  for (std::size_t k = 0; k < 3; ++k) p[k] = t[0][k] + b * (t[1][k] - t[0][k]) + c * (t[2][k] - t[0][k]);
  return p;
}

// Upper bound of the distance by alternating projections from many starts, in extended precision.
long double sampled_distance(const Triangle& a, const Triangle& b) {
  long double best = INFINITY;
  constexpr int steps = 6;
  for (int i = 0; i <= steps; ++i) {
    for (int j = 0; i + j <= steps; ++j) {
      best = std::min(best, testing::distance_to_triangle(at(a, i / 6.0L, j / 6.0L), b));
      best = std::min(best, testing::distance_to_triangle(at(b, i / 6.0L, j / 6.0L), a));
    }
  }
  return best;
}

Triangle any_triangle(std::mt19937_64& random, double size, const Point3& centre) {
  std::uniform_real_distribution<double> unit(-size, size);
  Triangle t;
  for (Point3& p : t) p = centre + Vector3{unit(random), unit(random), unit(random)};
  if (random() % 4 == 0) t[2] = t[0] + 1e-8 * (t[2] - t[0]);  // needle
  if (random() % 8 == 0) t[2] = t[1];                         // segment
  return t;
}

TEST(nearest_triangles, never_claims_more_than_the_distance) {
  std::mt19937_64 random(20);
  for (int trial = 0; trial < 100000; ++trial) {
    const double size = std::ldexp(1.0, -static_cast<int>(random() % 30));
    const Point3 centre{1, -0.7, 0.3};
    const Triangle a = any_triangle(random, size, centre);
    Triangle b = any_triangle(random, size, centre + Vector3{size, 0, 0.5 * size});
    if (trial % 3 == 0) {  // parallel, a hair above
      const Vector3 n{0, 0, size * 1e-6};
      for (std::size_t k = 0; k < 3; ++k) b[k] = a[k] + n;
    }
    const NearestTriangles near = nearest(a, b);
    ASSERT_LE(near.certain_distance, sampled_distance(a, b) + 1e-18L) << trial;  // its own rounding
    ASSERT_GE(near.certain_distance, 0);
  }
}

TEST(nearest_triangles, is_as_good_as_the_points_it_finds) {
  std::mt19937_64 random(21);
  int loose = 0;
  for (int trial = 0; trial < 20000; ++trial) {
    const Triangle a = any_triangle(random, 0.5, {0, 0, 0}), b = any_triangle(random, 0.5, {0.8, 0, 0.5});
    const NearestTriangles near = nearest(a, b);
    const Extended p = at(a, near.on_a.b, near.on_a.c), q = at(b, near.on_b.b, near.on_b.c);
    const Extended d = testing::minus(p, q);
    const auto found = static_cast<double>(std::sqrt(testing::inner(d, d)));
    loose += near.certain_distance < found - 1e-7;
    ASSERT_LE(near.certain_distance, found);
  }
  EXPECT_LE(loose, 20);
}

TEST(nearest_triangles, sees_piercing_and_coplanar_overlap_as_contact) {
  const Triangle flat{Point3{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  const Triangle through{Point3{0.2, 0.2, -1}, {0.3, 0.2, 1}, {0.2, 0.3, 1}};
  EXPECT_EQ(nearest(flat, through).certain_distance, 0);
  EXPECT_EQ(nearest(through, flat).certain_distance, 0);
  const Triangle inside{Point3{0.1, 0.1, 0}, {0.2, 0.1, 0}, {0.1, 0.2, 0}};
  EXPECT_EQ(nearest(flat, inside).certain_distance, 0);
  EXPECT_EQ(nearest(flat, flat).certain_distance, 0);
}

}  // namespace
}  // namespace snug
