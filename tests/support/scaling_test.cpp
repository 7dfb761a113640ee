#include <support/scaling.h>

#include <gtest/gtest.h>
#include <support/error.h>

#include <limits>

namespace snug::scaling_test {
namespace {

TEST(power_of_two, brings_the_largest_into_one_to_two) {
  for (const double x : {1.0, 1.99, 2.0, 3e-308, 5e-324, 1e300, 1.7976931348623157e308}) {
    const double scaled = PowerOfTwo::normalising(x).apply(x);
    EXPECT_GE(scaled, 1) << x;
    EXPECT_LT(scaled, 2) << x;
  }
  EXPECT_EQ(PowerOfTwo::normalising(0).exponent(), 0);
}

TEST(power_of_two, knows_what_it_keeps) {
  EXPECT_TRUE(PowerOfTwo(-40).exact(1.0 / 3));
  EXPECT_FALSE(PowerOfTwo(-1060).exact(1.0 / 3));
  EXPECT_FALSE(PowerOfTwo(1000).exact(1e100));
}

TEST(require_representable, refuses_what_overflowed) {
  EXPECT_EQ(require_representable(2.0), 2.0);
  EXPECT_THROW(static_cast<void>(require_representable(std::numeric_limits<double>::infinity())), InputError);
}

}  // namespace
}  // namespace snug::scaling_test
