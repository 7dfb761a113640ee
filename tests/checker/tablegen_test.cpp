#include <checker/bounds_file.h>
#include <gtest/gtest.h>
#include <snug/bounds/bounds_cache.h>
#include <snug/bounds/invariant_layout.h>
#include <tablegen/file_writer.h>
#include <tablegen/kinds.h>

#include <algorithm>
#include <cstring>
#include <span>
#include <unordered_set>

namespace tablegen::tablegen_test {
namespace {

using snug::KindKey;
using snug::Scheme;

template <class Values, class Others>
bool same_bits(const Values& a, const Others& b) {
  const auto one = std::as_bytes(std::span(a)), two = std::as_bytes(std::span(b));
  return one.size() == two.size() && std::memcmp(one.data(), two.data(), one.size()) == 0;
}

void expect_same(const checker::StoredRows& made, const snug::BoundingRows& on_demand) {
  ASSERT_EQ(made.rows, on_demand.count());
  ASSERT_EQ(made.controls, on_demand.control_count());
  EXPECT_TRUE(same_bits(std::array{made.entry_error, made.abs_sum},
                        std::array{on_demand.entry_error(), on_demand.abs_sum()}));
  EXPECT_TRUE(same_bits(std::span<const double>(made.weights),
                        std::span(on_demand.column(0), on_demand.count() * on_demand.control_count())));
}

// Bezier points of the rows that patches are bounded with are the first of those that are proved.
void expect_first(const checker::StoredKind& made, const snug::BoundingRows& kept) {
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

checker::Key key_of(const KindKey& key) {
  checker::Key fans;
  for (std::size_t i = 0; i < 4; ++i) {
    fans[i] = {key.corners[i].before, key.corners[i].after, key.corners[i].closed, key.corners[i].sharp};
  }
  return fans;
}

void expect_same(const checker::StoredComparison& made, const snug::BoundingRows& on_demand,
                 const std::vector<snug::QuadraticRows::Restriction>& restrictions) {
  expect_same(static_cast<const checker::StoredRows&>(made), on_demand);
  ASSERT_EQ(made.quadratic.size(), on_demand.bezier_count());
  for (std::size_t k = 0; k < 6; ++k) {
    for (std::size_t r = 0; r < on_demand.bezier_count(); ++r) {
      ASSERT_TRUE(same_bits(std::array{made.quadratic[r][k]}, std::array{on_demand.quadratic(k)[r]}));
    }
  }
  ASSERT_EQ(made.nets.size(), on_demand.nets().size());
  ASSERT_EQ(made.nets.size(), restrictions.size());
  for (std::size_t i = 0; i < made.nets.size(); ++i) {
    EXPECT_EQ(made.nets[i].key, key_of(on_demand.nets()[i].kind->key()));
    EXPECT_EQ(made.nets[i].first, on_demand.nets()[i].begin);
    EXPECT_TRUE(same_bits(made.nets[i].restriction, restrictions[i]));
  }
}

void expect_same(const checker::StoredQuadratics& made, snug::BoundsCache& library, const snug::Kind& kind) {
  const snug::QuadraticRows& on_demand = library.quadratic_rows(kind);
  const std::span<const double> fit(on_demand.fit(), 6 * made.fit.size());
  EXPECT_TRUE(same_bits(made.fit, fit));
  expect_same(made.comparisons[0], library.rows(kind), on_demand.to_nets());
  expect_same(made.comparisons[1], library.level_rows(kind), on_demand.to_level_nets());
  ASSERT_EQ(made.frame.has_value(), !on_demand.layout().empty());
  if (!made.frame) return;
  EXPECT_TRUE(same_bits(made.frame->layout, on_demand.layout()));
  EXPECT_TRUE(same_bits(made.frame->largest, on_demand.largest()));
  EXPECT_TRUE(same_bits(made.frame->offsets, on_demand.offsets()));
  EXPECT_TRUE(same_bits(std::array{made.frame->offset_error}, std::array{on_demand.offset_error()}));
}

// So what the checker proves is what surfaces are bounded with.
TEST(tablegen, makes_bit_by_bit_the_rows_tables_and_quadratics_made_on_demand) {
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
    expect_same(made, snug::make_bounding_rows(kind));
    expect_same(made.tables[0], rows_first.table(kind));
    expect_same(made.tables[1],
                snug::make_bound_table(kind, snug::make_bounding_rows(kind), snug::tip_layout(kind)));
    expect_first(made, rows_first.rows(kind));
    ASSERT_TRUE(made.quadratics);
    expect_same(*made.quadratics, rows_first, kind);
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
}  // namespace tablegen::tablegen_test
