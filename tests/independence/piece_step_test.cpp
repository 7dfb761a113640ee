#include <snug/independence/piece_step.h>

#include <gtest/gtest.h>
#include <snug/independence/modular.h>
#include <snug/independence/null_space.h>

#include <algorithm>
#include <array>
#include <set>
#include <vector>

namespace snug::piece_step_test {
namespace {

constexpr ExactScheme loop{Scheme::loop}, catmark{Scheme::catmark}, older{Scheme::catmark, true},
    doo_sabin{Scheme::doo_sabin}, midedge{Scheme::midedge};
constexpr std::array schemes{loop, catmark, older, doo_sabin, midedge};

// A, A' and the picks of Loop and Catmull-Clark as the text counts them.
TEST(piece_step, has_the_shapes_of_the_text) {
  for (std::uint32_t n = 3; n <= 12; ++n) {
    const PieceStep a = piece_step(loop, n), b = piece_step(catmark, n), c = piece_step(doo_sabin, n);
    EXPECT_EQ(a.rows.size(), n + 12);
    EXPECT_EQ(a.kept, n + 6);
    EXPECT_EQ(b.rows.size(), 2 * n + 17);
    EXPECT_EQ(b.kept, 2 * n + 8);
    EXPECT_EQ(c.rows.size(), n + 12);
    EXPECT_EQ(c.kept, n + 5);
    for (const PieceStep& step : {a, b, c}) ASSERT_EQ(step.pieces.size(), 3);
    for (const auto& piece : a.pieces) EXPECT_EQ(piece.size(), n == 3 && &piece == &a.pieces[1] ? 11 : 12);
    for (const auto& piece : b.pieces) EXPECT_EQ(piece.size(), 16);
    for (const auto& piece : c.pieces) EXPECT_EQ(piece.size(), 9);
  }
}

TEST(piece_step, has_weights_that_add_up_to_1) {
  for (const ExactScheme& scheme : schemes) {
    for (std::uint32_t n = 3; n <= 14; ++n) {
      const ModularField field = modular_field(n);
      for (const PieceStep& step : {piece_step(scheme, n), annulus_step(scheme, n)}) {
        for (const WeightRow& row : step.rows) {
          std::uint32_t sum = 0;
          for (const auto& [point, w] : row) sum = field.sum(sum, field.image(w));
          ASSERT_EQ(sum, 1);
        }
      }
    }
  }
}

// The one thing that the proof of docs/derivations/independence.md computes.
TEST(piece_step, masks_of_near_points_tell_them) {
  for (const ExactScheme& scheme : {loop, catmark, doo_sabin}) {
    // From where the near points are distinct.
    const std::uint32_t least = scheme.scheme == Scheme::loop ? 5 : scheme.scheme == Scheme::catmark ? 4 : 3;
    for (std::uint32_t n = least; n <= 12; ++n) {
      const PieceStep step = piece_step(scheme, n);
      const std::uint32_t around = scheme.scheme == Scheme::loop      ? n + 1
                                   : scheme.scheme == Scheme::catmark ? 2 * n + 1
                                                                      : n;
      std::set<std::uint32_t> ring, near;
      for (const auto& piece : step.pieces) {
        for (const Functional& functional : piece) ring.insert(functional[0].first);
      }
      for (const std::uint32_t r : ring) {
        if (r < around) continue;
        for (const auto& [point, w] : step.rows[r]) near.insert(point);
      }
      std::vector<std::vector<mpq_class>> masks;
      for (const std::uint32_t r : ring) {
        const WeightRow& row = step.rows[r];
        if (!std::all_of(row.begin(), row.end(),
                         [&](const auto& entry) { return near.contains(entry.first); }))
          continue;
        masks.emplace_back(step.dimension);
        for (const auto& [point, w] : row) masks.back()[point] += w.rational;
      }
      const bool is_loop = scheme.scheme == Scheme::loop;
      EXPECT_EQ(near.size(), is_loop ? 10 : scheme.dual() ? 8 : 15);
      EXPECT_GE(masks.size(), is_loop ? 13 : scheme.dual() ? 12 : 21);
      EXPECT_EQ(step.dimension - null_space(masks, step.dimension).size(), near.size()) << n;
    }
  }
}

// Away from the corner the matrices are those of a regular net: A' of valence 6 or 4 has its eigenvalues.
TEST(piece_step, of_a_regular_corner_has_the_eigenvalues_of_a_spline) {
  const auto nullity = [](const ExactScheme& scheme, std::uint32_t n, const mpq_class& eigenvalue) {
    const PieceStep step = piece_step(scheme, n);
    std::vector<std::vector<mpq_class>> rows(step.kept, std::vector<mpq_class>(step.dimension));
    for (std::uint32_t r = 0; r < step.kept; ++r) {
      for (const auto& [point, w] : step.rows[r]) rows[r][point] += w.rational;
      rows[r][r] -= eigenvalue;
    }
    return null_space(rows, step.dimension).size();
  };
  const mpq_class half(1, 2);
  const std::array<std::size_t, 5> of_loop{1, 2, 3, 4, 2}, of_catmark{1, 2, 3, 4, 3};
  mpq_class eigenvalue = 1;
  for (std::size_t degree = 0; degree < 5; ++degree, eigenvalue *= half) {
    EXPECT_EQ(nullity(loop, 6, eigenvalue), of_loop[degree]) << degree;
    EXPECT_EQ(nullity(catmark, 4, eigenvalue), of_catmark[degree]) << degree;
  }
  // Loop's Jordan block at valence 3: 1/16 three times, with two eigenvectors.
  EXPECT_EQ(nullity(loop, 3, mpq_class(1, 16)), 2);
  // Lemma 9: four eigenvectors of 1/8 where 4 divides the valence.
  for (const std::uint32_t n : {8U, 12U, 16U}) EXPECT_EQ(nullity(catmark, n, mpq_class(1, 8)), 4);
  for (const std::uint32_t n : {5U, 6U, 7U, 9U, 10U}) EXPECT_EQ(nullity(catmark, n, mpq_class(1, 8)), 2);
}

}  // namespace
}  // namespace snug::piece_step_test
