#include <snug/independence/null_space.h>

#include <gtest/gtest.h>

#include <vector>

namespace snug::null_space_test {
namespace {

TEST(null_space, is_a_basis_of_what_is_orthogonal) {
  const std::vector<std::vector<mpq_class>> rows{{1, mpq_class(1, 2), 0, 2}, {0, 0, mpq_class(2, 3), 1}};
  const auto basis = null_space(rows, 4);
  ASSERT_EQ(basis.size(), 2);
  for (const auto& v : basis) {
    for (const auto& row : rows) {
      mpq_class product;
      for (std::size_t i = 0; i < 4; ++i) product += row[i] * v[i];
      EXPECT_EQ(product, 0);
    }
  }
  EXPECT_EQ(null_space({}, 3).size(), 3);
}

}  // namespace
}  // namespace snug::null_space_test
