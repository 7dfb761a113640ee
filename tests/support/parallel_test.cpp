#include <support/parallel.h>

#include <gtest/gtest.h>

#include <atomic>
#include <new>
#include <stdexcept>
#include <thread>
#include <vector>

namespace snug::parallel_test {
namespace {

TEST(parallel_for, threads_cover_every_index_once) {
  for (const int threads : {0, 1, 2, 4}) {
    std::vector<std::atomic<int>> seen(1000);
    parallel_for(seen.size(), threads, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) ++seen[i];
    });
    for (const auto& count : seen) ASSERT_EQ(count, 1);
  }
  parallel_for(0, 2, [](std::size_t, std::size_t) { FAIL(); });
}

TEST(parallel_for, makes_one_state_a_thread) {
  for (const int threads : {1, 2, 4}) {
    std::atomic<int> states{0};
    std::vector<std::atomic<int>> seen(10'000);
    const auto make = [&] { return ++states; };
    parallel_for_with(seen.size(), threads, make, [&](int& state, std::size_t begin, std::size_t end) {
      EXPECT_GE(state, 1);
      for (std::size_t i = begin; i < end; ++i) ++seen[i];
    });
    EXPECT_LE(states, threads);
    for (const auto& count : seen) ASSERT_EQ(count, 1);
  }
  parallel_for_with(
      0, 4, [] { return ADD_FAILURE(), 0; }, [](int, std::size_t, std::size_t) { FAIL(); });
}

TEST(parallel_for, works_inside_of_threads_of_its_own) {
  std::atomic<std::size_t> sum{0};
  parallel_for(8, 4, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      parallel_for(100, 2, [&](std::size_t first, std::size_t last) { sum += last - first; });
    }
  });
  EXPECT_EQ(sum, 800u);
}

// Freed memory that is given out again soon looks otherwise.
struct Whole {
  std::vector<int> values = std::vector<int>(64, 7);
  static inline std::atomic<int> ended{0}, damaged{0};
  ~Whole() {
    ++ended;
    if (values != std::vector<int>(64, 7)) ++damaged;
  }
};
thread_local Whole whole;

TEST(parallel_for, objects_of_threads_are_whole_when_their_threads_end) {
  for (int i = 0; i < 200; ++i) {
    std::vector<std::thread> threads;
    for (int t = 0; t < 4; ++t) threads.emplace_back([] { EXPECT_EQ(whole.values.size(), 64u); });
    for (std::thread& thread : threads) thread.join();
  }
  EXPECT_EQ(Whole::ended, 800);
  EXPECT_EQ(Whole::damaged, 0);
}

TEST(parallel_for, hands_on_an_exception_of_any_thread) {
  for (std::size_t bad = 0; bad < 1000; bad += 99) {
    EXPECT_THROW(parallel_for(1000, 4,
                              [&](std::size_t begin, std::size_t end) {
                                if (begin <= bad && bad < end) throw std::bad_alloc();
                              }),
                 std::bad_alloc);
  }
  EXPECT_THROW(
      parallel_for_with(
          100, 4, []() -> int { throw std::runtime_error("state"); }, [](int, std::size_t, std::size_t) {}),
      std::runtime_error);
}

TEST(parallel_for, hands_on_exceptions_of_threads) {
  EXPECT_THROW(parallel_for(100, 2, [](std::size_t, std::size_t) { throw std::runtime_error("one"); }),
               std::runtime_error);
}

}  // namespace
}  // namespace snug::parallel_test
