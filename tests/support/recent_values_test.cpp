#include <support/recent_values.h>

#include <gtest/gtest.h>

#include <stdexcept>

namespace snug::recent_values_test {
namespace {

struct RecentSquares : ::testing::Test {
  int square(int x) {
    return values.get(x, [&] { return ++made, x * x; });
  }
  RecentValues<int, int, 3> values;
  int made = 0;
};

TEST_F(RecentSquares, are_made_once_while_they_are_here) {
  for (int round = 0; round < 4; ++round) {
    for (const int x : {2, 5, 7}) EXPECT_EQ(square(x), x * x);
  }
  EXPECT_EQ(made, 3);
}

TEST_F(RecentSquares, make_room_for_others_and_are_the_same_when_made_again) {
  for (int round = 0; round < 4; ++round) {
    for (const int x : {2, 5, 7, 9}) EXPECT_EQ(square(x), x * x);
  }
  EXPECT_EQ(made, 16);
  EXPECT_EQ(square(5), 25);
  EXPECT_EQ(made, 16);
}

TEST_F(RecentSquares, stay_until_as_many_others_were_made) {
  const auto make = [](int x) { return [x] { return x * x; }; };
  const int& first = values.get(2, make(2));
  square(5);
  square(7);
  EXPECT_EQ(&values.get(2, make(2)), &first);
}

TEST_F(RecentSquares, are_as_they_were_where_one_cannot_be_made) {
  square(2);
  EXPECT_THROW(static_cast<void>(values.get(3, []() -> int { throw std::runtime_error("no"); })),
               std::runtime_error);
  EXPECT_EQ(square(2), 4);
  EXPECT_EQ(square(3), 9);
  EXPECT_EQ(made, 2);
}

}  // namespace
}  // namespace snug::recent_values_test
