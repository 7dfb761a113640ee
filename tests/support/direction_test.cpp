#include <support/direction.h>

#include <gtest/gtest.h>

#include <limits>
#include <random>

namespace snug::direction_test {
namespace {

TEST(direction, has_length_one_for_vectors_of_every_length) {
  std::mt19937_64 random(7);
  std::uniform_real_distribution<double> coordinate(-1, 1);
  for (int exponent = -1070; exponent <= 1022; ++exponent) {
    const Vector3 v{coordinate(random), coordinate(random), coordinate(random)};
    const Vector3 long_one = PowerOfTwo(exponent).apply(v), n = normalized(long_one);
    if (long_one == Vector3{}) continue;
    EXPECT_NEAR(length(n), 1, 5 * 0x1p-53 + 0x1p-52) << exponent;
    // Denormals have few digits.
    if (exponent >= -1000) {
      EXPECT_EQ(n, normalized(v)) << exponent;
    }
  }
  const double tiny = std::numeric_limits<double>::denorm_min(), most = std::numeric_limits<double>::max();
  EXPECT_EQ(normalized({0, -tiny, 0}), (Vector3{0, -1, 0}));
  EXPECT_NEAR(length(normalized({most, -most, most})), 1, 0x1p-50);
}

TEST(direction, of_a_vector_that_has_none_is_zero) {
  const double infinity = std::numeric_limits<double>::infinity(),
               nan = std::numeric_limits<double>::quiet_NaN();
  for (const double bad : {infinity, -infinity, nan}) {
    EXPECT_EQ(normalized({1, bad, 2}), Vector3{});
    EXPECT_EQ(normalized({bad, 0, 0}), Vector3{});
    EXPECT_EQ(normalized({0, 0, bad}), Vector3{});
  }
  EXPECT_EQ(normalized({0, -0.0, 0}), Vector3{});
}

}  // namespace
}  // namespace snug::direction_test
