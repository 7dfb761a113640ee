#include <snug/bvh/carried_axes.h>

#include <gtest/gtest.h>
#include <snug/geometry/motion.h>

#include <cmath>
#include <random>

namespace snug::carried_axes_test {
namespace {

double off_orthonormal(const Axes& axes) {
  double most = 0;
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t j = 0; j < 3; ++j) {
      most = std::max(most, std::fabs(dot(axes[i], axes[j]) - (i == j ? 1 : 0)));
    }
  }
  return std::isfinite(most) ? most : INFINITY;
}

class CarriedAxesTest : public ::testing::Test {
 protected:
  double unit() { return std::uniform_real_distribution<double>(-1, 1)(random_); }
  Point3 point() { return {unit(), unit(), unit()}; }
  Triangle triangle() { return {point(), point(), point()}; }
  Axes axes() { return orthonormal_axes(point() - Point3{}, point() - Point3{}); }
  std::mt19937_64 random_{3};
};

TEST_F(CarriedAxesTest, turn_with_their_points) {
  for (int i = 0; i < 2000; ++i) {
    const Axes before = axes();
    const Triangle points = triangle();
    if (length(cross(points[1] - points[0], points[2] - points[0])) < 0.01) continue;
    const Motion motion = Motion::from_quaternion({unit(), unit(), unit(), unit()}, {unit(), unit(), unit()});
    const double scale = std::ldexp(1.0, static_cast<int>(random_() % 40) - 38);
    Triangle now;
    for (std::size_t k = 0; k < 3; ++k) {
      const Vector3 moved = scale * (motion.apply(points[k]) - Point3{});
      now[k] = Point3{} + moved;
    }
    const Axes after = CarriedAxes(before, points).at(now);
    for (std::size_t k = 0; k < 3; ++k) {
      EXPECT_LT(max_abs(after[k] - motion.rotate(before[k])), 1e-10) << i;
    }
  }
}

// The proofs of boxes want no more than this.
TEST_F(CarriedAxesTest, are_orthonormal_up_to_a_few_roundings_whatever_the_points) {
  const std::array<Triangle, 6> odd{Triangle{},
                                    Triangle{point(), point(), point()},
                                    Triangle{Point3{1, 0, 0}, Point3{2, 0, 0}, Point3{3, 0, 0}},
                                    Triangle{Point3{0, 0, 0}, Point3{1e-300, 0, 0}, Point3{0, 1e-300, 0}},
                                    Triangle{Point3{0, 0, 0}, Point3{2, 0, 0}, Point3{1, 1e-17, 0}},
                                    Triangle{Point3{0, 0, 0}, Point3{1e-160, 0, 0}, Point3{0, 2, 0}}};
  double most = 0;
  for (const Triangle& before : odd) {
    for (const Triangle& after : odd) {
      for (int i = 0; i < 200; ++i) {
        most = std::max(most, off_orthonormal(CarriedAxes(axes(), before).at(after)));
      }
    }
  }
  for (int i = 0; i < 200'000; ++i) {
    // Nearly in one plane, or on one line, more or less.
    Triangle before = triangle(), after = triangle();
    const double flat = std::ldexp(1.0, -static_cast<int>(random_() % 60));
    after[2] = after[0] + unit() * (after[1] - after[0]) + flat * (point() - Point3{});
    most = std::max(most, off_orthonormal(CarriedAxes(axes(), before).at(after)));
  }
  EXPECT_LT(most, 16 * 0x1p-53);
}

TEST_F(CarriedAxesTest, spread_points_are_far_from_each_other) {
  std::vector<Point3> points;
  for (int i = 0; i < 40; ++i) points.push_back({0.01 * unit(), 0.01 * unit(), 0.01 * unit()});
  points[17] = {5, 0, 0};
  points[31] = {2, 3, 0};
  const auto chosen = spread_points(points);
  EXPECT_EQ(chosen[1], 17u);
  EXPECT_EQ(chosen[2], 31u);
  EXPECT_EQ(spread_points(std::vector<Point3>{{1, 1, 1}}), (std::array<std::size_t, 3>{0, 0, 0}));
}

}  // namespace
}  // namespace snug::carried_axes_test
