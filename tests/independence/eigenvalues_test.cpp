#include <snug/independence/eigenvalues.h>

#include <gtest/gtest.h>
#include <snug/independence/piece_step.h>
#include <snug/independence/real_field.h>

#include <array>
#include <map>
#include <string>
#include <vector>

namespace snug::eigenvalues_test {
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

// --- the corner's own eigenvalues, those of vectors that are constant around it, against the others ---

// x^2 - sum x + product, whose roots they are.
struct OwnOfCatmark {
  mpq_class sum, product;

  // Of A' for vectors of one value at the corner, one at ends of edges, one across faces; 1 is the third.
  explicit OwnOfCatmark(std::uint32_t n) {
    const PieceStep step = piece_step(catmark, n);
    std::array<std::array<mpq_class, 3>, 3> m;
    for (std::uint32_t r = 0; r < 3; ++r) {
      for (const auto& [point, w] : step.rows[r]) m[r][point == 0 ? 0 : 2 - point % 2] += w.rational;
    }
    sum = m[0][0] + m[1][1] + m[2][2] - 1;
    product = m[0][0] * (m[1][1] * m[2][2] - m[1][2] * m[2][1]) -
              m[0][1] * (m[1][0] * m[2][2] - m[1][2] * m[2][0]) +
              m[0][2] * (m[1][0] * m[2][1] - m[1][1] * m[2][0]);
  }
  [[nodiscard]] bool has(const mpq_class& x) const { return x * x - sum * x + product == 0; }
};

// a + b x with x one of its roots.
struct Quotient {
  mpq_class a, b;
};
Quotient times(const OwnOfCatmark& own, const Quotient& p, const Quotient& q) {
  const mpq_class high = p.b * q.b;
  return {p.a * q.a - own.product * high, p.a * q.b + p.b * q.a + own.sum * high};
}

// Is one of them a root of 16 x^2 - (10 + c) x + 1 with c = 2cos(2 pi k / n), 0 <= k < n? With
// c = t, t = (16 x^2 - 10 x + 1) / x, iff D_n(t) = 2, where D_n(2 cos y) = 2 cos(n y).
bool meets_a_frequency(const OwnOfCatmark& own, std::uint32_t n) {
  if (own.product == 0) return false;  // the roots are 0 and their sum, the only other one
  const Quotient inverse{own.sum / own.product, -1 / own.product};
  const Quotient t = times(own, {1 - 16 * own.product, 16 * own.sum - 10}, inverse);
  Quotient now{2, 0}, next = t;  // D_i(t), D_{i+1}(t); i is the n that is read so far
  for (std::uint32_t bit = 31; bit < 32; --bit) {
    Quotient between = times(own, now, next);
    between = {between.a - t.a, between.b - t.b};
    Quotient& same = (n >> bit & 1) != 0 ? next : now;
    same = times(own, same, same);
    same.a -= 2;
    ((n >> bit & 1) != 0 ? now : next) = between;
  }
  now.a -= 2;
  return now.a * now.a + now.a * now.b * own.sum + now.b * now.b * own.product == 0;  // the norm
}

TEST(eigenvalues, of_catmark_that_are_the_corners_own_are_others_at_valence_4_alone) {
  for (std::uint32_t n = 3; n <= 200; ++n) {
    const OwnOfCatmark own(n);
    EXPECT_EQ(4 * n * own.sum, 3 * n - 7) << n;
    EXPECT_EQ(16 * n * own.product, n - 3) << n;
    EXPECT_EQ(meets_a_frequency(own, n), n == 4) << n;
    EXPECT_FALSE(own.has(1)) << n;
    for (const unsigned denominator : {8u, 16u, 32u, 64u}) {
      EXPECT_EQ(own.has(mpq_class(1, denominator)), n == 4 && denominator == 16) << n << " " << denominator;
    }
  }
}

// The page's proof: with u = 2 - c they meet iff n (n - 3) u^2 - (20 n - 84) u - 80 = 0.
// 1/2 is one at valence 11, and of c = 0, which takes a frequency that 11 does not have.
TEST(eigenvalues, of_catmark_that_are_the_corners_own_at_valence_11_are_those_of_a_quarter_turn) {
  EXPECT_TRUE(OwnOfCatmark(11).has(mpq_class(1, 2)));
  for (std::uint32_t n = 3; n <= 24; ++n) {
    EXPECT_EQ(meets_a_frequency(OwnOfCatmark(11), n), n % 4 == 0) << n;
  }
}

TEST(eigenvalues, of_catmark_that_are_the_corners_own_would_meet_others_where_the_page_says) {
  for (std::uint32_t n = 4; n <= 200; ++n) {
    const OwnOfCatmark own(n);
    for (int u = 1; u <= 4; ++u) {
      // A common root of 16 x^2 - (12 - u) x + 1 and the corner's own is one of their difference.
      const mpq_class slope = own.sum - mpq_class(12 - u) / 16, rest = own.product - mpq_class(1, 16);
      const bool meet = slope == 0 ? rest == 0 : own.has(rest / slope);
      const mpz_class big = n;
      EXPECT_EQ(meet, big * (big - 3) * u * u - (20 * big - 84) * u - 80 == 0) << n << " " << u;
      EXPECT_EQ(meet, (n == 4 && u == 4) || (n == 11 && u == 2)) << n << " " << u;
    }
  }
}

TEST(eigenvalues, of_loop_that_are_the_corners_own_are_others_at_valences_3_and_6_alone) {
  for (std::uint32_t n = 3; n <= 120; ++n) {
    const RealField field(n);
    const auto is = [&](Weight number, const mpq_class& value) {
      number.rational -= value;
      return field.number(number, 1).is_zero();
    };
    Weight own = piece_step(loop, n).rows[0][0].second;
    own.rational -= mpq_class(3, 8);
    EXPECT_FALSE(is(own, 1)) << n;
    EXPECT_FALSE(is(own, mpq_class(1, 8))) << n;
    EXPECT_EQ(is(own, mpq_class(1, 16)), n == 3) << n;
    for (std::uint32_t k = 1; k <= n / 2; ++k) {
      Weight difference = own;
      difference.cosines.emplace_back(k, mpq_class(-1, 8));
      EXPECT_EQ(is(difference, mpq_class(3, 8)), n == 6 && k == 2) << n << " " << k;
    }
  }
}

}  // namespace
}  // namespace snug::eigenvalues_test
