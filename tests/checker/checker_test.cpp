#include <checker/faults.h>
#include <checker/piece.h>
#include <checker/prove.h>
#include <checker/rejected.h>
#include <gtest/gtest.h>
#include <snug/basis/shipped.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <random>

namespace checker {
namespace {

std::vector<std::byte> shipped_bytes() {
  const auto file = snug::ShippedBounds::compiled_in_file();
  return {file.begin(), file.end()};
}

StoredKind stored(const snug::KindKey& key, const snug::BoundRows& rows) {
  StoredKind kind;
  for (std::size_t i = 0; i < 3; ++i) {
    const snug::CornerFan& fan = key.corners[i];
    kind.key[i] = {fan.before, fan.after, fan.closed, fan.sharp};
  }
  kind.rows = static_cast<std::uint32_t>(rows.count());
  kind.controls = static_cast<std::uint32_t>(rows.control_count());
  kind.entry_error = rows.entry_error();
  kind.abs_sum = rows.abs_sum();
  for (std::size_t c = 0; c < rows.control_count(); ++c)
    kind.weights.insert(kind.weights.end(), rows.column(c), rows.column(c) + rows.count());
  return kind;
}

StoredKind made(const snug::KindKey& key) {
  snug::KindLibrary library;
  return stored(key, snug::make_bound_rows(library.find(key)));
}

snug::CornerFan inside(std::size_t n) { return {0, static_cast<std::uint16_t>(n - 1), true, false}; }
snug::KindKey loop_key(snug::CornerFan a, snug::CornerFan b, snug::CornerFan c) {
  return {snug::Scheme::loop, {a, b, c}};
}

// A table that holds and is not tight: constant planes over a triangle far too large, in some layout.
StoredTable crude_table(const StoredKind& kind) {
  StoredTable table;
  table.layout = {{0, 0}, {1, 0}, {0, 1}};
  for (std::size_t c = 3; c < kind.controls; ++c) {
    const double turn = 2.0 * static_cast<double>(c);
    table.layout.push_back({std::cos(turn), std::sin(turn)});
  }
  double x = 0, y = 0, sum = 0;
  for (std::size_t r = 0; r < kind.rows; ++r) {
    double ux = 0, uy = 0;
    for (std::size_t c = 0; c < kind.controls; ++c) {
      ux += kind.weight(r, c) * table.layout[c][0];
      uy += kind.weight(r, c) * table.layout[c][1];
    }
    x = std::min(x, ux), y = std::min(y, uy), sum = std::max(sum, ux + uy);
  }
  x -= 1e-9, y -= 1e-9, sum += 1e-9;
  table.triangle = {{{x, y}, {sum - y, y}, {x, sum - x}}};
  for (std::size_t c = 3; c < kind.controls; ++c) {
    const auto begin = kind.weights.begin() + static_cast<std::ptrdiff_t>(c * kind.rows);
    const auto [low, high] = std::minmax_element(begin, begin + kind.rows);
    table.lower.push_back({*low - 1e-11, *low - 1e-11, *low - 1e-11});
    table.upper.push_back({*high + 1e-11, *high + 1e-11, *high + 1e-11});
  }
  return table;
}

void expect_every_fault_found(const BoundsFile& file, std::size_t at_least) {
  ASSERT_NO_THROW(static_cast<void>(prove_file(to_bytes(file))));
  const std::vector<Fault> planted = faults(file);
  EXPECT_GE(planted.size(), at_least);
  for (const Fault& fault : planted) {
    EXPECT_THROW(static_cast<void>(prove_file(fault.spoil(file))), Rejected) << fault.name;
  }
}

TEST(checker, writes_the_compiled_in_file_as_it_reads_it) {
  const std::vector<std::byte> bytes = shipped_bytes();
  const BoundsFile file = parse(bytes);
  EXPECT_FALSE(file.text.empty());
  EXPECT_EQ(to_bytes(file), bytes);
}

TEST(checker, and_library_read_the_same_tables) {
  BoundsFile file = excerpt(parse(shipped_bytes()));
  for (StoredKind& kind : file.kinds) {
    kind.tables = {crude_table(kind), crude_table(kind)};
    kind.tables[0].name = 1;
    kind.tables[1].name = 0;
    kind.tables[1].upper[0][2] += 1;
  }
  const std::vector<std::byte> bytes = to_bytes(file);
  const snug::ShippedBounds read(bytes);
  ASSERT_EQ(read.keys().size(), file.kinds.size());
  for (std::size_t i = 0; i < file.kinds.size(); ++i) {
    for (const StoredTable& table : file.kinds[i].tables) {
      const auto seen = read.table(read.keys()[i], static_cast<snug::TableLayout>(table.name));
      ASSERT_TRUE(seen);
      EXPECT_EQ(seen->layout, table.layout);
      EXPECT_EQ(seen->triangle, table.triangle);
      EXPECT_EQ(seen->lower, table.lower);
      EXPECT_EQ(seen->upper, table.upper);
    }
  }
}

TEST(checker, finds_every_fault_planted_in_compiled_in_rows) {
  BoundsFile file = excerpt(parse(shipped_bytes()));
  for (StoredKind& kind : file.kinds) kind.tables.clear();
  expect_every_fault_found(file, 20);
}

TEST(checker, finds_every_fault_planted_in_tables) {
  BoundsFile file = excerpt(parse(shipped_bytes()));
  for (StoredKind& kind : file.kinds) kind.tables = {crude_table(kind)};
  expect_every_fault_found(file, 26);
}

TEST(checker, proves_rows_of_kinds_that_are_not_shipped) {
  const snug::CornerFan lone{0, 0, false, true};
  for (const snug::KindKey& key :
       {loop_key(inside(5), inside(7), inside(9)), loop_key(inside(3), inside(3), inside(3)),
        loop_key(inside(3), inside(4), inside(5)), loop_key(inside(14), inside(6), inside(6)),
        loop_key(lone, lone, lone), loop_key(lone, {2, 0, false, false}, {0, 4, false, false}),
        loop_key({1, 3, false, false}, inside(3), {2, 2, false, false}),
        loop_key({0, 3, false, false}, {1, 0, false, false}, inside(4))}) {
    EXPECT_NO_THROW(static_cast<void>(prove_rows(made(key)))) << to_text(made(key).key);
  }
}

// A hull needs no certain depth: the control net is one, and so is what lies between.
TEST(checker, proves_a_control_net_alone_and_together_with_rows) {
  const snug::KindKey key = loop_key(inside(5), inside(6), inside(6));
  StoredKind kind = made(key);
  StoredKind net = kind;
  net.rows = net.controls;
  net.weights.assign(std::size_t{net.rows} * net.controls, 0.0);
  for (std::size_t c = 0; c < net.controls; ++c) net.weight(c, c) = 1;
  EXPECT_EQ(prove_rows(net).pieces, 1u);
  EXPECT_GT(prove_rows(kind).pieces, 10u);
  net.weight(4, 4) = 1 + 1e-12;
  net.weight(4, 5) = -1e-12;
  EXPECT_THROW(static_cast<void>(prove_rows(net)), Rejected);
}

// The limits of a regular patch's corners, and of the whole lattice by precision of linear functions.
TEST(checker, has_masks_that_keep_linear_functions_on_the_regular_lattice) {
  const Piece root = root_piece({Fan{0, 5, true, false}, Fan{0, 5, true, false}, Fan{0, 5, true, false}});
  const std::vector<std::array<double, 2>> lattice{{0, 0},  {1, 0},  {0, 1},  {1, -1}, {1, 1}, {-1, 1},
                                                   {-1, 0}, {0, -1}, {2, -1}, {2, 0},  {0, 2}, {-1, 2}};
  ASSERT_EQ(root.rows.size(), lattice.size());
  const auto expect_linear = [&](const Piece& piece) {
    for (std::size_t k = 0; k < 3; ++k) {
      const Row row = limit(piece, k);
      for (std::size_t x = 0; x < 2; ++x) {
        Real sum;
        for (std::size_t c = 0; c < row.size(); ++c) sum += row[c] * Real(lattice[c][x]);
        EXPECT_TRUE(
            sum.may_be(std::ldexp(static_cast<double>(piece.places[k][x]), -static_cast<int>(place_bits))));
      }
    }
  };
  expect_linear(root);
  for (const Piece& child : split(root)) {
    expect_linear(child);
    for (const Piece& grandchild : split(child)) expect_linear(grandchild);
  }
}

TEST(checker, refuses_keys_that_no_patch_has) {
  const Fan six{0, 5, true, false};
  for (const Key& key : {Key{Fan{0, 1, true, false}, six, six}, Key{Fan{1, 4, true, false}, six, six},
                         Key{Fan{0, 5, true, true}, six, six}, Key{Fan{0, 2, false, false}, six, six},
                         Key{Fan{1, 1, false, true}, six, six}, Key{Fan{0, 65535, true, false}, six, six},
                         Key{Fan{0, 0, false, true}, Fan{0, 0, false, false}, Fan{0, 0, false, false}},
                         Key{Fan{0, 2, true, false}, Fan{0, 2, true, false}, six}}) {
    EXPECT_THROW(static_cast<void>(root_piece(key)), Rejected) << to_text(key);
  }
}

TEST(checker, reads_or_rejects_any_bytes) {
  const BoundsFile file = excerpt(parse(shipped_bytes()));
  const std::vector<std::byte> whole = to_bytes(file);
  std::mt19937_64 random(5);
  std::size_t rejected = 0;
  for (int trial = 0; trial < 400; ++trial) {
    std::vector<std::byte> bytes = whole;
    const std::size_t head = trial % 2 == 0 ? 400 : bytes.size();  // mostly where counts and lengths are
    for (int change = 0; change < 3; ++change)
      bytes[random() % head] = static_cast<std::byte>(random() & 255);
    if (trial % 5 == 0) bytes.resize(random() % bytes.size());
    seal(bytes);
    try {
      static_cast<void>(parse(bytes));
    } catch (const Rejected&) {
      ++rejected;
    }
  }
  EXPECT_GT(rejected, 100u);
}

}  // namespace
}  // namespace checker
