#include <snug/independence/eigenvalues.h>

#include <gtest/gtest.h>
#include <snug/independence/piece_step.h>

#include <map>
#include <string>
#include <vector>

namespace snug {
namespace {

constexpr ExactScheme loop{Scheme::loop}, catmark{Scheme::catmark};

// "1/8 4 4; ..."
std::string repeated(const ExactScheme& scheme, std::uint32_t n) {
  std::string text;
  for (const RationalEigenvalue& each : corner_eigenvalues(scheme, n).repeated) {
    if (!text.empty()) text += "; ";
    text +=
        each.value.get_str() + " " + std::to_string(each.algebraic) + " " + std::to_string(each.geometric());
  }
  return text;
}

TEST(eigenvalues, are_those_that_the_text_lists) {
  for (std::uint32_t n = 3; n <= 30; ++n) {
    EXPECT_TRUE(corner_eigenvalues(loop, n).as_stated) << n;
    EXPECT_TRUE(corner_eigenvalues(catmark, n).as_stated) << n;
  }
}

TEST(eigenvalues, of_regular_corners_are_those_of_polynomials) {
  EXPECT_EQ(repeated(loop, 6), "1/2 2 2; 1/4 3 3; 1/8 4 4; 1/16 2 2");
  EXPECT_EQ(repeated(catmark, 4), "1/2 2 2; 1/4 3 3; 1/8 4 4; 1/16 3 3; 1/32 2 2");
}

TEST(eigenvalues, of_loops_valence_3_lack_an_eigenvector) {
  EXPECT_EQ(repeated(loop, 3), "1/4 2 2; 1/8 3 3; 1/16 3 2");
}

TEST(eigenvalues, are_twice_those_of_two_frequencies) {
  EXPECT_EQ(repeated(loop, 8), "3/8 2 2; 1/8 4 4; 1/16 2 2");
  EXPECT_EQ(repeated(loop, 12), "1/2 2 2; 3/8 2 2; 1/4 2 2; 1/8 4 4; 1/16 2 2");
}

TEST(eigenvalues, have_all_eigenvectors_otherwise) {
  for (std::uint32_t n = 4; n <= 24; ++n) {
    for (const ExactScheme& scheme : {loop, catmark}) {
      for (const RationalEigenvalue& each : corner_eigenvalues(scheme, n).repeated) {
        EXPECT_EQ(each.algebraic, each.geometric()) << n << " " << each.value.get_str();
      }
    }
  }
}

// Rows with irrational weights are the corner's own: a span has 0 there, and no mean around it.
TEST(eigenvalues, have_spans_that_a_step_multiplies) {
  for (std::uint32_t n = 3; n <= 12; ++n) {
    for (const ExactScheme& scheme : {loop, catmark}) {
      const PieceStep step = piece_step(scheme, n);
      for (const RationalEigenvalue& each : corner_eigenvalues(scheme, n).repeated) {
        for (const std::vector<mpq_class>& vector : each.span) {
          ASSERT_EQ(vector.size(), step.dimension);
          for (std::uint32_t r = 0; r < step.kept; ++r) {
            mpq_class rational = 0;
            std::map<std::uint32_t, mpq_class> cosines;
            for (const auto& [point, w] : step.rows[r]) {
              rational += w.rational * vector[point];
              for (const auto& [index, factor] : w.cosines) cosines[index] += factor * vector[point];
            }
            EXPECT_EQ(rational, each.value * vector[r]) << n << " row " << r;
            for (const auto& [index, sum] : cosines) EXPECT_EQ(sum, 0) << n << " row " << r;
          }
        }
      }
    }
  }
}

// Lemma 9 says two, and forgets the corner's own where 4 divides the valence; of Loop they are three, or four.
TEST(eigenvalues, one_eighth_comes_two_to_four_times) {
  for (std::uint32_t n = 5; n <= 24; ++n) {
    for (const RationalEigenvalue& each : corner_eigenvalues(catmark, n).repeated) {
      if (each.value != mpq_class(1, 8)) continue;
      EXPECT_EQ(each.algebraic, n % 4 == 0 ? 4 : 2) << n;
    }
    for (const RationalEigenvalue& each : corner_eigenvalues(loop, n).repeated) {
      if (each.value != mpq_class(1, 8)) continue;
      EXPECT_EQ(each.algebraic, n % 2 == 0 ? 4 : 3) << n;
    }
  }
}

}  // namespace
}  // namespace snug
