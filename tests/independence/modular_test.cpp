#include <snug/independence/modular.h>

#include <gtest/gtest.h>

namespace snug::modular_test {
namespace {

TEST(modular_field, has_a_root_of_exactly_its_order) {
  for (std::uint32_t n = 3; n <= 200; ++n) {
    const ModularField field = modular_field(n);
    ASSERT_EQ(field.prime % n, 1);
    ASSERT_LT(field.prime, 1U << 31);
    std::uint32_t power = 1;
    for (std::uint32_t i = 1; i <= n; ++i) {
      power = field.product(power, field.root);
      ASSERT_EQ(power == 1, i == n) << n;
    }
  }
}

}  // namespace
}  // namespace snug::modular_test
