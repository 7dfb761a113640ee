#include <snug/geometry/angles.h>

#include <cmath>
#include <random>

#include <gtest/gtest.h>

namespace snug::angles_test {
namespace {

// At most half a unit in the last place away, up to the precision of a long double.
::testing::AssertionResult nearest(double found, long double exact) {
  const double size = std::fabs(found);
  const long double unit = static_cast<long double>(std::nextafter(size, INFINITY)) - size;
  if (std::fabs(found - exact) <= unit / 2 * (1 + 0x1p-8L)) return ::testing::AssertionSuccess();
  return ::testing::AssertionFailure()
         << found << " is off by " << static_cast<double>((found - exact) / unit)
         << " units in the last place";
}

TEST(angles, sines_and_cosines_are_the_nearest_doubles) {
#ifdef __MINGW32__
  GTEST_SKIP() << "sines of long doubles are those of fsin there, ten units in the last place off";
#endif
  std::mt19937_64 random(1);
  for (int trial = 0; trial < 100'000; ++trial) {
    const double size = std::ldexp(1.0, static_cast<int>(random() % 60) - 30);
    const double x = std::uniform_real_distribution<double>(-size, size)(random);
    if (std::fabs(x) > 1e9) continue;
    const auto [sine, cosine] = nearest_turn(x);
    ASSERT_TRUE(nearest(sine, std::sin(static_cast<long double>(x)))) << x;
    ASSERT_TRUE(nearest(cosine, std::cos(static_cast<long double>(x)))) << x;
  }
  // Next to multiples of a quarter of a turn most digits of the argument cancel.
  for (int k = 1; k < 20'000; ++k) {
    const double x = k * 1.57079632679489661923;
    const auto [sine, cosine] = nearest_turn(x);
    ASSERT_TRUE(nearest(sine, std::sin(static_cast<long double>(x)))) << k;
    ASSERT_TRUE(nearest(cosine, std::cos(static_cast<long double>(x)))) << k;
  }
  EXPECT_EQ(nearest_turn(0).sine, 0);
  EXPECT_TRUE(std::signbit(nearest_turn(-0.0).sine));
  EXPECT_EQ(nearest_turn(1e300).cosine, std::cos(1e300));
}

TEST(angles, angles_are_the_nearest_doubles) {
  std::mt19937_64 random(2);
  std::normal_distribution<double> normal;
  for (int trial = 0; trial < 100'000; ++trial) {
    const double y = normal(random) * std::ldexp(1.0, -static_cast<int>(random() % 30)), x = normal(random);
    ASSERT_TRUE(nearest(angle_of(y, x), std::atan2(static_cast<long double>(y), static_cast<long double>(x))))
        << y << ' ' << x;
  }
  EXPECT_EQ(angle_of(0, 1), 0);
  EXPECT_EQ(angle_of(0, -1), std::atan2(0.0, -1.0));
  EXPECT_EQ(angle_of(1, 0), 1.57079632679489661923);
}

}  // namespace
}  // namespace snug::angles_test
