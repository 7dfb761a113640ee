#include <snug/bounds/shipped.h>

#include <gtest/gtest.h>
#include <snug/base/contract.h>
#include <snug/bounds/bounds_cache.h>

#include <algorithm>
#include <cstring>
#include <stdexcept>
#include <unordered_set>

namespace snug {
namespace {

bool same_bits(double a, double b) { return std::memcmp(&a, &b, sizeof a) == 0; }

void expect_same(const BoundRows& shipped, const BoundRows& made) {
  ASSERT_EQ(shipped.count(), made.count());
  ASSERT_EQ(shipped.control_count(), made.control_count());
  EXPECT_TRUE(same_bits(shipped.entry_error(), made.entry_error()));
  EXPECT_TRUE(same_bits(shipped.abs_sum(), made.abs_sum()));
  for (std::size_t c = 0; c < made.control_count(); ++c) {
    EXPECT_EQ(std::memcmp(shipped.column(c), made.column(c), made.count() * sizeof(double)), 0) << c;
  }
}

template <class Values>
bool same_bits(const Values& a, const Values& b) {
  return a.size() == b.size() && std::memcmp(a.data(), b.data(), a.size() * sizeof(a[0])) == 0;
}

void expect_same(const BoundTable& shipped, const BoundTable& made) {
  EXPECT_TRUE(same_bits(shipped.layout, made.layout));
  EXPECT_TRUE(same_bits(shipped.triangle, made.triangle));
  EXPECT_TRUE(same_bits(shipped.lower, made.lower));
  EXPECT_TRUE(same_bits(shipped.upper, made.upper));
}

TEST(shipped_bounds, are_bit_by_bit_the_rows_made_at_run_time) {
  const ShippedBounds& shipped = ShippedBounds::compiled_in();
  for (const Scheme scheme : {Scheme::loop, Scheme::catmark, Scheme::doo_sabin, Scheme::midedge}) {
    EXPECT_GE(std::count_if(shipped.keys().begin(), shipped.keys().end(),
                            [&](const KindKey& key) { return key.scheme == scheme; }),
              13);
  }
  BoundsCache library;
  for (const KindKey& key : shipped.keys()) {
    const Kind& kind = library.kinds().find(key);
    const std::optional<BoundRows> rows = shipped.rows(kind);
    ASSERT_TRUE(rows);
    expect_same(*rows, make_bound_rows(kind));
    expect_same(library.rows(kind), *rows);
  }
}

TEST(shipped_bounds, are_bit_by_bit_the_tables_made_at_run_time) {
  const ShippedBounds& shipped = ShippedBounds::compiled_in();
  BoundsCache library;
  for (const KindKey& key : shipped.keys()) {
    const Kind& kind = library.kinds().find(key);
    const std::optional<BoundTable> table = shipped.table(key);
    ASSERT_TRUE(table);
    expect_same(*table, make_bound_table(kind, library.rows(kind)));
    expect_same(library.table(kind), *table);
  }
}

TEST(shipped_bounds, have_keys_that_meshes_give_and_each_once) {
  std::vector<KindKey> keys = ShippedBounds::compiled_in().keys();
  for (const KindKey& key : keys) {
    const Neighbourhood around = neighbourhood(key);
    if (key.scheme == Scheme::loop) {
      EXPECT_EQ(kind_key(around.topology, FaceId(0), around.options, around.sharpness).key, key);
    } else {
      EXPECT_EQ(kind_key_from(around.topology, 0, around.options, around.sharpness), key);
    }
  }
  const std::unordered_set<KindKey, KindKeyHash> distinct(keys.begin(), keys.end());
  EXPECT_EQ(distinct.size(), keys.size());
}

TEST(shipped_bounds, know_nothing_of_other_kinds) {
  KindCache library;
  for (const Scheme scheme : {Scheme::loop, Scheme::catmark, Scheme::doo_sabin, Scheme::midedge}) {
    const KindKey key{scheme, {CornerFan{0, 5}, CornerFan{0, 5}, CornerFan{0, 76}}};
    EXPECT_FALSE(ShippedBounds::compiled_in().rows(library.find(key)));
    EXPECT_FALSE(ShippedBounds::compiled_in().table(key));
  }
}

class BrokenFile : public ::testing::Test {
 protected:
  BrokenFile()
      : old_handler_(
            set_contract_handler([](const ContractViolation& v) { throw std::logic_error(v.condition); })),
        bytes_(ShippedBounds::compiled_in_file().begin(), ShippedBounds::compiled_in_file().end()) {}
  ~BrokenFile() override { set_contract_handler(old_handler_); }

  ContractHandler old_handler_;
  std::vector<std::byte> bytes_;
};

TEST_F(BrokenFile, is_refused_whatever_byte_changed) {
  EXPECT_NO_THROW(ShippedBounds{bytes_});
  for (std::size_t place = 0; place < bytes_.size(); place += place < 256 ? 1 : 16411) {
    bytes_[place] ^= std::byte{16};
    EXPECT_THROW(ShippedBounds{bytes_}, std::logic_error) << place;
    bytes_[place] ^= std::byte{16};
  }
}

TEST_F(BrokenFile, is_refused_whatever_its_length) {
  for (const std::size_t length : {std::size_t{0}, std::size_t{7}, std::size_t{31}, std::size_t{40},
                                   bytes_.size() / 2, bytes_.size() - 8, bytes_.size() - 1}) {
    EXPECT_THROW(ShippedBounds{std::span(bytes_).first(length)}, std::logic_error) << length;
  }
  bytes_.resize(bytes_.size() + 8);
  EXPECT_THROW(ShippedBounds{bytes_}, std::logic_error);
}

}  // namespace
}  // namespace snug
