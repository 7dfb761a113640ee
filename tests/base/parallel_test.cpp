#include <snug/base/parallel.h>

#include <gtest/gtest.h>

#include <atomic>
#include <stdexcept>
#include <vector>

namespace snug {
namespace {

TEST(parallel_for, covers_every_index_once) {
  for (const int threads : {0, 1, 2, 4}) {
    std::vector<std::atomic<int>> seen(1000);
    parallel_for(seen.size(), threads, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) ++seen[i];
    });
    for (const auto& count : seen) ASSERT_EQ(count, 1);
  }
  parallel_for(0, 2, [](std::size_t, std::size_t) { FAIL(); });
}

TEST(parallel_for, hands_on_exceptions) {
  EXPECT_THROW(parallel_for(100, 2, [](std::size_t, std::size_t) { throw std::runtime_error("one"); }),
               std::runtime_error);
}

}  // namespace
}  // namespace snug
