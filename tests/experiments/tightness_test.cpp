#include <experiments/tightness.h>

#include <gtest/gtest.h>
#include <snug/search/piece.h>
#include <testing/patches.h>

#include <memory>
#include <vector>

namespace snug::tightness_test {
namespace {

LimitSurface surface_of_net(ControlMesh mesh) {
  return LimitSurface(std::move(mesh), {}, std::make_shared<BoundsCache>());
}

TEST(corner_nets, have_one_extraordinary_vertex) {
  for (const std::size_t n : experiment_valences) {
    for (const NetShape shape : all_net_shapes) {
      const ControlMesh mesh = corner_net(shape, n, 3);
      EXPECT_EQ(mesh.points, corner_net(shape, n, 3).points);
      EXPECT_NE(mesh.points, corner_net(shape, n, 4).points);
      const LimitSurface surface = surface_of_net(mesh);
      for (std::size_t f = 0; f < n; ++f) {
        EXPECT_EQ(mesh.face(FaceId(f))[0], VertexId(0));
        const Kind& kind = surface.kind(PatchId(f));
        std::size_t irregular = 0, of_valence_n = 0;
        for (std::size_t k = 0; k < 3; ++k) {
          irregular += !kind.regular_corner(k);
          of_valence_n += kind.corner(k).closed && kind.corner(k).faces() == n;
        }
        EXPECT_EQ(irregular, n == 6 ? 0u : 1u);
        EXPECT_EQ(of_valence_n, n == 6 ? 3u : 1u);
      }
    }
  }
}

TEST(tightness, no_radius_is_below_the_least) {
  BoundingPoints scratch;
  for (const NetShape shape : all_net_shapes) {
    for (const std::size_t n : experiment_valences) {
      for (std::uint64_t seed = 1; seed <= 3; ++seed) {
        const LimitSurface surface = surface_of_net(corner_net(shape, n, seed));
        const Patch patch = surface.patch(PatchId(0));
        const LimitLattice lattice(patch, 24);
        LayoutTables tables(surface.library());
        for (const BoundSource source : all_bound_sources) {
          const OffsetTriangle offset = tables.offset(patch, source, scratch);
          EXPECT_GE(offset.radius, lattice.min_radius(offset.base)) << name_of(shape) << n;
        }
      }
    }
  }
}

// In the regular flat net the limit is the triangle of its corners, wherever a base hovers over it.
TEST(tightness, finds_the_height_of_a_triangle_over_a_flat_patch) {
  const LimitSurface surface = surface_of_net(fan_mesh(6, 2));
  const Patch patch = surface.patch(PatchId(0));
  const LimitLattice lattice(patch, 8);
  const auto corners = limit_corners(patch);
  Triangle base;
  for (std::size_t k = 0; k < 3; ++k) base[k] = patch.origin + corners[k] + Vector3{0, 0, 0.375};
  EXPECT_NEAR(lattice.min_radius(base), 0.375, 1e-14);
  // Of a tilted one the farthest point is off the lattice's own: the far corner beyond the base's.
  base[1] = base[0] + 0.5 * (base[1] - base[0]);
  base[2] = base[0] + 0.5 * (base[2] - base[0]);
  EXPECT_NEAR(lattice.min_radius(base), std::hypot(0.375, 0.5 * length(corners[1] - corners[0])), 1e-12);
}

// Points between those of the lattice count: a coarse lattice finds what a fine one does.
TEST(tightness, searches_between_the_points_of_the_lattice) {
  for (const std::size_t n : {5u, 7u}) {
    const LimitSurface surface = surface_of_net(corner_net(NetShape::bent, n, 2));
    const Patch patch = surface.patch(PatchId(0));
    const OffsetTriangle offset = [&] {
      BoundingPoints scratch;
      return make_piece(surface.library(), PatchId(0), patch, scratch).offset;
    }();
    EXPECT_NEAR(LimitLattice(patch, 8).min_radius(offset.base),
                LimitLattice(patch, 200).min_radius(offset.base), 1e-7);
  }
}

// docs/convergence.md: why radii of bounding rows shrink by the subdominant eigenvalue only below valence six.
TEST(tightness, flat_patches_bulge_beyond_their_corners_below_valence_six_and_not_above) {
  BoundingPoints scratch;
  for (const std::size_t n : experiment_valences) {
    const LimitSurface surface = surface_of_net(fan_mesh(n, 2));
    Patch patch = surface.patch(PatchId(0));
    for (int level = 0; level < 6; ++level) patch = split(patch, 0);
    const auto corners = limit_corners(patch);
    const double edge = length(corners[1] - corners[0]);
    const OffsetTriangle offset = make_piece(surface.library(), PatchId(0), patch, scratch).offset;
    const double bulge = LimitLattice(patch, 64).min_radius(offset.base) / edge;
    const double radius = offset.radius / edge;
    if (n < 6) {
      EXPECT_NEAR(bulge, n == 3 ? 0.249 : n == 4 ? 0.107 : 0.0385, 5e-4) << n;
      EXPECT_NEAR(radius, bulge, 1e-4) << n;
    } else {
      EXPECT_LT(bulge, 1e-9) << n;
      EXPECT_LT(radius, 1e-6) << n;
    }
  }
}

TEST(tightness, rows_are_near_the_least_on_bent_nets_and_nearer_than_tables) {
  TightnessOptions options;
  options.nets = 8;
  options.steps = 16;
  const std::vector<TightnessRow> rows = measure_tightness(options);
  ASSERT_EQ(rows.size(), all_net_shapes.size() * experiment_valences.size() * all_bound_sources.size());
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const TightnessRow& row = rows[i];
    EXPECT_EQ(row.patches, 16u);
    EXPECT_GE(row.median, 1);
    EXPECT_GE(row.high, row.median);
    EXPECT_GE(row.most, row.high);
    const bool by_rows = row.source == BoundSource::rows;
    if (by_rows) {
      EXPECT_EQ(row.over_rows, 1);
    }
    // The tip's net sticks out at corners of higher valence, and would show where little else does.
    if (row.shape == NetShape::flat && by_rows) {
      EXPECT_LT(row.median, 1.15) << row.valence;
    }
    if (row.shape == NetShape::bent) {
      EXPECT_LT(row.median, by_rows ? 1.06 : 8) << row.valence;
      EXPECT_GT(row.median, by_rows ? 1 : 1.3) << row.valence;
    }
  }
}

TEST(tightness, does_not_depend_on_threads) {
  TightnessOptions options;
  options.nets = 3;
  options.steps = 4;
  options.threads = 1;
  const std::vector<TightnessRow> one = measure_tightness(options);
  options.threads = 2;
  const std::vector<TightnessRow> two = measure_tightness(options);
  ASSERT_EQ(one.size(), two.size());
  for (std::size_t i = 0; i < one.size(); ++i) {
    EXPECT_EQ(one[i].median, two[i].median);
    EXPECT_EQ(one[i].most, two[i].most);
  }
}

}  // namespace
}  // namespace snug::tightness_test
