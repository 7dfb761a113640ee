#include <checker/bounds_file.h>
#include <gtest/gtest.h>
#include <snug/bounds/bounds_cache.h>
#include <snug/bounds/lasting_layout.h>
#include <tablegen/file_writer.h>
#include <tablegen/kinds.h>

#include <algorithm>
#include <cstring>
#include <span>
#include <unordered_set>

namespace tablegen {
namespace {

using snug::KindKey;
using snug::Scheme;

template <class Values>
bool same_bits(const Values& a, const Values& b) {
  const auto one = std::as_bytes(std::span(a)), two = std::as_bytes(std::span(b));
  return one.size() == two.size() && std::memcmp(one.data(), two.data(), one.size()) == 0;
}

void expect_same(const checker::StoredKind& made, const snug::BoundRows& on_demand) {
  ASSERT_EQ(made.rows, on_demand.count());
  ASSERT_EQ(made.controls, on_demand.control_count());
  EXPECT_TRUE(same_bits(std::array{made.entry_error, made.abs_sum},
                        std::array{on_demand.entry_error(), on_demand.abs_sum()}));
  EXPECT_TRUE(same_bits(std::span<const double>(made.weights),
                        std::span(on_demand.column(0), on_demand.count() * on_demand.control_count())));
}

// Bezier points of the rows that patches are bounded with are the first of those that are proved.
void expect_first(const checker::StoredKind& made, const snug::BoundRows& kept) {
  ASSERT_LE(kept.bezier_count(), made.rows);
  for (std::size_t c = 0; c < made.controls; ++c) {
    for (std::size_t r = 0; r < kept.bezier_count(); ++r) ASSERT_EQ(made.weight(r, c), kept.weight(r, c));
  }
}

void expect_same(const checker::StoredTable& made, const snug::BoundTable& on_demand) {
  EXPECT_TRUE(same_bits(made.layout, on_demand.layout));
  EXPECT_TRUE(same_bits(made.triangle, on_demand.triangle));
  EXPECT_TRUE(same_bits(made.lower, on_demand.lower));
  EXPECT_TRUE(same_bits(made.upper, on_demand.upper));
}

// So what the checker proves is what surfaces are bounded with.
TEST(tablegen, makes_bit_by_bit_the_rows_and_tables_made_on_demand) {
  const std::vector<KindKey> keys = common_kinds();
  const checker::BoundsFile file = checker::parse(file_of(keys));
  ASSERT_EQ(file.kinds.size(), keys.size());
  snug::BoundsCache tables_first, rows_first;
  for (std::size_t i = 0; i < keys.size(); ++i) {
    const checker::StoredKind& made = file.kinds[i];
    SCOPED_TRACE(checker::to_text(made.scheme, made.key));
    ASSERT_EQ(made.tables.size(), 2u);
    expect_same(made.tables[0], tables_first.table(tables_first.kinds().find(keys[i])));
    const snug::Kind& kind = rows_first.kinds().find(keys[i]);
    expect_same(made, snug::make_bound_rows(kind));
    expect_same(made.tables[0], rows_first.table(kind));
    expect_same(made.tables[1],
                snug::make_bound_table(kind, snug::make_bound_rows(kind), snug::tip_layout(kind)));
    expect_first(made, rows_first.rows(kind));
  }
}

TEST(tablegen, knows_keys_that_meshes_give_and_each_once) {
  const std::vector<KindKey> keys = common_kinds();
  for (const KindKey& key : keys) {
    const snug::Neighbourhood around = snug::neighbourhood(key);
    if (key.scheme == Scheme::loop) {
      EXPECT_EQ(snug::kind_key(around.topology, snug::FaceId(0), around.options, around.sharpness).key, key);
    } else {
      EXPECT_EQ(snug::kind_key_from(around.topology, 0, around.options, around.sharpness), key);
    }
  }
  const std::unordered_set<KindKey, snug::KindKeyHash> distinct(keys.begin(), keys.end());
  EXPECT_EQ(distinct.size(), keys.size());
  for (const Scheme scheme : {Scheme::loop, Scheme::catmark, Scheme::doo_sabin, Scheme::midedge}) {
    EXPECT_GE(
        std::count_if(keys.begin(), keys.end(), [&](const KindKey& key) { return key.scheme == scheme; }),
        13);
  }
}

}  // namespace
}  // namespace tablegen
