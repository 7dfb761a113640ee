#include <snug/scheme/loop_masks.h>

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace snug {
namespace {

TEST(loop_masks, sum_to_one_and_are_not_negative) {
  for (std::size_t n = 3; n <= 1000; ++n) {
    for (const loop::RingMask& mask : {loop::vertex_mask(n), loop::limit_mask(n)}) {
      const Interval sum = mask.centre + Interval(static_cast<double>(n)) * mask.each;
      EXPECT_TRUE(sum.contains(1.0)) << n;
      EXPECT_LT(sum.upper - sum.lower, 1e-14) << n;
      EXPECT_GE(mask.centre.lower, 0) << n;
      EXPECT_GE(mask.each.lower, 0) << n;
    }
  }
}

TEST(loop_masks, contain_the_formula) {
  for (std::size_t n = 3; n <= 1000; ++n) {
    const long double c = std::cos(2 * std::numbers::pi_v<long double> / static_cast<long double>(n));
    const long double a = 0.625L - (3 + 2 * c) * (3 + 2 * c) / 64;
    const loop::RingMask mask = loop::vertex_mask(n);
    EXPECT_NEAR(middle(mask.centre), static_cast<double>(1 - a), 4e-16) << n;
    EXPECT_LE(mask.centre.lower, 1 - a + 1e-18L) << n;
    EXPECT_GE(mask.centre.upper, 1 - a - 1e-18L) << n;
    EXPECT_LT(mask.each.upper - mask.each.lower, 1e-14) << n;
  }
}

// The limit mask w is a left eigenvector: applying the step first changes nothing.
TEST(loop_masks, limits_are_kept_by_a_step) {
  for (std::size_t n = 3; n <= 1000; ++n) {
    const auto step = loop::vertex_mask(n), limit = loop::limit_mask(n);
    const double count = static_cast<double>(n);
    // Ring to ring: each new ring vertex takes 3/8 of the centre and 5/8 of the ring in sum.
    const double centre = middle(limit.centre) * middle(step.centre) + count * middle(limit.each) * 0.375;
    const double each = middle(limit.centre) * middle(step.each) + middle(limit.each) * 0.625;
    EXPECT_NEAR(centre, middle(limit.centre), 4e-16) << n;
    EXPECT_NEAR(each, middle(limit.each), 4e-16) << n;
  }
}

TEST(loop_masks, are_exact_where_they_are_dyadic) {
  EXPECT_EQ(loop::vertex_mask(6).centre, Interval(0.625));
  EXPECT_EQ(loop::vertex_mask(6).each, Interval(0.0625));
  EXPECT_EQ(loop::vertex_mask(3).each, Interval(0.1875));
  EXPECT_EQ(loop::vertex_mask(4).centre, Interval(0.515625));
  EXPECT_EQ(loop::limit_mask(6).centre, Interval(0.5));
}

}  // namespace
}  // namespace snug
