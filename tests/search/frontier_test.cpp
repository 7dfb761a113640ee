#include <snug/search/frontier.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <deque>
#include <random>
#include <set>
#include <vector>

namespace snug::frontier_test {
namespace {

struct Item {
  int name;
  float gap;
};

// Against the containers of the standard library.
TEST(frontier, hands_out_in_its_order) {
  std::mt19937_64 random(1);
  Frontier<Item> frontier;
  for (const Order order : {Order::last_first, Order::first_first, Order::nearest_first}) {
    for (int trial = 0; trial < 50; ++trial) {
      std::deque<int> row{0};
      std::multiset<float> gaps{0.5F};
      frontier.start(order, {0, 0.5F});
      for (int step = 1; step < 300 && !frontier.empty(); ++step) {
        ASSERT_EQ(frontier.size(), row.size());
        if (random() % 5 < 3) {
          const Item item{step, static_cast<float>(random() % 1000)};
          frontier.add(item);
          row.push_back(step);
          gaps.insert(item.gap);
          continue;
        }
        if (order == Order::nearest_first) {
          EXPECT_EQ(frontier.take().gap, *gaps.begin());
          gaps.erase(gaps.begin());
          row.pop_back();
        } else {
          const bool last = order == Order::last_first;
          EXPECT_EQ(frontier.take().name, last ? row.back() : row.front());
          last ? row.pop_back() : row.pop_front();
        }
      }
      ASSERT_EQ(frontier.items().size(), row.size());
      for (std::size_t i = 0; i < row.size() && order != Order::nearest_first; ++i)
        EXPECT_EQ(frontier.items()[i].name, row[i]);
    }
  }
}

// Numbers below 100, each of which opens to two; of some a part is dropped, and one stops.
struct Question {
  Frontier<int>& open_numbers;
  int stop = -1;
  std::vector<int> seen{};

  Verb look_at(int number) {
    seen.push_back(number);
    if (number == stop) return Verb::stop;
    return number % 7 == 6 || number >= 50 ? Verb::drop : Verb::open;
  }
  void open(int number) {
    open_numbers.add(2 * number);
    open_numbers.add(2 * number + 1);
  }
};

TEST(search, looks_at_all_that_is_open_until_it_stops) {
  Frontier<int> frontier;
  frontier.start(Order::first_first, 1);
  Question all{frontier};
  search(frontier, all);
  EXPECT_TRUE(frontier.empty());
  // What lies below a number that is dropped is not looked at.
  for (int number = 1; number < 100; ++number) {
    bool reached = true;
    for (int above = number / 2; above > 0; above /= 2) reached = reached && above % 7 != 6 && above < 50;
    EXPECT_EQ(std::count(all.seen.begin(), all.seen.end(), number), reached ? 1 : 0) << number;
  }
  EXPECT_TRUE(std::is_sorted(all.seen.begin(), all.seen.end()));
  frontier.start(Order::last_first, 1);
  Question some{frontier, 15};
  search(frontier, some);
  EXPECT_EQ(some.seen, (std::vector<int>{1, 3, 7, 15}));
  EXPECT_EQ(frontier.size(), 3u);
}

}  // namespace
}  // namespace snug::frontier_test
