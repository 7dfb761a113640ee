#include <snug/geometry/triangle.h>

#include <gtest/gtest.h>
#include <testing/containment.h>

#include <random>

namespace snug::triangle_test {
namespace {

Vector3 any_point(std::mt19937_64& random, double size) {
  std::uniform_real_distribution<double> unit(-size, size);
  return {unit(random), unit(random), unit(random)};
}

TEST(triangle_foot, is_feasible_and_nearest) {
  std::mt19937_64 random(19);
  for (int trial = 0; trial < 200000; ++trial) {
    const Vector3 a = any_point(random, 1);
    Vector3 b = any_point(random, 1), c = any_point(random, 1);
    if (trial % 5 == 1) c = a + 1e-9 * (c - a);                   // needle
    if (trial % 5 == 2) c = a + 0.4 * (b - a) + 1e-12 * (c - a);  // sliver
    if (trial % 5 == 3) c = b = a + 1e-3 * (b - a);               // segment
    if (trial % 500 == 4) b = c = a;                              // point
    const TriangleFoot foot(a, b, c);
    const Vector3 p = any_point(random, 1.5);
    const Barycentric at = foot(p);
    ASSERT_TRUE(at.b >= 0 && at.c >= 0 && at.b + at.c <= 1);
    const double found = length(p - (a + at.b * (b - a) + at.c * (c - a)));
    const Triangle triangle{Point3{} + a, Point3{} + b, Point3{} + c};
    const auto exact = static_cast<double>(testing::distance_to_triangle({p.x, p.y, p.z}, triangle));
    ASSERT_NEAR(found, exact, 1e-9) << trial;
  }
}

}  // namespace
}  // namespace snug::triangle_test
