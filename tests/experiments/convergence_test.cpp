#include <experiments/convergence.h>

#include <experiments/eigenvalues.h>
#include <gtest/gtest.h>
#include <snug/patch/evaluate.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <memory>
#include <numbers>
#include <string>
#include <vector>

namespace snug::convergence_test {
namespace {

// Data of all claims about measured factors: few nets, all levels.
const std::vector<RateRow>& measured() {
  static const std::vector<RateRow> rows = [] {
    RateOptions options;
    options.nets = 9;
    return measure_rates(options);
  }();
  return rows;
}

double factor(std::size_t n, BoundSource source, ThicknessMeasure measure) {
  for (const RateRow& row : measured()) {
    if (row.place.faces == n && row.source == source && row.measure == measure) return row.factor;
  }
  ADD_FAILURE() << "no row for valence " << n;
  return 0;
}

TEST(convergence, regular_corners_shrink_by_a_quarter) {
  for (const BoundSource source : all_bound_sources) {
    for (const ThicknessMeasure measure : all_thickness_measures) {
      EXPECT_NEAR(factor(6, source, measure), 0.25, 0.005) << name_of(measure);
    }
  }
}

TEST(convergence, the_characteristic_layout_beats_the_ngon_at_every_extraordinary_corner) {
  for (const std::size_t n : experiment_valences) {
    if (n == 6) continue;
    const double characteristic = factor(n, BoundSource::characteristic, ThicknessMeasure::radius);
    EXPECT_LT(characteristic, factor(n, BoundSource::ngon, ThicknessMeasure::radius)) << n;
  }
  EXPECT_LT(factor(8, BoundSource::characteristic, ThicknessMeasure::radius), 0.4);
  EXPECT_GT(factor(8, BoundSource::ngon, ThicknessMeasure::radius), 0.5);
}

// Lemma 12 at every level, and it loses more than rounding; of what has no table it says nothing.
TEST(convergence, thickness_is_at_most_the_largest_gap_times_the_differences) {
  std::size_t levels = 0;
  for (const RateRow& row : measured()) {
    const bool said = row.source != BoundSource::rows && row.measure == ThicknessMeasure::interval;
    ASSERT_EQ(row.lemma.bound.size(), said ? row.thickness.size() : 0) << row.place.faces;
    for (std::size_t level = 0; level < row.lemma.bound.size(); ++level, ++levels) {
      EXPECT_GT(row.lemma.bound[level], 1.3 * row.thickness[level]) << row.place.faces << " level " << level;
      EXPECT_LT(row.lemma.bound[level], 40 * row.thickness[level]) << row.place.faces << " level " << level;
    }
    EXPECT_TRUE(!said || (row.lemma.gap > 0.05 && row.lemma.gap < 0.2)) << row.lemma.gap;
  }
  EXPECT_GT(levels, 150u);
}

TEST(convergence, factors_are_the_eigenvalues_of_theory) {
  for (const RateRow& row : measured()) {
    EXPECT_NEAR(row.factor / row.expected, 1, 0.1) << row.place.faces << name_of(row.measure);
    EXPECT_EQ(row.expected, expected_factor(row.place.faces, row.source, row.measure));
  }
  EXPECT_EQ(measured().size(), experiment_valences.size() * all_bound_sources.size() * 3);
}

// The factor by which one step of subdivision multiplies heights on the ring, `centre` at the middle and
// cos(block * angle) on the ring.
double factor_of_heights(std::size_t n, double centre, int block) {
  ControlMesh mesh = fan_mesh(n, 2);
  mesh.points[0].z = centre;
  for (std::size_t i = 0; i < n; ++i) {
    mesh.points[1 + i].z =
        std::cos(2 * std::numbers::pi * block * static_cast<double>(i) / static_cast<double>(n));
  }
  const LimitSurface surface(std::move(mesh), {}, std::make_shared<BoundsCache>());
  const Patch patch = surface.patch(PatchId(0)), child = split(patch, 0);
  const auto height = [](const Patch& p) { return p.origin.z + p.points[p.to_kind(1)].z; };
  return height(child) / height(patch);
}

TEST(convergence, eigenvalues_are_those_of_the_subdivision) {
  for (const std::size_t n : experiment_valences) {
    const LargestEigenvalues eigenvalues = corner_eigenvalues(n);
    EXPECT_NEAR(factor_of_heights(n, 0, 1), eigenvalues.subdominant, 1e-14) << n;
    EXPECT_LT(eigenvalues.next, eigenvalues.subdominant) << n;
    // The eigenvector of block 0 has the middle at -8/3 a(n) where the ring is at 1.
    const double square = eigenvalues.subdominant * eigenvalues.subdominant;
    EXPECT_NEAR(factor_of_heights(n, 8.0 / 3 * (square - 5.0 / 8), 0), square, 1e-14) << n;
    const double next = n == 3 ? 1.0 / 8 : std::max(square, factor_of_heights(n, 0, 2));
    EXPECT_NEAR(eigenvalues.next, next, 1e-14) << n;
  }
}

// docs/convergence.md gives the outer points of the characteristic layout in closed form.
TEST(convergence, the_characteristic_layout_is_as_the_page_says) {
  for (const std::size_t n : experiment_valences) {
    const LimitSurface surface(fan_mesh(n, 2), {}, std::make_shared<BoundsCache>());
    const Kind& kind = surface.kind(PatchId(0));
    const double g = std::cos(2 * std::numbers::pi / static_cast<double>(n));
    const double b = (13 + 2 * g) / (5 + 4 * g), c = 3 / (2 + 2 * g);
    std::size_t on_spoke = 0, between = 0;
    for (const LayoutPoint& u : characteristic_layout(kind)) {
      // The extraordinary corner may be any of the kind's: distances are what does not depend on that.
      const std::array<double, 3> all{u[0], u[1], 1 - u[0] - u[1]};
      for (std::size_t k = 0; k < 3; ++k) {
        const double one = all[k], two = all[(k + 1) % 3];
        on_spoke += (std::fabs(one - b) < 1e-12 && std::fabs(two) < 1e-12) ||
                    (std::fabs(two - b) < 1e-12 && std::fabs(one) < 1e-12);
        between += std::fabs(one - c) < 1e-12 && std::fabs(two - c) < 1e-12;
      }
    }
    EXPECT_GE(on_spoke, 2u) << n;
    EXPECT_GE(between, 1u) << n;
  }
}

TEST(convergence, fits_the_second_half_of_a_sequence) {
  std::vector<double> values{5, 5, 5, 5};
  for (int i = 0; i < 5; ++i) values.push_back(std::pow(0.3, i));
  EXPECT_NEAR(fitted_factor(values), 0.3, 1e-14);
}

TEST(convergence, stops_where_rounding_shows) {
  const LimitSurface surface(corner_net(NetShape::bent, 3, 1), {}, std::make_shared<BoundsCache>());
  LayoutTables tables(surface.library());
  for (const BoundSource source : all_bound_sources) {
    for (const Thicknesses& thickness : corner_thicknesses(surface, PatchId(0), tables, source, 40)) {
      ASSERT_GT(thickness.size(), 8u);
      EXPECT_LT(thickness.size(), 30u);
      for (std::size_t i = 1; i < thickness.size(); ++i) EXPECT_LT(thickness[i], thickness[i - 1]);
    }
  }
}

// No enclosure is thinner across the surface than the surface is: limit points lie in its slab.
TEST(convergence, slabs_along_the_normal_hold_limit_points) {
  for (const std::size_t n : {3u, 6u, 9u}) {
    const LimitSurface surface(corner_net(NetShape::bent, n, 5), {}, std::make_shared<BoundsCache>());
    Patch patch = surface.patch(PatchId(0));
    const Vector3 normal = *limit_frame(patch, TriangleParameter{0, 0}).normal;
    const double back = surface.scale().inverse().apply(1.0);
    std::vector<double> widths;
    for (int level = 0; level <= 6; ++level) {
      double lower = INFINITY, upper = -INFINITY;
      for (int i = 0; i <= 16; ++i) {
        for (int j = 0; i + j <= 16; ++j) {
          const double at = dot(normal, limit_point(patch, {i / 16.0, j / 16.0}).relative);
          lower = std::min(lower, at);
          upper = std::max(upper, at);
        }
      }
      widths.push_back(back * (upper - lower));
      patch = split(patch, 0);
    }
    LayoutTables tables(surface.library());
    for (const BoundSource source : all_bound_sources) {
      const Thicknesses across = corner_thicknesses(surface, PatchId(0), tables, source, 6)[2];
      ASSERT_EQ(across.size(), widths.size());
      for (std::size_t i = 0; i < widths.size(); ++i) EXPECT_GE(across[i], widths[i]) << n << " " << i;
    }
  }
}

TEST(convergence, does_not_depend_on_threads) {
  RateOptions options;
  options.nets = 5;
  options.levels = 5;
  options.threads = 1;
  const std::vector<RateRow> one = measure_rates(options);
  options.threads = 2;
  const std::vector<RateRow> two = measure_rates(options);
  ASSERT_EQ(one.size(), two.size());
  for (std::size_t i = 0; i < one.size(); ++i) EXPECT_EQ(one[i].thickness, two[i].thickness);
}

TEST(convergence, other_schemes_shrink_along_the_normal_by_the_next_eigenvalue) {
  for (const Scheme scheme : {Scheme::catmark, Scheme::doo_sabin, Scheme::midedge}) {
    RateOptions options;
    options.scheme = scheme;
    options.nets = 5;
    for (const RateRow& row : measure_rates(options)) {
      if (row.measure != ThicknessMeasure::normal) continue;
      // j/4^j where the matrix has too few eigenvectors.
      const double most = scheme == Scheme::catmark ? 1.05 : 1.15;
      EXPECT_GT(row.factor, 0.9 * row.expected) << name_of(scheme) << row.place.faces;
      EXPECT_LT(row.factor, most * row.expected) << name_of(scheme) << row.place.faces;
    }
  }
}

TEST(convergence, regular_corners_of_every_scheme_shrink_by_a_quarter) {
  for (const Scheme scheme : {Scheme::catmark, Scheme::doo_sabin, Scheme::midedge}) {
    EXPECT_DOUBLE_EQ(corner_eigenvalues(4, scheme).subdominant, 0.5);
    EXPECT_DOUBLE_EQ(corner_eigenvalues(4, scheme).next, 0.25);
    for (const ThicknessMeasure measure : all_thickness_measures) {
      EXPECT_DOUBLE_EQ(expected_factor(4, {}, measure, scheme), 0.25);
    }
  }
}

TEST(convergence, tables_of_other_schemes_shrink_by_the_subdominant_eigenvalue) {
  for (const Scheme scheme : {Scheme::catmark, Scheme::doo_sabin, Scheme::midedge}) {
    RateOptions options;
    options.scheme = scheme;
    options.nets = 5;
    std::size_t tables = 0;
    for (const RateRow& row : measure_rates(options)) {
      if (row.source == BoundSource::rows) continue;
      ++tables;
      // Midedge at 3 faces: j/4^j.
      EXPECT_NEAR(row.factor / row.expected, 1, 0.13) << name_of(scheme) << row.place.faces;
    }
    EXPECT_EQ(tables, 10u * all_thickness_measures.size());
  }
}

TEST(convergence, boundaries_and_creases_shrink_by_the_eigenvalues_of_their_rules) {
  for (const Scheme scheme : {Scheme::loop, Scheme::catmark}) {
    for (const NetCentre centre : all_net_centres) {
      if (centre == NetCentre::interior) continue;
      RateOptions options;
      options.scheme = scheme;
      options.centre = centre;
      options.nets = 3;
      options.levels = 36;
      const std::vector<RateRow> rows = measure_rates(options);
      EXPECT_GE(rows.size(), centre == NetCentre::semi_sharp ? 24u : 50u);
      for (const RateRow& row : rows) {
        const std::string where = std::string(name_of(scheme)) + ", " + name_of(centre) + ", " +
                                  std::to_string(row.place.faces) + ", " + name_of(row.measure);
        // One face of Catmull-Clark on a smooth boundary: j/4^j, and needles whose tips are refined no
        // further.
        const bool needle =
            scheme == Scheme::catmark && row.source == BoundSource::rows &&
            row.measure != ThicknessMeasure::normal &&
            (row.place == NetPlace{NetCentre::boundary, 1} || row.place == NetPlace{NetCentre::crease, 3});
        EXPECT_GT(row.factor, 0.9 * row.expected) << where;
        EXPECT_LT(row.factor, (needle ? 2 : 1.15) * row.expected) << where;
      }
    }
  }
}

// derivations/loop_limits.md and catmark_limits.md: along 1/2 and 1/4, inside Fourier modes.
TEST(convergence, eigenvalues_of_boundaries_are_those_derived) {
  for (std::size_t n = 1; n <= 12; ++n) {
    for (const Scheme scheme : {Scheme::loop, Scheme::catmark}) {
      for (const NetCentre centre : {NetCentre::boundary, NetCentre::corner}) {
        const bool curve = centre == NetCentre::boundary;
        std::vector<double> expected{0.5, curve ? 0.25 : 0.5, 0.125};
        for (std::size_t i = 1; i < n; ++i) {
          const double c = std::cos(std::numbers::pi * static_cast<double>(i) / static_cast<double>(n));
          expected.push_back(scheme == Scheme::loop ? 0.375 + c / 4
                                                    : (5 + c + std::sqrt((1 + c) * (9 + c))) / 16);
        }
        if (scheme == Scheme::catmark) expected.push_back(0.25);
        std::sort(expected.begin(), expected.end(), std::greater<>());
        // Eigenvalues without an eigenvector of their own come out with half the digits.
        const LargestEigenvalues found = corner_eigenvalues(scheme, {centre, n});
        EXPECT_NEAR(found.subdominant, expected[0], 1e-7) << name_of(scheme) << n;
        EXPECT_NEAR(found.second, expected[1], 1e-7) << name_of(scheme) << n;
        EXPECT_NEAR(found.next, expected[2], 1e-7) << name_of(scheme) << n;
      }
    }
  }
}

TEST(convergence, the_corners_matrix_has_the_eigenvalues_in_closed_form) {
  for (const Scheme scheme : {Scheme::loop, Scheme::catmark, Scheme::doo_sabin, Scheme::midedge}) {
    for (const std::size_t n : {3u, 4u, 5u, 7u, 12u}) {
      const LimitSurface surface(bent_net(scheme, {NetCentre::interior, n}, 1), {scheme},
                                 std::make_shared<BoundsCache>());
      const std::vector<double> sizes =
          eigenvalue_sizes(corner_matrix(surface.patch(PatchId(surface.patches_of(0).begin))));
      const LargestEigenvalues closed = corner_eigenvalues(n, scheme);
      EXPECT_NEAR(sizes[0], 1, 1e-12);
      EXPECT_NEAR(sizes[1], closed.subdominant, 1e-6) << name_of(scheme) << n;
      EXPECT_NEAR(sizes[2], closed.second, 1e-6) << name_of(scheme) << n;
      EXPECT_NEAR(sizes[3], closed.next, 1e-6) << name_of(scheme) << n;
    }
  }
}

TEST(convergence, eigenvalues_may_be_complex) {
  // A turn, twice as large; and a permutation of three.
  EXPECT_NEAR(eigenvalue_sizes({2, {0, -2, 2, 0}})[1], 2, 1e-14);
  for (const double size : eigenvalue_sizes({3, {0, 0, 1, 1, 0, 0, 0, 1, 0}})) EXPECT_NEAR(size, 1, 1e-13);
  EXPECT_EQ(eigenvalue_sizes({1, {-3}}), std::vector<double>{3});
}

// Along a boundary and across they shrink by different factors: the triangle of the corners becomes a needle.
// The fit has another way for these, which did not refine tips: radii grew 65 times at level 9.
TEST(convergence, needles_keep_their_rate) {
  RateOptions options;
  options.centre = NetCentre::boundary;
  options.nets = 3;
  options.levels = 20;
  for (const RateRow& row : measure_rates(options)) {
    if (row.place.faces != 2 || row.source != BoundSource::rows) continue;
    for (std::size_t i = 4; i < row.thickness.size(); ++i) {
      EXPECT_LT(row.thickness[i], 0.45 * row.thickness[i - 1]) << name_of(row.measure) << i;
    }
  }
}

TEST(convergence, every_dart_has_a_normal) {
  for (const Scheme scheme : {Scheme::loop, Scheme::catmark}) {
    RateOptions options;
    options.scheme = scheme;
    options.centre = NetCentre::dart;
    options.nets = 1;
    options.levels = 6;
    EXPECT_EQ(measure_rates(options).size(), 10u * 2 * 3) << name_of(scheme);
  }
}

}  // namespace
}  // namespace snug::convergence_test
