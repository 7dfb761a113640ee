#include <snug/bounds/bounds_cache.h>

#include <gtest/gtest.h>
#include <snug/base/parallel.h>

#include <vector>

namespace snug {
namespace {

TEST(bound_library, hands_every_thread_the_same_rows_and_tables) {
  BoundsCache library;
  std::vector<const BoundRows*> seen(400);
  std::vector<const BoundTable*> tables(400);
  parallel_for(seen.size(), 4, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const auto n = static_cast<std::uint16_t>(2 + i % 10);  // faces besides its own
      const Kind& kind =
          library.kinds().find({Scheme::loop, {CornerFan{0, 5}, CornerFan{0, 5}, CornerFan{0, n}}});
      seen[i] = &library.rows(kind);
      tables[i] = &library.table(kind);
    }
  });
  for (std::size_t i = 0; i < seen.size(); ++i) EXPECT_EQ(tables[i], tables[i % 10]);
  EXPECT_NE(tables[0], tables[1]);
  for (std::size_t i = 0; i < seen.size(); ++i) EXPECT_EQ(seen[i], seen[i % 10]);
  EXPECT_EQ(library.size(), 10u);
  EXPECT_GT(library.bytes(), 0u);
}

}  // namespace
}  // namespace snug
