#include <support/contract.h>

#include <gtest/gtest.h>
#include <snug/mesh.h>

#include <stdexcept>
#include <type_traits>

namespace snug::contract_test {
namespace {

TEST(contract, calls_the_handler_with_the_condition_as_written) {
  const ContractHandler before = set_contract_handler(
      [](const ContractViolation& violation) { throw std::logic_error(violation.condition); });
  std::string seen;
  try {
    SNUG_EXPECT(1 + 1 == 3);
  } catch (const std::logic_error& error) {
    seen = error.what();
  }
  set_contract_handler(before);
  EXPECT_EQ(seen, "1 + 1 == 3");
}

TEST(contract, aborts_by_default) { EXPECT_DEATH(SNUG_EXPECT(false), "contract broken: false"); }

TEST(ids, of_different_sorts_do_not_compare) {
  static_assert(!std::is_convertible_v<VertexId, FaceId>);
  static_assert(!std::equality_comparable_with<VertexId, FaceId>);
  EXPECT_FALSE(VertexId().valid());
  EXPECT_LT(VertexId(1), VertexId(2));
}

}  // namespace
}  // namespace snug::contract_test
