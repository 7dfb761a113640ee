#include <snug/geometry/motion.h>

#include <gtest/gtest.h>
#include <support/error.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <random>
#include <string>

namespace snug::motion_test {
namespace {

using Numbers = std::array<double, 12>;
constexpr Numbers unmoved{1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0};

Numbers turned(double angle, double stretch = 1) {
  const double c = stretch * std::cos(angle), s = stretch * std::sin(angle);
  return {c, -s, 0, 1, s, c, 0, 2, 0, 0, stretch, 3};
}

// Message of the error that an action throws, or nothing.
template <class Action>
std::string refusal(Action&& action) {
  try {
    static_cast<void>(action());
  } catch (const InputError& error) {
    EXPECT_EQ(error.problem(), InputProblem::pose);
    return error.what();
  }
  return "";
}
std::string refusal_of(const Numbers& numbers) {
  return refusal([&] { return Motion::from_3x4(numbers); });
}
bool says(const std::string& text, const std::string& what) { return text.find(what) != std::string::npos; }

// det R
double determinant(const Numbers& m) {
  return dot(cross({m[0], m[4], m[8]}, {m[1], m[5], m[9]}), {m[2], m[6], m[10]});
}

// |R - M| squared, R and M being the 3x3 parts.
long double distance_sq(const Numbers& a, const Numbers& b) {
  long double sum = 0;
  for (std::size_t i = 0; i < 12; ++i) {
    const long double d = static_cast<long double>(a[i]) - b[i];
    if (i % 4 != 3) sum += d * d;
  }
  return sum;
}

double largest_difference(const Numbers& a, const Numbers& b) {
  double largest = 0;
  for (std::size_t i = 0; i < 12; ++i) largest = std::max(largest, std::fabs(a[i] - b[i]));
  return largest;
}

Vector3 random_direction(std::mt19937_64& random) {
  std::normal_distribution<double> normal;
  return {normal(random), normal(random), normal(random)};
}

Motion random_motion(std::mt19937_64& random) {
  std::normal_distribution<double> normal;
  return Motion::from_quaternion({normal(random), normal(random), normal(random), normal(random)},
                                 random_direction(random));
}

// A matrix of the given singular values between two random rotations, and t.
Numbers stretched(const Motion& left, const Vector3& singular_values, const Motion& right) {
  Numbers result = left.numbers();
  for (std::size_t i = 0; i < 3; ++i) {
    const Vector3 row{left.row(i).x * singular_values.x, left.row(i).y * singular_values.y,
                      left.row(i).z * singular_values.z};
    for (std::size_t j = 0; j < 3; ++j) {
      result[4 * i + j] = dot(row, {right.row(0)[j], right.row(1)[j], right.row(2)[j]});
    }
  }
  return result;
}

TEST(motion, takes_rigid_matrices_as_they_stand) {
  for (const Numbers& numbers : {unmoved, turned(0.7), turned(0.7, 1 + 4e-10)}) {
    const Motion motion = Motion::from_3x4(numbers);
    EXPECT_EQ(motion.numbers(), numbers);
    EXPECT_EQ(motion.defect(), rigidity_defect(numbers));
  }
  EXPECT_EQ(Motion(), Motion::from_3x4(unmoved));
  EXPECT_EQ(Motion::from_4x4({1, 0, 0, 5, 0, 1, 0, 6, 0, 0, 1, 7, 0, 0, 0, 1}),
            Motion::translation({5, 6, 7}));
}

TEST(motion, refuses_what_is_not_rigid_and_says_how_far_off) {
  const std::string off = refusal_of(turned(0.7, 1 + 2e-9));
  EXPECT_TRUE(says(off, "4e-09") && says(off, "1e-9") && says(off, "--nearest-rigid")) << off;
  const std::string scaled = refusal_of(turned(0.7, 25.4));
  EXPECT_TRUE(says(scaled, "it scales lengths by 25.4")) << scaled;
  const std::string sheared = refusal_of({1, 0.5, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0});
  EXPECT_TRUE(says(sheared, "0.5")) << sheared;
  const std::string huge = refusal_of({1e200, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0});
  EXPECT_TRUE(says(huge, "more than a double can hold")) << huge;
  EXPECT_NE(refusal_of({}), "");
}

TEST(motion, refuses_mirrors_and_what_is_not_finite) {
  EXPECT_TRUE(says(refusal_of({1, 0, 0, 0, 0, 1, 0, 0, 0, 0, -1, 0}), "mirrors"));
  EXPECT_TRUE(says(refusal_of({0, 1, 0, 0, 1, 0, 0, 0, 0, 0, 1, 0}), "mirrors"));
  EXPECT_TRUE(says(refusal_of({-1, 0, 0, 0, 0, -1 - 1e-8, 0, 0, 0, 0, -1, 0}), "mirrors"));
  EXPECT_TRUE(says(refusal_of({1, 0, 0, NAN, 0, 1, 0, 0, 0, 0, 1, 0}), "number 4 is not finite"));
  EXPECT_TRUE(says(refusal_of({1, 0, INFINITY, 0, 0, 1, 0, 0, 0, 0, 1, 0}), "number 3 is not finite"));
  for (const double bad : {NAN, INFINITY, -INFINITY}) {
    for (std::size_t i = 0; i < 12; ++i) {
      Numbers numbers = turned(0.3);
      numbers[i] = bad;
      EXPECT_NE(refusal_of(numbers), "");
      EXPECT_NE(refusal([&] { return nearest_rigid(numbers); }), "");
    }
    EXPECT_NE(refusal([&] { return Motion::translation({0, bad, 0}); }), "");
    EXPECT_NE(refusal([&] { return Motion::rotation({0, 0, 1}, bad); }), "");
    EXPECT_NE(refusal([&] { return Motion::rotation_degrees({0, 0, 1}, bad); }), "");
    EXPECT_NE(refusal([&] { return Motion::rotation({0, bad, 1}, 1); }), "");
    EXPECT_NE(refusal([&] { return Motion::from_quaternion({1, bad, 0, 0}); }), "");
    EXPECT_NE(refusal([&] { return Motion::from_quaternion({1, 0, 0, 0}, {bad, 0, 0}); }), "");
  }
  EXPECT_NE(refusal([] { return Motion::from_quaternion({0, 0, 0, 0}); }), "");
  EXPECT_NE(refusal([] { return Motion::rotation({}, 1); }), "");
}

TEST(motion, refuses_four_by_four_matrices_with_another_last_row) {
  EXPECT_NE(refusal([] { return Motion::from_4x4({1, 0, 0, 5, 0, 1, 0, 6, 0, 0, 1, 7, 0, 0, 0, 2}); }), "");
  const std::string transposed = refusal([] {
    return Motion::from_4x4({1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 5, 6, 7, 1});
  });
  EXPECT_TRUE(says(transposed, "row by row")) << transposed;
}

TEST(motion, defect_is_tiny_for_rotations_and_never_zero) {
  EXPECT_LT(rigidity_defect(turned(1.1)), 1e-14);
  EXPECT_GT(Motion().defect(), 0);
}

TEST(motion, made_from_angles_and_quaternions_is_rigid_within_some_roundings) {
  std::mt19937_64 random(1);
  std::uniform_real_distribution<double> angle(-720, 720);
  double worst = 0;
  for (int i = 0; i < 20000; ++i) {
    const double scale = std::ldexp(1.0, static_cast<int>(random() % 2000) - 1000);
    const Vector3 axis = scale * random_direction(random);
    for (const Motion& motion : {Motion::rotation(axis, angle(random)),
                                 Motion::rotation_degrees(axis, angle(random)), random_motion(random)}) {
      worst = std::max(worst, motion.defect());
      ASSERT_GT(determinant(motion.numbers()), 0.99);
    }
  }
  EXPECT_LE(worst, 32 * unit_roundoff) << worst / unit_roundoff;
}

TEST(motion, turns_counterclockwise_and_by_degrees_exactly_at_right_angles) {
  const Vector3 x{1, 0, 0}, y{0, 1, 0}, z{0, 0, 1};
  EXPECT_EQ(Motion::rotation_degrees(z, 90).numbers(), (Numbers{0, -1, 0, 0, 1, 0, 0, 0, 0, 0, 1, 0}));
  EXPECT_EQ(Motion::rotation_degrees({0, 0, 7}, -270), Motion::rotation_degrees(z, 90));
  EXPECT_EQ(Motion::rotation_degrees(x, 180).numbers(), (Numbers{1, 0, 0, 0, 0, -1, 0, 0, 0, 0, -1, 0}));
  EXPECT_EQ(Motion::rotation_degrees(y, 36000360), Motion());
  std::mt19937_64 random(2);
  std::uniform_real_distribution<double> angle(-7, 7);
  for (int i = 0; i < 1000; ++i) {
    const Vector3 axis = random_direction(random);
    const double a = angle(random);
    const Motion motion = Motion::rotation(axis, a);
    const Motion degrees = Motion::rotation_degrees(axis, a * 180 / std::numbers::pi);
    ASSERT_LT(largest_difference(motion.numbers(), degrees.numbers()), 1e-14);
    const double n = length(axis), s = std::sin(a / 2) / n;
    const Motion quaternion = Motion::from_quaternion({std::cos(a / 2), s * axis.x, s * axis.y, s * axis.z});
    ASSERT_LT(largest_difference(motion.numbers(), quaternion.numbers()), 1e-14);
    ASSERT_LT(length(motion.rotate(axis) - axis), 1e-14 * n);
  }
}

TEST(motion, quaternions_of_any_length_turn_alike) {
  const Motion motion = Motion::from_quaternion({0.1, -0.2, 0.3, 0.4}, {1, 2, 3});
  for (const double scale : {1e-300, 1e-3, 7.0, 1e300, -1.0}) {
    const Motion other =
        Motion::from_quaternion({0.1 * scale, -0.2 * scale, 0.3 * scale, 0.4 * scale}, {1, 2, 3});
    EXPECT_LT(largest_difference(motion.numbers(), other.numbers()), 1e-15);
  }
}

// As robots and game engines have them: a matrix made of these in single precision is off by some 1e-7.
TEST(motion, quaternions_in_single_precision_work) {
  std::mt19937_64 random(3);
  int refused = 0;
  for (int i = 0; i < 1000; ++i) {
    std::normal_distribution<double> normal;
    const double a = normal(random), b = normal(random), c = normal(random), d = normal(random);
    const double n = std::sqrt(a * a + b * b + c * c + d * d);
    const double w = static_cast<float>(a / n), x = static_cast<float>(b / n), y = static_cast<float>(c / n),
                 z = static_cast<float>(d / n);
    const Motion motion = Motion::from_quaternion({w, x, y, z});
    ASSERT_LT(motion.defect(), 24 * unit_roundoff);
    const Numbers matrix{1 - 2 * (y * y + z * z), 2 * (x * y - w * z),     2 * (x * z + w * y),     1,
                         2 * (x * y + w * z),     1 - 2 * (x * x + z * z), 2 * (y * z - w * x),     2,
                         2 * (x * z - w * y),     2 * (y * z + w * x),     1 - 2 * (x * x + y * y), 3};
    refused += !refusal_of(matrix).empty();
    const NearestRigid near = nearest_rigid(matrix);
    ASSERT_LT(near.change, 2e-7);
    ASSERT_EQ(near.defect, rigidity_defect(matrix));
    ASSERT_LT(near.motion.defect(), 24 * unit_roundoff);
    ASSERT_EQ(near.motion.offset(), (Vector3{1, 2, 3}));
  }
  EXPECT_GT(refused, 900);
}

TEST(motion, composes_and_inverts) {
  std::mt19937_64 random(4);
  for (int i = 0; i < 2000; ++i) {
    const Motion a = random_motion(random), b = random_motion(random);
    const Point3 p{1, -2, 3};
    ASSERT_LT(distance((a * b).apply(p), a.apply(b.apply(p))), 1e-14);
    ASSERT_LT(largest_difference((a.inverse() * a).numbers(), unmoved), 1e-14);
    ASSERT_LT(largest_difference((a * a.inverse()).numbers(), unmoved), 1e-14);
  }
  // The inverse of what is only nearly rigid is not its transpose.
  const Motion nearly = Motion::from_3x4(turned(0.7, 1 + 4e-10));
  EXPECT_LT(distance(nearly.inverse().apply(nearly.apply({1, -2, 3})), {1, -2, 3}), 1e-14);
  EXPECT_NE(refusal([] {
              const Motion far = Motion::translation({1e308, 0, 0});
              return far * far;
            }),
            "");
}

TEST(motion, products_that_drift_stay_motions) {
  const Motion nearly = Motion::from_3x4(turned(0.7, 1 + 4e-10));
  Motion product;
  bool mended = false;
  for (int i = 0; i < 1000; ++i) {
    const Motion next = nearly * product;
    ASSERT_LE(next.defect(), rigidity_tolerance);
    mended = mended || next.defect() < product.defect();
    product = next;
  }
  EXPECT_TRUE(mended);
  const Motion exact = Motion::rotation({0, 0, 1}, 1000 * 0.7);
  for (std::size_t i = 0; i < 3; ++i) EXPECT_LT(max_abs(product.row(i) - exact.row(i)), 1e-11);
  for (int i = 0; i < 100; ++i) product = product.inverse() * nearly.inverse();
  EXPECT_LE(product.defect(), rigidity_tolerance);
}

TEST(nearest_rigid, finds_the_polar_factor_of_matrices_of_known_singular_values) {
  std::mt19937_64 random(5);
  std::uniform_real_distribution<double> decades(-5, 0);
  for (int i = 0; i < 5000; ++i) {
    const Motion left = random_motion(random), right = random_motion(random);
    const double size = std::pow(10.0, static_cast<double>(random() % 300) - 150);
    const Vector3 values =
        size * Vector3{1, std::pow(10.0, decades(random)), std::pow(10.0, decades(random))};
    const Numbers matrix = stretched(left, values, right);
    const NearestRigid near = nearest_rigid(matrix);
    ASSERT_LT(near.motion.defect(), 24 * unit_roundoff);
    ASSERT_GT(determinant(near.motion.numbers()), 0);
    Numbers expected = stretched(left, {1, 1, 1}, right);
    const double condition = size / (values.y + values.z);
    ASSERT_LT(largest_difference(near.motion.numbers(), expected), 1e-14 * (1 + condition)) << i;
  }
}

TEST(nearest_rigid, no_rotation_around_is_nearer) {
  std::mt19937_64 random(6);
  std::normal_distribution<double> normal;
  int tried = 0;
  while (tried < 500) {
    Numbers matrix{};
    for (double& x : matrix) x = normal(random);
    if (determinant(matrix) < 0.1) continue;
    ++tried;
    const Motion near = nearest_rigid(matrix).motion;
    const long double best = distance_sq(near.numbers(), matrix);
    for (int i = 0; i < 50; ++i) {
      const double angle = std::pow(10.0, -6 * static_cast<double>(random() >> 11) * 0x1p-53);
      const Motion other = Motion::rotation(random_direction(random), angle) * near;
      ASSERT_GE(distance_sq(other.numbers(), matrix), best - 1e-14L * (1 + best));
    }
  }
}

TEST(nearest_rigid, keeps_motions_but_for_roundings) {
  std::mt19937_64 random(7);
  for (int i = 0; i < 2000; ++i) {
    const Motion motion = random_motion(random);
    const NearestRigid near = nearest_rigid(motion.numbers());
    ASSERT_LT(largest_difference(near.motion.numbers(), motion.numbers()), 2e-15);
    ASSERT_LT(near.change, 2e-15);
  }
  EXPECT_EQ(nearest_rigid(unmoved).motion, Motion());
}

TEST(nearest_rigid, refuses_singular_and_mirrored_matrices) {
  const auto refused = [](const Numbers& m) { return refusal([&] { return nearest_rigid(m); }); };
  EXPECT_TRUE(says(refused({}), "singular"));
  EXPECT_TRUE(says(refused({1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 0, 0}), "singular"));
  EXPECT_TRUE(says(refused({1, 2, 3, 0, 4, 5, 6, 0, 7, 8, 9, 0}), "singular"));
  EXPECT_TRUE(says(refused({1, 0, 0, 0, 0, 1, 0, 0, 0, 0, -1, 0}), "mirrors"));
  EXPECT_TRUE(says(refused({0, 3, 0, 0, 2, 0, 0, 0, 0, 0, 1, 0}), "mirrors"));
  std::mt19937_64 random(8);
  for (int i = 0; i < 2000; ++i) {
    const Motion left = random_motion(random), right = random_motion(random);
    ASSERT_TRUE(says(refused(stretched(left, {2, 1, -0.1}, right)), "mirrors"));
    ASSERT_TRUE(says(refused(stretched(left, {2, 1, 1e-14}, right)), "singular"));
    ASSERT_EQ(refused(stretched(left, {2, 1, 1e-10}, right)), "");
  }
}

}  // namespace
}  // namespace snug::motion_test
