#include <experiments/bound_source.h>

#include <gtest/gtest.h>
#include <oracle/loop_twin.h>
#include <snug/scheme/rules.h>
#include <testing/containment.h>
#include <testing/kinds.h>
#include <testing/patches.h>

#include <vector>

namespace snug::bound_source_test {
namespace {

using testing::inside;

TEST(characteristic_layout, shrinks_by_the_subdominant_eigenvalue) {
  KindCache library;
  for (const std::size_t n : {3u, 4u, 5u, 7u, 8u, 12u, 50u}) {
    const std::size_t centre = n < 6 ? 0 : 2;
    KindKey key{Scheme::loop, {inside(6), inside(6), inside(6)}};
    key.corners[centre] = inside(n);
    const Kind& kind = library.find(key);
    const auto layout = characteristic_layout(kind);
    const auto origin = layout[centre];
    const Stencils step = kind.children()[centre].stencils();
    for (std::size_t r = 0; r < layout.size(); ++r) {
      const auto row = step.row(r);
      for (std::size_t a = 0; a < 2; ++a) {
        double refined = 0;
        for (std::size_t i = 0; i < row.sources.size(); ++i)
          refined += row.weights[i] * layout[row.sources[i]][a];
        EXPECT_NEAR(refined - origin[a],
                    rules_of(Scheme::loop).shrink_factor(inside(n)) * (layout[r][a] - origin[a]), 1e-13)
            << n;
      }
    }
    EXPECT_NE(layout, make_layout(kind)) << n;
  }
}

TEST(characteristic_layout, is_that_of_the_library_where_not_one_corner_alone_is_extraordinary) {
  KindCache library;
  for (const KindKey& key : testing::assorted_kinds()) {
    const bool one = std::all_of(key.corners.begin(), key.corners.end(), [](auto& f) { return f.closed; }) &&
                     std::count_if(key.corners.begin(), key.corners.end(),
                                   [](auto& f) { return !rules_of(Scheme::loop).regular(f); }) == 1;
    const Kind& kind = library.find(key);
    EXPECT_EQ(one, characteristic_layout(kind) != make_layout(kind));
  }
  for (const Scheme scheme : {Scheme::catmark, Scheme::doo_sabin, Scheme::midedge}) {
    const Kind& kind = library.find({scheme, {inside(4), inside(7), inside(4), inside(4)}});
    EXPECT_EQ(characteristic_layout(kind), make_layout(kind));
  }
}

// Tables of any layout are sound: limit points of the twin lie in what they give.
TEST(layout_tables, contain_limit_points_near_every_corner) {
  std::mt19937_64 random(45);
  BoundingPoints scratch;
  std::size_t checks = 0;
  for (const std::uint32_t n : {3u, 4u, 5u, 6u, 7u, 9u, 12u, 40u}) {
    // Two rings around the middle: its patches have one extraordinary corner.
    const oracle::TwinMesh twin =
        oracle::meshes::disturbed(oracle::meshes::quartered(oracle::meshes::bipyramid(n)), 0, 0.05, random);
    const LimitSurface surface = testing::surface_of(twin);
    LayoutTables tables(surface.library());
    for (std::uint32_t face = 0; face < 8; ++face) {
      const Patch patch = surface.patch(PatchId(face));
      std::vector<oracle::LimitSample> samples;
      for (std::uint32_t corner = 0; corner < 3; ++corner) {
        const auto near = oracle::sample_near_corner(twin, face, corner, 30);
        samples.insert(samples.end(), near.begin(), near.end());
      }
      for (const BoundSource source : all_bound_sources) {
        const OffsetTriangle offset = tables.offset(patch, source, scratch);
        const double unit = surface.scale().inverse().apply(1.0);
        for (const oracle::LimitSample& s : samples) {
          testing::Extended p{s.position[0], s.position[1], s.position[2]};
          for (auto& x : p) x /= unit;
          ASSERT_TRUE(testing::within_radius(p, offset.base, offset.radius + 2 * s.error / unit + 1e-17))
              << n << ", face " << face;
          ++checks;
        }
      }
    }
  }
  EXPECT_GT(checks, 10'000u);
}

}  // namespace
}  // namespace snug::bound_source_test
