#include <experiments/bound_counts.h>

#include <experiments/control_box.h>
#include <experiments/corner_nets.h>
#include <gtest/gtest.h>
#include <oracle/loop_twin.h>
#include <snug/curves.h>
#include <snug/surface/unscale.h>
#include <support/error.h>
#include <testing/curves.h>
#include <testing/patches.h>
#include <testing/surfaces.h>

#include <cmath>
#include <vector>

namespace snug::bound_counts_test {
namespace {

oracle::TwinMesh ball_mesh() { return oracle::meshes::quartered(oracle::meshes::icosahedron()); }
LimitSurface ball() { return testing::surface_of(ball_mesh()); }

TEST(bound_counts, are_those_of_bound_for_rows_and_tables) {
  const LimitSurface surface = ball();
  LayoutTables tables(surface.library());
  for (const auto& [way, method] :
       {std::pair{BoundWay::rows, BoundMethod::rows}, {BoundWay::ngon, BoundMethod::table}}) {
    for (const std::optional<double> tolerance : {std::optional<double>{}, {0.05}, {0.004}}) {
      BoundOptions options{.error = tolerance, .level = 2};
      const BoundSummary expected = bound(testing::public_surface(ball_mesh(), {.bounds = method}), options,
                                          [](const PatchEnclosure&) {});
      const PieceCount found = count_pieces(surface, tables, way, {.tolerance = tolerance, .level = 2});
      EXPECT_EQ(found.count, expected.count);
      EXPECT_EQ(found.splits, expected.splits);
      EXPECT_EQ(found.largest, expected.max_radius);
      EXPECT_TRUE(found.reached);
    }
  }
  const CurveSet curves = testing::curve_set(testing::assorted_polylines(3)[2], 3);
  const BoundSummary expected = bound(curves, {.error = 0.001}, [](const CurveEnclosure&) {});
  EXPECT_EQ(count_pieces(curves, BoundWay::rows, {.tolerance = 0.001}).count, expected.count);
}

// A crease of 2.5 through the middle of a regular mesh: after three splits it is smooth.
TEST(bound_counts, split_until_sharpness_has_decayed) {
  for (const Scheme scheme : {Scheme::loop, Scheme::catmark}) {
    const LimitSurface surface(
        bent_net(scheme, {NetCentre::semi_sharp, scheme == Scheme::loop ? 6u : 4u, 2.5}, 1), {scheme},
        std::make_shared<BoundsCache>());
    LayoutTables tables(surface.library());
    std::vector<double> area(surface.patch_count(), 0);
    const auto check = [&](PatchId root, const Patch& piece, double) {
      const unsigned level = piece.path.level();
      EXPECT_LE(level, 3u);
      area[root.index()] += std::ldexp(1.0, -2 * static_cast<int>(level));
      Patch patch = surface.patch(root);
      for (const char digit : piece.path.text()) {
        EXPECT_TRUE(patch.kind->transient());
        patch = split(patch, static_cast<unsigned>(digit - '0'));
      }
      EXPECT_FALSE(patch.kind->transient());
    };
    const PieceCount pieces = count_pieces(surface, tables, BoundWay::split, {}, check);
    EXPECT_TRUE(pieces.reached);
    for (const double a : area) EXPECT_EQ(a, 1);
    EXPECT_GT(pieces.count, count_pieces(surface, tables, BoundWay::rows, {}).count);
    const PieceCount fewer = count_pieces(surface, tables, BoundWay::split, {.budget = pieces.splits - 1});
    EXPECT_FALSE(fewer.reached);
    EXPECT_EQ(fewer.splits, pieces.splits - 1);
  }
}

TEST(bound_counts, of_control_boxes_are_far_more) {
  const LimitSurface surface = ball();
  LayoutTables tables(surface.library());
  const CountOptions options{.tolerance = 0.05};
  EXPECT_GT(count_pieces(surface, tables, BoundWay::control_box, options).count,
            4 * count_pieces(surface, tables, BoundWay::rows, options).count);
  BoundingPoints rows, control;
  const Patch patch = surface.patch(PatchId(0));
  bounding_points(surface.library().rows(*patch.kind), patch, rows);
  EXPECT_LT(2 * longest_side(outer_box(rows)), longest_side(control_box(patch, control)));
}

TEST(bound_counts, refuse_what_cannot_be_counted) {
  const LimitSurface surface = ball();
  LayoutTables tables(surface.library());
  EXPECT_THROW(static_cast<void>(count_pieces(surface, tables, BoundWay::rows, {.tolerance = -1.0})),
               InputError);
  EXPECT_THROW(static_cast<void>(count_pieces(surface, tables, BoundWay::rows, {.level = 61})), InputError);
  const CurveSet curves = testing::curve_set(testing::assorted_polylines(3)[2], 3);
  EXPECT_THROW(static_cast<void>(count_pieces(curves, BoundWay::ngon, {})), InputError);
}

TEST(control_boxes, contain_limit_points_of_patches) {
  BoundingPoints scratch;
  for (const oracle::TwinMesh& twin : testing::assorted_meshes(18)) {
    const LimitSurface surface = testing::surface_of(twin);
    const double unit = surface.scale().inverse().apply(1.0);
    std::vector<std::optional<Box3>> boxes(surface.face_count());
    for (const oracle::LimitSample& s : oracle::sample_uniform(twin, 3)) {
      std::optional<Box3>& box = boxes[s.face];
      if (!box) box = control_box(surface.patch(PatchId(s.face)), scratch);
      for (std::size_t a = 0; a < 3; ++a) {
        ASSERT_GE(s.position[a] / unit, box->lower[a] - s.error / unit);
        ASSERT_LE(s.position[a] / unit, box->upper[a] + s.error / unit);
      }
    }
  }
}

TEST(control_boxes, contain_limit_points_of_curves) {
  BoundingPoints scratch;
  for (const oracle::TwinPolyline& twin : testing::assorted_polylines(7)) {
    for (const int degree : {2, 3}) {
      const CurveSet curves = testing::curve_set(twin, degree);
      for (std::uint32_t e = 0; e < twin.edge_count(); ++e) {
        const Box3 box =
            unscaled(control_box(curves.edges().piece(EdgeId(e)), scratch), curves.edges().scale().inverse());
        for (int i = 0; i <= 32; ++i) {
          EXPECT_TRUE(testing::contains(box, oracle::curve_at(twin, degree, e, i / 32.0))) << e;
        }
      }
    }
  }
}

}  // namespace
}  // namespace snug::bound_counts_test
