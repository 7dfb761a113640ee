#include <experiments/curve_rates.h>

#include <gtest/gtest.h>

namespace snug::curve_rates_test {
namespace {

TEST(curve_rates, are_those_of_theory) {
  const std::vector<CurveRateRow> rows = measure_curve_rates({});
  ASSERT_EQ(rows.size(), 12u);
  for (const CurveRateRow& row : rows) {
    const std::string where = std::string(name_of(row.place)) + ", degree " +
                              std::to_string(static_cast<int>(row.degree)) + ", " + name_of(row.measure);
    if (row.expected == 0) {
      EXPECT_FALSE(row.factor.has_value()) << where;
      continue;
    }
    ASSERT_TRUE(row.factor.has_value()) << where;
    EXPECT_NEAR(*row.factor, row.expected, 0.01) << where;
    for (std::size_t level = 1; level < row.thickness.size(); ++level) {
      EXPECT_LT(row.thickness[level], row.thickness[level - 1]) << where;
    }
  }
}

}  // namespace
}  // namespace snug::curve_rates_test
