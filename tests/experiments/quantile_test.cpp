#include <experiments/quantile.h>

#include <gtest/gtest.h>

namespace snug::quantile_test {
namespace {

TEST(quantile, is_one_of_the_values_in_their_order) {
  const std::vector<double> values{4, 1, 3, 2, 5};
  EXPECT_EQ(quantile(values, 0), 1);
  EXPECT_EQ(quantile(values, 0.5), 3);
  EXPECT_EQ(quantile(values, 1), 5);
  EXPECT_EQ(quantile({7}, 0.95), 7);
}

}  // namespace
}  // namespace snug::quantile_test
