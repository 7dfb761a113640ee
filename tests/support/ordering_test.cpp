#include <support/ordering.h>

#include <algorithm>
#include <random>
#include <vector>

#include <gtest/gtest.h>

namespace snug::ordering_test {
namespace {

// By `key` alone, so that many are equal; `name` tells them apart.
struct Item {
  int key, name;
  friend bool operator==(const Item&, const Item&) = default;
};
bool less(const Item& x, const Item& y) { return x.key < y.key; }

std::vector<Item> items(std::size_t size, int keys, unsigned seed) {
  std::mt19937 random(seed);
  std::vector<Item> result;
  for (std::size_t i = 0; i < size; ++i) {
    result.push_back({static_cast<int>(random() % static_cast<unsigned>(keys)), static_cast<int>(i)});
  }
  return result;
}

// Calls body(items) with few and many keys, sorted and reversed ones too.
template <class Body>
void each_case(const Body& body) {
  for (std::size_t size : {0u, 1u, 2u, 3u, 15u, 16u, 17u, 18u, 33u, 100u, 1000u}) {
    for (const int keys : {1, 2, 5, 1000}) {
      for (unsigned seed = 0; seed < 20; ++seed) {
        std::vector<Item> some = items(size, keys, seed);
        if (seed == 1) std::stable_sort(some.begin(), some.end(), less);
        if (seed == 2) std::stable_sort(some.rbegin(), some.rend(), less);
        body(some);
      }
    }
  }
}

void expect_permutation(std::vector<Item> some, std::vector<Item> others) {
  const auto by_name = [](const Item& x, const Item& y) { return x.name < y.name; };
  std::sort(some.begin(), some.end(), by_name);
  std::sort(others.begin(), others.end(), by_name);
  EXPECT_EQ(some, others);
}

TEST(ordering, sorts) {
  each_case([](const std::vector<Item>& given) {
    std::vector<Item> sorted = given;
    ordering::sort(sorted.data(), sorted.size(), less);
    EXPECT_TRUE(std::is_sorted(sorted.begin(), sorted.end(), less));
    expect_permutation(given, sorted);
  });
}

TEST(ordering, brings_the_least_to_the_front_in_order) {
  each_case([](const std::vector<Item>& given) {
    for (const std::size_t middle : {std::size_t{0}, given.size() / 3, given.size()}) {
      std::vector<Item> sorted = given;
      ordering::partial_sort(sorted.data(), middle, sorted.size(), less);
      const auto end = sorted.begin() + static_cast<std::ptrdiff_t>(middle);
      EXPECT_TRUE(std::is_sorted(sorted.begin(), end, less));
      for (auto it = end; it != sorted.end() && middle > 0; ++it) EXPECT_FALSE(less(*it, *std::prev(end)));
      expect_permutation(given, sorted);
    }
  });
}

TEST(ordering, divides_at_a_place) {
  each_case([](const std::vector<Item>& given) {
    for (const std::size_t place : {std::size_t{0}, given.size() / 3, given.size() - 1}) {
      if (place >= given.size()) continue;
      std::vector<Item> divided = given;
      ordering::nth_element(divided.data(), place, divided.size(), less);
      for (std::size_t i = 0; i < place; ++i) EXPECT_FALSE(less(divided[place], divided[i]));
      for (std::size_t i = place; i < divided.size(); ++i) EXPECT_FALSE(less(divided[i], divided[place]));
      expect_permutation(given, divided);
    }
  });
}

TEST(ordering, heaps_hand_out_the_largest) {
  each_case([](const std::vector<Item>& given) {
    std::vector<Item> heap;
    for (const Item& item : given) {
      heap.push_back(item);
      ordering::push_heap(heap.data(), heap.size(), less);
      EXPECT_TRUE(std::is_heap(heap.begin(), heap.end(), less));
    }
    for (std::size_t left = heap.size(); left > 0; --left) ordering::pop_heap(heap.data(), left, less);
    EXPECT_TRUE(std::is_sorted(heap.begin(), heap.end(), less));
    expect_permutation(given, heap);
  });
}

#ifdef __GLIBCXX__
// That of the library that answers were first computed with.
TEST(ordering, equal_elements_come_in_the_order_of_libstdcxx) {
  each_case([](const std::vector<Item>& given) {
    std::vector<Item> ours = given, theirs = given;
    ordering::sort(ours.data(), ours.size(), less);
    std::sort(theirs.begin(), theirs.end(), less);
    EXPECT_EQ(ours, theirs);

    const std::size_t middle = given.size() / 2;
    ours = theirs = given;
    ordering::partial_sort(ours.data(), middle, ours.size(), less);
    std::partial_sort(theirs.begin(), theirs.begin() + static_cast<std::ptrdiff_t>(middle), theirs.end(),
                      less);
    EXPECT_EQ(ours, theirs);

    if (!given.empty()) {
      ours = theirs = given;
      ordering::nth_element(ours.data(), middle, ours.size(), less);
      std::nth_element(theirs.begin(), theirs.begin() + static_cast<std::ptrdiff_t>(middle), theirs.end(),
                       less);
      EXPECT_EQ(ours, theirs);
    }

    ours = theirs = given;
    ordering::make_heap(ours.data(), ours.size(), less);
    std::make_heap(theirs.begin(), theirs.end(), less);
    EXPECT_EQ(ours, theirs);
    while (!theirs.empty()) {
      ordering::pop_heap(ours.data(), ours.size(), less);
      std::pop_heap(theirs.begin(), theirs.end(), less);
      EXPECT_EQ(ours, theirs);
      ours.pop_back();
      theirs.pop_back();
    }
    for (const Item& item : given) {
      ours.push_back(item);
      theirs.push_back(item);
      ordering::push_heap(ours.data(), ours.size(), less);
      std::push_heap(theirs.begin(), theirs.end(), less);
      EXPECT_EQ(ours, theirs);
    }
  });
}
#endif

}  // namespace
}  // namespace snug::ordering_test
