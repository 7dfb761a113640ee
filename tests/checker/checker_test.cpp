#include <checker/faults.h>
#include <checker/half_quad.h>
#include <checker/piece.h>
#include <checker/prove.h>
#include <checker/quadratic.h>
#include <checker/rejected.h>
#include <gtest/gtest.h>
#include <snug/bounds/bounding_rows.h>
#include <tablegen/file_writer.h>
#include <tablegen/kinds.h>
#include <testing/counts.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <random>
#include <span>

namespace checker::checker_test {
namespace {

const std::vector<std::byte>& common_bytes() {
  static const std::vector<std::byte> bytes = tablegen::file_of(tablegen::common_kinds());
  return bytes;
}

Key of_loop(Fan a, Fan b, Fan c) { return {a, b, c, no_corner}; }

StoredKind stored(const snug::KindKey& key, const snug::BoundingRows& rows) {
  StoredKind kind;
  kind.scheme = schemes.at(static_cast<std::size_t>(key.scheme));
  for (std::size_t i = 0; i < 4; ++i) {
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
  snug::KindCache library;
  return stored(key, snug::make_bounding_rows(library.find(key)));
}

snug::CornerFan inside(std::size_t n) { return {0, static_cast<std::uint16_t>(n - 1), true, false}; }
snug::KindKey loop_key(snug::CornerFan a, snug::CornerFan b, snug::CornerFan c) {
  return {snug::Scheme::loop, {a, b, c}};
}
snug::KindKey quad_key(snug::Scheme scheme, snug::CornerFan a, snug::CornerFan b, snug::CornerFan c,
                       snug::CornerFan d) {
  return {scheme, {a, b, c, d}};
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
  for (std::size_t c = first_bounded(kind.scheme); c < kind.controls; ++c) {
    const auto begin = kind.weights.begin() + static_cast<std::ptrdiff_t>(c * kind.rows);
    const auto [low, high] = std::minmax_element(begin, begin + kind.rows);
    table.lower.push_back({*low - 1e-11, *low - 1e-11, *low - 1e-11});
    table.upper.push_back({*high + 1e-11, *high + 1e-11, *high + 1e-11});
  }
  return table;
}

void expect_every_one_found(const std::vector<Fault>& planted, const BoundsFile& file, std::size_t at_least) {
  ASSERT_NO_THROW(static_cast<void>(prove_file(to_bytes(file))));
  EXPECT_GE(planted.size(), at_least);
  const std::size_t step = snug::testing::fewer(4) == 4 ? 1 : 3;
  for (std::size_t i = 0; i < planted.size(); i += step) {
    EXPECT_THROW(static_cast<void>(prove_file(planted[i].spoil(file))), Rejected) << planted[i].name;
  }
}

BoundsFile rows_alone(BoundsFile file) {
  for (StoredKind& kind : file.kinds) {
    kind.tables.clear();
    kind.quadratics.reset();
  }
  return file;
}

BoundsFile without_tables(BoundsFile file) {
  for (StoredKind& kind : file.kinds) kind.tables.clear();
  return file;
}

// The least rows that a kind can have.
void make_control_net(StoredKind& kind) {
  kind.rows = kind.controls;
  kind.weights.assign(std::size_t{kind.rows} * kind.controls, 0.0);
  for (std::size_t c = 0; c < kind.controls; ++c) kind.weight(c, c) = 1;
}

// But those that rows alone have, too.
std::vector<Fault> more_faults(const BoundsFile& file) {
  std::vector<Fault> planted = faults(file);
  for (const Fault& of_rows : faults(rows_alone(file)))
    std::erase_if(planted, [&](const Fault& fault) { return fault.name == of_rows.name; });
  return planted;
}

// All that a file has of these kinds, without asking for the kinds of their nets.
void prove_quadratics(const BoundsFile& file) {
  for (const StoredKind& kind : file.kinds) {
    ASSERT_TRUE(kind.quadratics);
    for (const StoredComparison& comparison : kind.quadratics->comparisons) {
      EXPECT_NO_THROW(prove_comparison(comparison, kind.scheme, kind.key)) << to_text(kind.scheme, kind.key);
    }
    if (kind.quadratics->frame) {
      EXPECT_NO_THROW(prove_frame(*kind.quadratics->frame, kind.scheme, kind.key))
          << to_text(kind.scheme, kind.key);
    }
  }
}

TEST(checker, writes_the_file_of_tablegen_as_it_reads_it) {
  const std::vector<std::byte>& bytes = common_bytes();
  const BoundsFile file = parse(bytes);
  EXPECT_FALSE(file.text.empty());
  EXPECT_EQ(to_bytes(file), bytes);
}

TEST(checker, proves_tables_in_any_layout_that_hold_and_are_not_tight) {
  const BoundsFile common = parse(common_bytes());
  for (const Scheme scheme : schemes) {
    BoundsFile file = excerpt(common, scheme);
    for (StoredKind& kind : file.kinds) kind.tables = {crude_table(kind)};
    EXPECT_EQ(prove_file(to_bytes(file)).tables, file.kinds.size()) << name_of(scheme);
  }
}

// All of a patch left to its net, and frames with room.
TEST(checker, proves_quadratics_that_hold_and_are_not_tight) {
  const BoundsFile common = parse(common_bytes());
  for (const Scheme scheme : schemes) {
    BoundsFile file = excerpt(common, scheme);
    file.kinds.resize(1);
    StoredKind& kind = file.kinds.front();
    kind.tables.clear();
    make_control_net(kind);
    StoredNet net{kind.key, 0, {}};
    for (std::size_t k = 0; k < 6; ++k) net.restriction[k][k] = 1;
    for (StoredComparison& comparison : kind.quadratics->comparisons) {
      static_cast<StoredRows&>(comparison) = kind;
      comparison.quadratic.clear();
      comparison.nets = {net};
    }
    StoredFrame& frame = kind.quadratics->frame.value();
    for (double& largest : frame.largest) largest = 1;
    frame.offsets = {{-99, -99}, {99, -99}, {99, 99}, {0, 0}, {-99, 99}, {99, 99}};  // in no order
    frame.offset_error = 0;
    const FileProof proof = prove_file(to_bytes(file));
    EXPECT_EQ(proof.comparisons, 2u) << name_of(scheme);
    EXPECT_EQ(proof.frames, 1u) << name_of(scheme);
    net.restriction[3][3] = 1 - 0x1p-53;
    kind.quadratics->comparisons[1].nets = {net};
    EXPECT_THROW(static_cast<void>(prove_file(to_bytes(file))), Rejected) << name_of(scheme);
  }
}

// Of a line, of a point, up to an error: the square around it is what is left.
TEST(checker, takes_polygons_of_few_corners_with_the_square_around_them) {
  const BoundsFile common = parse(common_bytes());
  for (const Scheme scheme : schemes) {
    const StoredKind kind = excerpt(common, scheme).kinds.front();
    StoredFrame frame = kind.quadratics->frame.value();
    double most = 0;
    for (const auto& at : frame.offsets) most = std::max({most, std::fabs(at[0]), std::fabs(at[1])});
    for (const auto& offsets : {std::vector<std::array<double, 2>>{{0, 0}},
                                {{0, 0}, {0, 0}},
                                {{0, 0}, {most, most}, {most / 2, most / 2}}}) {
      frame.offsets = offsets;
      frame.offset_error = most + 1e-9;
      EXPECT_NO_THROW(prove_frame(frame, kind.scheme, kind.key)) << name_of(scheme);
      frame.offset_error = 0;
      EXPECT_THROW(prove_frame(frame, kind.scheme, kind.key), Rejected) << name_of(scheme);
    }
    // Beside the offsets, along either axis: what is parallel to the line ends with the square.
    frame.offset_error = most + 1e-9;
    for (const std::size_t axis : {0u, 1u}) {
      for (const double side : {-1.0, 1.0}) {
        frame.offsets = {{0, 0}, {0, 0}};
        frame.offsets[0][axis] = side * (most + 1);
        frame.offsets[1][axis] = side * (most + 2);
        EXPECT_THROW(prove_frame(frame, kind.scheme, kind.key), Rejected) << name_of(scheme) << axis << side;
      }
    }
  }
}

TEST(checker, finds_every_fault_planted_in_rows) {
  const BoundsFile common = parse(common_bytes());
  for (const Scheme scheme : schemes) {
    SCOPED_TRACE(name_of(scheme));
    const BoundsFile file = rows_alone(excerpt(common, scheme));
    expect_every_one_found(faults(file), file, 20);
  }
}

TEST(checker, finds_every_fault_planted_in_tables) {
  const BoundsFile common = parse(common_bytes());
  for (const Scheme scheme : schemes) {
    SCOPED_TRACE(name_of(scheme));
    BoundsFile file = excerpt(common, scheme);
    for (StoredKind& kind : file.kinds) kind.quadratics.reset();
    expect_every_one_found(more_faults(file), file, 10);
  }
}

TEST(checker, finds_every_fault_planted_in_quadratics) {
  const BoundsFile common = parse(common_bytes());
  for (const Scheme scheme : schemes) {
    SCOPED_TRACE(name_of(scheme));
    BoundsFile file = excerpt(common, scheme);
    const std::vector<Fault> planted = more_faults(without_tables(file));
    file.kinds.resize(1);
    file.kinds[0].tables.clear();
    make_control_net(file.kinds[0]);  // proved at once
    expect_every_one_found(planted, file, 50);
  }
}

std::vector<snug::KindKey> other_loop_keys() {
  const snug::CornerFan lone{0, 0, false, true};
  return {loop_key(inside(5), inside(7), inside(9)),
          loop_key(inside(3), inside(3), inside(3)),
          loop_key(inside(3), inside(4), inside(5)),
          loop_key(inside(14), inside(6), inside(6)),
          loop_key(lone, lone, lone),
          loop_key(lone, {2, 0, false, false}, {0, 4, false, false}),
          loop_key({1, 3, false, false}, inside(3), {2, 2, false, false}),
          loop_key({0, 3, false, false}, {1, 0, false, false}, inside(4))};
}

std::vector<snug::KindKey> other_quad_keys() {
  using enum snug::Scheme;
  const snug::CornerFan lone{0, 0, false, true}, smooth{0, 0, false, false};
  const snug::CornerFan first{0, 1, false, false},
      last{1, 0, false, false};  // of the boundary edge beside them
  std::vector<snug::KindKey> keys{
      quad_key(catmark, inside(5), inside(3), inside(4), inside(7)),
      quad_key(catmark, inside(3), inside(3), inside(3), inside(3)),
      quad_key(catmark, inside(4), inside(3), inside(3), inside(9)),
      quad_key(catmark, first, last, first, last),
      quad_key(catmark, lone, lone, lone, lone),
      quad_key(catmark, smooth, last, inside(4), first),
      quad_key(catmark, inside(4), {2, 3, false, false}, inside(5), inside(4)),
      quad_key(catmark, {0, 2, false, false}, {3, 0, false, false}, inside(3), inside(4)),
  };
  for (const snug::Scheme dual : {doo_sabin, midedge}) {
    keys.push_back(quad_key(dual, inside(3), inside(5), inside(4), inside(6)));
    keys.push_back(quad_key(dual, inside(3), inside(3), inside(3), inside(3)));
    keys.push_back(quad_key(dual, inside(4), inside(7), inside(4), inside(4)));
  }
  return keys;
}

TEST(checker, proves_rows_of_kinds_that_tablegen_leaves_out) {
  for (const snug::KindKey& key : other_loop_keys())
    EXPECT_NO_THROW(static_cast<void>(prove_rows(made(key)))) << to_text(Scheme::loop, made(key).key);
}

TEST(checker, proves_rows_of_half_quads_that_tablegen_leaves_out) {
  for (const snug::KindKey& key : other_quad_keys()) {
    const StoredKind kind = made(key);
    EXPECT_NO_THROW(static_cast<void>(prove_rows(kind))) << to_text(kind.scheme, kind.key);
  }
}

// Several nets a kind, turned against it, some of other kinds.
TEST(checker, proves_quadratics_of_kinds_that_tablegen_leaves_out) {
  prove_quadratics(parse(tablegen::file_of(other_loop_keys())));
  prove_quadratics(parse(tablegen::file_of(other_quad_keys())));
}

TEST(checker, refuses_nets_of_kinds_that_a_file_does_not_have) {
  const std::vector<snug::KindKey> keys{loop_key(inside(5), inside(6), inside(7)),
                                        loop_key(inside(5), inside(6), inside(6)),
                                        loop_key(inside(6), inside(6), inside(7))};
  EXPECT_NO_THROW(static_cast<void>(prove_file(tablegen::file_of(keys))));
  const std::span<const snug::KindKey> some(keys);
  for (const auto& few : {some.first(1), some.first(2)})
    EXPECT_THROW(static_cast<void>(prove_file(tablegen::file_of(few))), Rejected);
}

// A hull needs no certain depth: the control net is one, and so is what lies between.
TEST(checker, proves_a_control_net_alone_and_together_with_rows) {
  const snug::KindKey key = loop_key(inside(5), inside(6), inside(6));
  StoredKind kind = made(key);
  StoredKind net = kind;
  make_control_net(net);
  EXPECT_EQ(prove_rows(net).pieces, 1u);
  EXPECT_GT(prove_rows(kind).pieces, 10u);
  net.weight(4, 4) = 1 + 1e-12;
  net.weight(4, 5) = -1e-12;
  EXPECT_THROW(static_cast<void>(prove_rows(net)), Rejected);
}

// The limits of a regular patch's corners, and of the whole lattice by precision of linear functions.
TEST(checker, has_masks_that_keep_linear_functions_on_the_regular_lattice) {
  const Piece root = root_piece(of_loop({0, 5, true, false}, {0, 5, true, false}, {0, 5, true, false}));
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

// Bezier points of regular half quads, by precision of linear functions: the net as neighbourhood.h draws it.
TEST(checker, has_bezier_points_that_keep_linear_functions_on_the_regular_lattice) {
  using Lattice = std::vector<std::array<double, 2>>;
  const Lattice quads{{0, 0}, {1, 0}, {1, 1},  {0, 1},  {0, -1},  {1, -1}, {2, 0}, {2, 1},
                      {1, 2}, {0, 2}, {-1, 1}, {-1, 0}, {-1, -1}, {2, -1}, {2, 2}, {-1, 2}};
  const Lattice around{{.5, .5},   {-.5, .5},  {.5, -.5},  {1.5, .5}, {.5, 1.5},
                       {-.5, -.5}, {1.5, -.5}, {1.5, 1.5}, {-.5, 1.5}};
  constexpr Fan four{0, 3, true, false};
  for (const Scheme scheme : {Scheme::catmark, Scheme::doo_sabin, Scheme::midedge}) {
    const Lattice& lattice = scheme == Scheme::catmark ? quads : around;
    Shapes shapes;
    const HalfQuad root = root_half(shapes, scheme, {four, four, four, four});
    ASSERT_EQ(root.rows.size(), lattice.size());
    std::vector<HalfQuad> pieces{root};
    for (const HalfQuad& child : split(root)) pieces.push_back(child);
    for (const HalfQuad& piece : pieces) {
      for (const BezierTriangle& triangle : bezier_triangles(piece)) {
        const std::vector<Exponents>& all = exponents(triangle.degree);
        for (std::size_t p = 0; p < all.size(); ++p) {
          std::array<Real, 2> expected, seen;  // weights of corners 1 and 2: x - y and y
          for (std::size_t a = 0; a < 2; ++a) {
            for (std::size_t k = 0; k < 3; ++k) {
              expected[a] += Real(all[p][k]) * Real(static_cast<double>(triangle.places[k][a])) /
                             Real(triangle.degree * std::ldexp(1, place_bits));
            }
            for (std::size_t c = 0; c < lattice.size(); ++c) {
              const double weight = a == 0 ? lattice[c][0] - lattice[c][1] : lattice[c][1];
              seen[a] += triangle.points[p][c] * Real(weight);
            }
            EXPECT_TRUE((seen[a] - expected[a]).may_be(0)) << name_of(scheme) << p;
          }
        }
      }
    }
  }
}

// At some places of a piece: the quadratic's six Bernstein polynomials there, and what its points give.
TEST(checker, raises_and_restricts_quadratics_to_pieces) {
  constexpr std::int64_t one = std::int64_t{1} << place_bits;
  const std::array<Place, 3> whole{Place{0, 0}, Place{one, 0}, Place{0, one}};
  const std::array<Place, 3> piece{Place{one / 2, one / 4}, Place{one / 4, one / 2}, Place{one / 4, one / 4}};
  const auto six = [](const std::array<Real, 3>& l) {
    return SixReals{l[0] * l[0],           l[1] * l[1],           l[2] * l[2],
                    Real(2) * l[0] * l[1], Real(2) * l[1] * l[2], Real(2) * l[2] * l[0]};
  };
  for (const auto& places : {whole, piece}) {
    for (const std::array<double, 3>& l :
         {std::array{1.0, 0.0, 0.0}, {0.125, 0.5, 0.375}, {0.0, 0.75, 0.25}}) {
      const std::array<Real, 3> weights{l[0], l[1], l[2]};
      Parameter t;
      for (std::size_t x = 0; x < 2; ++x) {
        for (std::size_t k = 0; k < 3; ++k) t[x] += weights[k] * parameter_of(places[k])[x];
      }
      const SixReals expected = six({Real(1) - t[0] - t[1], t[0], t[1]});
      const SixReals inside = six(weights);
      const std::array<SixReals, 6> restricted = restricted_quadratic(places);
      for (std::size_t i = 0; i < 6; ++i) {
        Real sum;
        for (std::size_t k = 0; k < 6; ++k) sum += inside[k] * restricted[k][i];
        EXPECT_TRUE((sum - expected[i]).is_exactly_zero()) << i;
      }
      for (const unsigned degree : {2u, 4u, 6u}) {
        const std::vector<SixReals> raised = raised_quadratic(places, degree);
        for (std::size_t i = 0; i < 6; ++i) {
          Real sum;
          for (std::size_t p = 0; p < raised.size(); ++p)
            sum += bernstein(exponents(degree)[p], weights) * raised[p][i];
          EXPECT_TRUE((sum - expected[i]).may_be(0)) << degree << i;
          EXPECT_TRUE(Real(1e-30).certainly_at_least((sum - expected[i]).magnitude())) << degree << i;
        }
      }
    }
  }
}

TEST(checker, refuses_keys_of_quads_that_no_patch_has) {
  const Fan four{0, 3, true, false};
  Shapes shapes;
  for (const Key& key :
       {Key{Fan{0, 1, true, false}, four, four, four}, Key{Fan{1, 2, true, false}, four, four, four},
        Key{Fan{0, 3, true, true}, four, four, four}, Key{Fan{0, 1, false, false}, four, four, four},
        Key{Fan{0, 65535, true, false}, four, four, four}, Key{Fan{1, 1, false, true}, four, four, four}}) {
    for (const Scheme scheme : {Scheme::catmark, Scheme::doo_sabin, Scheme::midedge})
      EXPECT_THROW(static_cast<void>(root_half(shapes, scheme, key)), Rejected) << to_text(scheme, key);
  }
}

TEST(checker, refuses_keys_that_no_patch_has) {
  const Fan six{0, 5, true, false};
  for (const Key& key :
       {Key{six, six, six, Fan{0, 4, true, false}}, of_loop(Fan{0, 1, true, false}, six, six),
        of_loop(Fan{1, 4, true, false}, six, six), of_loop(Fan{0, 5, true, true}, six, six),
        of_loop(Fan{0, 2, false, false}, six, six), of_loop(Fan{1, 1, false, true}, six, six),
        of_loop(Fan{0, 65535, true, false}, six, six),
        of_loop(Fan{0, 0, false, true}, Fan{0, 0, false, false}, Fan{0, 0, false, false}),
        of_loop(Fan{0, 2, true, false}, Fan{0, 2, true, false}, six)}) {
    EXPECT_THROW(static_cast<void>(root_piece(key)), Rejected) << to_text(Scheme::loop, key);
  }
}

TEST(checker, reads_or_rejects_any_bytes) {
  const BoundsFile file = excerpt(parse(common_bytes()), Scheme::catmark);
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
}  // namespace checker::checker_test
