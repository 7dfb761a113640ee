#include <support/in_order.h>

#include <gtest/gtest.h>

#include <stdexcept>
#include <thread>

namespace snug::in_order_test {
namespace {

TEST(in_order, hands_on_each_result_once_all_before_it_are_there) {
  std::vector<std::size_t> taken;
  InOrder<int> results(4, [&](std::size_t i, int& result) {
    EXPECT_EQ(result, static_cast<int>(10 * i));
    taken.push_back(i);
  });
  results.put(2, 20);
  results.put(1, 10);
  EXPECT_TRUE(taken.empty());
  results.put(0, 0);
  EXPECT_EQ(taken, (std::vector<std::size_t>{0, 1, 2}));
  results.put(3, 30);
  EXPECT_EQ(taken.size(), 4u);
}

TEST(in_order, holds_for_any_number_of_threads) {
  constexpr std::size_t count = 20'000, threads = 4;
  std::size_t next = 0;
  InOrder<std::optional<std::size_t>> results(count, [&](std::size_t i, std::optional<std::size_t>& result) {
    EXPECT_EQ(i, next++);
    EXPECT_EQ(result.has_value(), i % 3 != 0);
  });
  std::vector<std::thread> helpers;
  for (std::size_t t = 0; t < threads; ++t) {
    helpers.emplace_back([&results, t] {
      for (std::size_t i = t; i < count; i += threads) {
        results.put(i, i % 3 == 0 ? std::optional<std::size_t>() : i);
      }
    });
  }
  for (std::thread& helper : helpers) helper.join();
  EXPECT_EQ(next, count);
}

TEST(in_order, hands_nothing_on_after_a_failure) {
  int taken = 0;
  InOrder<int> results(3, [&](std::size_t i, int&) {
    ++taken;
    if (i == 1) throw std::runtime_error("full");
  });
  results.put(0, 0);
  EXPECT_THROW(results.put(1, 1), std::runtime_error);
  results.put(2, 2);
  EXPECT_EQ(taken, 2);
}

}  // namespace
}  // namespace snug::in_order_test
