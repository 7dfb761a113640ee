#include <snug/geometry/nearest_to_origin.h>

#include <gtest/gtest.h>
#include <support/direction.h>

#include <array>
#include <random>
#include <vector>

namespace snug::nearest_to_origin_test {
namespace {

Vector3 on_sphere(std::mt19937_64& random) {
  std::normal_distribution<double> normal;
  return normalized(Vector3{normal(random), normal(random), normal(random)});
}

// The hull is on the far side of the plane across z, and z is in the hull: a mean of points on the plane.
void expect_nearest(const std::vector<Vector3>& points, const Vector3& z) {
  const double square = length_sq(z);
  std::vector<Vector3> touching;
  for (const Vector3& p : points) {
    EXPECT_GE(dot(z, p), square - 1e-10);
    if (dot(z, p) <= square + 1e-9) touching.push_back(p);
  }
  ASSERT_FALSE(touching.empty());
  // No direction leads from z to all of the touching points: else a nearer point would be there.
  for (std::size_t i = 0; i < 2000; ++i) {
    std::mt19937_64 random(i);
    const Vector3 d = on_sphere(random);
    double least = INFINITY;
    for (const Vector3& p : touching) least = std::min(least, dot(d, p - z));
    EXPECT_LE(least, 1e-5);
  }
}

TEST(nearest_to_origin, is_in_the_hull_and_nearest) {
  std::mt19937_64 random(4);
  int inside = 0;
  for (int trial = 0; trial < 300; ++trial) {
    std::vector<Vector3> points(1 + random() % 12);
    const Vector3 towards = on_sphere(random);
    const double spread = std::array{0.01, 0.5, 1.0, 2.0}[random() % 4];
    for (Vector3& p : points) p = normalized(towards + spread * on_sphere(random));
    if (trial % 5 == 0) points.push_back(points[0]);
    const Vector3 z = nearest_to_origin(points);
    if (z == Vector3{}) {
      ++inside;
      // No half-space has all of them.
      for (int i = 0; i < 2000; ++i) {
        const Vector3 d = on_sphere(random);
        double least = INFINITY;
        for (const Vector3& p : points) least = std::min(least, dot(d, p));
        EXPECT_LT(least, 1e-6);
      }
    } else {
      expect_nearest(points, z);
    }
  }
  EXPECT_GT(inside, 20);
}

TEST(nearest_to_origin, of_special_sets) {
  EXPECT_EQ(nearest_to_origin(std::vector<Vector3>{{0, 2, 0}}), (Vector3{0, 2, 0}));
  EXPECT_LT(length(nearest_to_origin(std::vector<Vector3>{{0, 1, 0}, {0, -1, 0}})), 1e-15);
  EXPECT_LT(length(nearest_to_origin(std::vector<Vector3>{{1, 0, 0}, {-1, 1, 0}, {-1, -1, 0}})), 1e-15);
  const Vector3 cube = nearest_to_origin(std::vector<Vector3>{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {1, 0, 0}});
  EXPECT_LT(length(cube - Vector3{1.0 / 3, 1.0 / 3, 1.0 / 3}), 1e-15);
}

}  // namespace
}  // namespace snug::nearest_to_origin_test
