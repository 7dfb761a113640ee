#include <snug/independence/cases.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>
#include <set>

namespace snug::cases_test {
namespace {

using Kind = IndependenceDomain::Kind;

constexpr ExactScheme loop{Scheme::loop}, catmark{Scheme::catmark}, older{Scheme::catmark, true},
    doo_sabin{Scheme::doo_sabin}, midedge{Scheme::midedge};
constexpr std::array schemes{loop, catmark, older, doo_sabin, midedge};

IndependenceCase one(const ExactScheme& scheme, std::uint32_t n, const IndependenceDomain& domain) {
  return independence_cases(scheme, {n}, {{domain, "", std::nullopt}}).front();
}
std::uint32_t rank(const ExactScheme& scheme, std::uint32_t n, const IndependenceDomain& domain) {
  return one(scheme, n, domain).rank;
}

std::vector<IndependenceCase> chapter(const ExactScheme& scheme, std::uint32_t n) {
  std::vector<IndependenceRequest> requests;
  for (const IndependenceDomain& domain : chapter_domains(scheme, n))
    requests.push_back(chapter_request(scheme, n, domain));
  return independence_cases(scheme, {n}, requests);
}

// The formulas that docs/derivations/independence.md proves for all valences.
std::uint32_t proved_rank(const ExactScheme& scheme, std::uint32_t n, std::uint32_t k) {
  switch (scheme.scheme) {
    case Scheme::loop:
      return std::min(n + 6, 11 + 2 * k);
    case Scheme::catmark:
      return std::min(2 * n + 8, k == 1 ? 18 : 17 + 2 * k);
    case Scheme::doo_sabin:
      return std::min(n + 5, 11U);
    default:
      return std::min(7 + 2 * k, n + 4 + n % 2);
  }
}

TEST(independence, ranks_on_rings_are_those_of_the_proof) {
  for (const ExactScheme& scheme : schemes) {
    for (std::uint32_t n = 5; n <= 19; ++n) {
      for (const std::uint32_t k : {1U, 2U, 3U, n / 2 - 2, n / 2 - 1, n - 5, n - 4, n - 3}) {
        if (k == 0) continue;
        ASSERT_EQ(rank(scheme, n, {Kind::rings, k}), proved_rank(scheme, n, k)) << n << " " << k;
      }
    }
  }
  for (const std::uint32_t n : {3U, 4U}) {
    for (const std::uint32_t k : {1U, 2U}) {
      EXPECT_EQ(rank(midedge, n, {Kind::rings, k}), proved_rank(midedge, n, k));
      EXPECT_EQ(rank(doo_sabin, n, {Kind::rings, k}), n + 5);
      EXPECT_EQ(rank(loop, n, {Kind::rings, k}), n + 6);
      EXPECT_EQ(rank(catmark, n, {Kind::rings, k}), 2 * n + 8);
    }
  }
}

TEST(independence, the_conjectures_hold) {
  for (const ExactScheme& scheme : {loop, catmark}) {
    for (const std::uint32_t n : {8U, 9U, 20U, 30U}) {
      const std::uint32_t k = conjectured_rings(scheme, n);
      for (const std::uint32_t rings : {k - 1, k}) {
        const IndependenceRequest request = chapter_request(scheme, n, {Kind::rings, rings});
        ASSERT_EQ(request.text, rings == k) << n;
        ASSERT_EQ(one(scheme, n, request.domain).independent(), rings == k) << n;
      }
    }
  }
  EXPECT_EQ(conjectured_rings(loop, 7), 0);
  EXPECT_EQ(conjectured_rings(catmark, 5), 0);
  EXPECT_EQ(conjectured_rings(older, 20), 0);
  EXPECT_EQ(conjectured_rings(doo_sabin, 20), 0);
  EXPECT_EQ(chapter_request(loop, 8, {Kind::rings, 1}).statement, "lemma 2, conjecture 1");
}

TEST(independence, the_text_is_wrong_in_two_places_and_nowhere_else) {
  std::set<std::string> wrong;
  for (const ExactScheme& scheme : {loop, catmark, older}) {
    for (std::uint32_t n = 3; n <= 14; ++n) {
      for (const IndependenceCase& found : chapter(scheme, n)) {
        if (found.text && *found.text != found.independent())
          wrong.insert(std::to_string(n) + " " + name_of(found.domain) + " " + std::to_string(found.rank));
      }
    }
  }
  EXPECT_EQ(wrong, (std::set<std::string>{"5 pieces:1,2 17", "5 pieces:2,3 17", "7 pieces:1,2 13",
                                          "7 pieces:1,3 13", "7 pieces:2,3 13"}));
}

TEST(independence, on_whole_pieces_annuli_and_closed_meshes) {
  for (std::uint32_t n = 3; n <= 12; ++n) {
    EXPECT_TRUE(one(loop, n, {Kind::omega}).independent());
    EXPECT_TRUE(one(catmark, n, {Kind::omega}).independent());
    EXPECT_EQ(one(doo_sabin, n, {Kind::omega}).independent(), n <= 6);
    EXPECT_EQ(one(midedge, n, {Kind::omega}).independent(), n % 2 == 1);
    for (const ExactScheme& scheme : schemes) {
      const bool alternates = scheme.scheme == Scheme::midedge && n % 2 == 0;
      EXPECT_EQ(one(scheme, n, {Kind::annulus}).independent(), !alternates);
      const bool cube = scheme.scheme == Scheme::catmark && !scheme.older_vertices && n == 3;
      const IndependenceCase closed = one(scheme, n, {Kind::global});
      EXPECT_EQ(closed.dimension - closed.rank, alternates || cube ? 1U : 0U) << n;
    }
  }
}

// A second corner that is regular changes nothing; otherwise both faces of Doo-Sabin hide what each hides alone, and
// Midedge has its alternating combination where both faces have it.
TEST(independence, on_pieces_with_two_corners) {
  const auto rank_of_all = [](const ExactScheme& scheme, std::uint32_t n, std::uint32_t m, bool opposite) {
    return independence_cases(scheme, {n, m, opposite}, {{{Kind::omega}, "", std::nullopt}}).front();
  };
  for (const ExactScheme& scheme : schemes) {
    const bool is_loop = scheme.scheme == Scheme::loop;
    for (std::uint32_t n = 3; n <= 10; ++n) {
      for (std::uint32_t m = n == 3 && is_loop ? 4 : 3; m <= 9; ++m) {
        for (const bool opposite : {false, true}) {
          if (is_loop && opposite) continue;
          const IndependenceCase found = rank_of_all(scheme, n, m, opposite);
          const std::uint32_t functions = is_loop                            ? n + m
                                          : scheme.scheme == Scheme::catmark ? 2 * n + 2 * m
                                                                             : n + m + 1;
          ASSERT_EQ(found.dimension, functions);
          std::uint32_t missing = 0;
          if (scheme.scheme == Scheme::doo_sabin) missing = (n > 6 ? n - 6 : 0) + (m > 6 ? m - 6 : 0);
          if (scheme.scheme == Scheme::midedge) missing = n % 2 == 0 && m % 2 == 0 ? 1 : 0;
          ASSERT_EQ(found.dimension - found.rank, missing) << n << " " << m << " " << opposite;
          const bool one_corner = m == (is_loop ? 6U : 4U);
          ASSERT_TRUE(!one_corner || found.rank == rank(scheme, n, {Kind::omega}));
        }
      }
    }
  }
}

// Each net is as large as the text's, and each piece of it is a part of the other's net.
TEST(two_corner_step, keeps_the_matrices_of_one_corner_where_the_other_is_regular) {
  for (const ExactScheme& scheme : {loop, catmark, midedge}) {
    const std::uint32_t regular = scheme.scheme == Scheme::loop ? 6 : 4;
    for (const std::uint32_t n : {3U, 5U, 8U}) {
      const TwoCornerStep split = two_corner_step(scheme, {n, regular, false}, std::lcm(n, regular));
      const PieceStep one = piece_step(scheme, n);
      EXPECT_EQ(split.step.dimension, one.dimension);
      EXPECT_EQ(split.step.pieces.size(), 2);
      EXPECT_EQ(split.parts[0].net.size(), one.kept);
      EXPECT_EQ(split.parts[0].valence, n);
      EXPECT_EQ(split.parts[1].valence, regular);
    }
  }
}

// Modulo small primes many ranks are too low; kernels tell, and other primes are tried.
TEST(independence, survives_unlucky_primes) {
  for (const ExactScheme& scheme : schemes) {
    for (std::uint32_t n = 3; n <= 12; ++n) {
      std::vector<IndependenceRequest> requests;
      for (const IndependenceDomain& domain : chapter_domains(scheme, n))
        requests.push_back({domain, "", std::nullopt});
      const auto right = independence_cases(scheme, {n}, requests),
                 found = independence_cases(scheme, {n}, requests, {}, 2);
      for (std::size_t i = 0; i < right.size(); ++i) {
        ASSERT_EQ(found[i].rank, right[i].rank) << n << " " << name_of(right[i].domain);
      }
    }
  }
}

TEST(independence, a_kernel_vanishes_on_the_domain_and_spans_what_is_missing) {
  for (const ExactScheme& scheme : schemes) {
    for (std::uint32_t n = 3; n <= 12; ++n) {
      for (const IndependenceCase& found : chapter(scheme, n)) {
        const RankCertificate& why = found.certificate;
        ASSERT_EQ(why.bound == RankCertificate::Bound::full, found.independent());
        if (why.bound != RankCertificate::Bound::kernel) continue;
        ASSERT_EQ(found.dimension - why.kernel.size() + why.left_out, found.rank);
        for (const PolynomialVector& v : why.kernel) ASSERT_FALSE(v.empty());
      }
    }
  }
}

TEST(domains, are_read_as_they_are_written) {
  for (const char* name : {"piece:1", "piece:3", "pieces:1,2", "pieces:2,3", "ring:7", "rings:12", "omega",
                           "annulus", "global"}) {
    const auto domain = parse_domain(name);
    ASSERT_TRUE(domain) << name;
    EXPECT_EQ(name_of(*domain), name);
  }
  for (const char* name :
       {"", "piece", "piece:", "piece:0", "piece:4", "pieces:1", "pieces:2,1", "pieces:1,1", "pieces:1,4",
        "ring:-1", "ring:1,2", "rings:x", "omega:1", "rings:99999999999", "Omega "}) {
    EXPECT_FALSE(parse_domain(name)) << name;
  }
}

}  // namespace
}  // namespace snug::cases_test
