#include <support/blocks.h>

#include <gtest/gtest.h>

#include <utility>

namespace snug::blocks_test {
namespace {

struct Item {
  int value = 7;
};

TEST(blocks, keep_what_is_there_where_it_is_while_they_grow) {
  Blocks<Item> items;
  EXPECT_EQ(items.size(), 0u);
  items.push_back({1});
  const Item* const first = &items[0];
  for (int i = 2; i <= 9000; ++i) items.push_back({i});
  items.resize(20000);
  EXPECT_EQ(items.size(), 20000u);
  EXPECT_EQ(first, &items[0]);
  for (std::size_t i = 0; i < 9000; ++i) ASSERT_EQ(items[i].value, static_cast<int>(i) + 1);
  for (std::size_t i = 9000; i < 20000; ++i) ASSERT_EQ(items[i].value, 7);
  const Blocks<Item> taken = std::move(items);
  EXPECT_EQ(first, &taken[0]);
  EXPECT_EQ(Blocks<Item>(5)[4].value, 7);
}

}  // namespace
}  // namespace snug::blocks_test
