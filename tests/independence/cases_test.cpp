#include <snug/independence/cases.h>

#include <gtest/gtest.h>
#include <snug/independence/modular.h>
#include <snug/independence/null_space.h>
#include <snug/independence/piece_step.h>

#include <algorithm>
#include <set>

namespace snug {
namespace {

using Kind = IndependenceDomain::Kind;

constexpr ExactScheme loop{Scheme::loop}, catmark{Scheme::catmark}, older{Scheme::catmark, true},
    doo_sabin{Scheme::doo_sabin}, midedge{Scheme::midedge};
constexpr std::array schemes{loop, catmark, older, doo_sabin, midedge};

IndependenceCase one(const ExactScheme& scheme, std::uint32_t n, const IndependenceDomain& domain) {
  return independence_cases(scheme, n, {{domain, "", std::nullopt}}).front();
}
std::uint32_t rank(const ExactScheme& scheme, std::uint32_t n, const IndependenceDomain& domain) {
  return one(scheme, n, domain).rank;
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
}

TEST(independence, the_conjectures_hold) {
  for (const ExactScheme& scheme : {loop, catmark}) {
    for (const std::uint32_t n : {8U, 9U, 20U, 30U}) {
      const auto cases = independence_cases(scheme, n, conjecture_requests(scheme, n));
      ASSERT_EQ(cases.size(), 2);
      for (const IndependenceCase& found : cases) ASSERT_EQ(found.independent(), *found.text);
      EXPECT_EQ(cases[0].domain.first + 1, cases[1].domain.first);
    }
  }
  EXPECT_TRUE(conjecture_requests(loop, 7).empty());
  EXPECT_TRUE(conjecture_requests(doo_sabin, 20).empty());
}

TEST(independence, the_text_is_wrong_in_two_places_and_nowhere_else) {
  std::set<std::string> wrong;
  for (const ExactScheme& scheme : {loop, catmark, older}) {
    for (std::uint32_t n = 3; n <= 14; ++n) {
      for (const IndependenceCase& found : independence_cases(scheme, n, chapter_requests(scheme, n))) {
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

TEST(independence, a_kernel_vanishes_on_the_domain_and_spans_what_is_missing) {
  for (const ExactScheme& scheme : schemes) {
    for (std::uint32_t n = 3; n <= 12; ++n) {
      for (const IndependenceCase& found : independence_cases(scheme, n, chapter_requests(scheme, n))) {
        const RankCertificate& why = found.certificate;
        ASSERT_EQ(why.bound == RankCertificate::Bound::full, found.independent());
        if (why.bound != RankCertificate::Bound::kernel) continue;
        ASSERT_EQ(found.dimension - why.kernel.size() + why.left_out, found.rank);
        for (const PolynomialVector& v : why.kernel) ASSERT_FALSE(v.empty());
      }
    }
  }
}

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
    for (const std::uint32_t n : {7U, 9U, 12U}) {
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
      EXPECT_EQ(masks.size(), is_loop ? 13 : scheme.dual() ? 12 : 21);
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

TEST(modular_field, has_a_root_of_exactly_its_order) {
  for (std::uint32_t n = 3; n <= 200; ++n) {
    const ModularField field = modular_field(n);
    ASSERT_EQ(field.prime % n, 1);
    ASSERT_LT(field.prime, 1U << 31);
    std::uint32_t power = 1;
    for (std::uint32_t i = 1; i <= n; ++i) {
      power = field.product(power, field.root);
      ASSERT_EQ(power == 1, i == n) << n;
    }
  }
}

TEST(null_space, is_a_basis_of_what_is_orthogonal) {
  const std::vector<std::vector<mpq_class>> rows{{1, mpq_class(1, 2), 0, 2}, {0, 0, mpq_class(2, 3), 1}};
  const auto basis = null_space(rows, 4);
  ASSERT_EQ(basis.size(), 2);
  for (const auto& v : basis) {
    for (const auto& row : rows) {
      mpq_class product;
      for (std::size_t i = 0; i < 4; ++i) product += row[i] * v[i];
      EXPECT_EQ(product, 0);
    }
  }
  EXPECT_EQ(null_space({}, 3).size(), 3);
}

}  // namespace
}  // namespace snug
