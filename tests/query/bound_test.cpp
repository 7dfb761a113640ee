#include <snug/query/bound.h>

#include <experiments/corner_nets.h>
#include <gtest/gtest.h>
#include <snug/base/error.h>
#include <testing/patches.h>

#include <vector>

namespace snug {
namespace {

struct Collected {
  std::vector<PieceEnclosure> pieces;
  BoundSummary summary;
};

Collected collect(const LimitSurface& surface, const BoundOptions& options) {
  Collected result;
  result.summary =
      bound(surface, options, [&](const PieceEnclosure& piece) { result.pieces.push_back(piece); });
  return result;
}

bool same(const Collected& a, const Collected& b) {
  if (a.pieces.size() != b.pieces.size() || a.summary.splits != b.summary.splits) return false;
  for (std::size_t i = 0; i < a.pieces.size(); ++i) {
    const PieceEnclosure &x = a.pieces[i], &y = b.pieces[i];
    if (x.patch != y.patch || !(x.path == y.path) || x.offset->base != y.offset->base ||
        x.offset->radius != y.offset->radius || x.interval->corner != y.interval->corner) {
      return false;
    }
  }
  return true;
}

TEST(bound, is_the_same_for_any_number_of_threads) {
  std::mt19937_64 random(24);
  const LimitSurface surface = testing::surface_of(
      oracle::meshes::disturbed(oracle::meshes::quartered(oracle::meshes::icosahedron()), 20, 0.1, random));
  BoundOptions options;
  options.tolerance = 0.005;
  options.threads = 1;
  const Collected serial = collect(surface, options);
  for (const int threads : {0, 2, 4}) {
    options.threads = threads;
    EXPECT_TRUE(same(serial, collect(surface, options))) << threads;
  }
  options.budget = serial.summary.splits / 2;
  const Collected half = collect(surface, options);
  options.threads = 1;
  EXPECT_TRUE(same(half, collect(surface, options)));
  EXPECT_FALSE(half.summary.reached);
  EXPECT_EQ(half.summary.splits, options.budget);
}

TEST(bound, meets_its_tolerance_with_pieces_that_tile_every_face) {
  const LimitSurface surface = testing::surface_of(oracle::meshes::icosahedron());
  BoundOptions options;
  options.tolerance = 0.01;
  const Collected result = collect(surface, options);
  EXPECT_TRUE(result.summary.reached);
  EXPECT_LE(result.summary.max_radius, 0.005);
  std::vector<double> area(surface.face_count(), 0);
  for (const PieceEnclosure& piece : result.pieces)
    area[piece.patch.index()] += std::ldexp(1.0, -2 * static_cast<int>(piece.path.level()));
  for (const double a : area) EXPECT_EQ(a, 1);
}

// A crease of 2.5 through the middle of a regular mesh: after three splits it is smooth.
TEST(bound, splits_until_sharpness_has_decayed) {
  for (const Scheme scheme : {Scheme::loop, Scheme::catmark}) {
    const LimitSurface surface(
        bent_net(scheme, {NetCentre::semi_sharp, scheme == Scheme::loop ? 6u : 4u, 2.5}, 1), {scheme},
        std::make_shared<BoundsCache>(), 1);
    BoundOptions options;
    const Collected whole = collect(surface, options);
    options.passing = PassingMethod::split;
    const Collected pieces = collect(surface, options);
    EXPECT_TRUE(pieces.summary.reached);
    std::vector<double> area(surface.patch_count(), 0);
    for (const PieceEnclosure& piece : pieces.pieces) {
      const unsigned level = piece.path.level();
      EXPECT_LE(level, 3u);
      area[piece.patch.index()] += std::ldexp(1.0, -2 * static_cast<int>(level));
      Patch patch = surface.patch(piece.patch);
      for (const char digit : piece.path.text()) {
        EXPECT_TRUE(patch.kind->passing());
        patch = split(patch, static_cast<unsigned>(digit - '0'));
      }
      EXPECT_FALSE(patch.kind->passing());
    }
    for (const double a : area) EXPECT_EQ(a, 1);
    EXPECT_GT(pieces.summary.count, whole.summary.count);
    options.budget = pieces.summary.splits - 1;
    const Collected fewer = collect(surface, options);
    EXPECT_FALSE(fewer.summary.reached);
    EXPECT_EQ(fewer.summary.splits, options.budget);
  }
}

TEST(bound, says_so_when_rounding_stops_it) {
  const LimitSurface surface = testing::surface_of(oracle::meshes::octahedron());
  BoundOptions options;
  options.tolerance = 1e-17;
  options.budget = 20000;
  const Collected result = collect(surface, options);
  EXPECT_FALSE(result.summary.reached);
}

TEST(bound, by_control_boxes_contains_corners_and_is_looser) {
  const LimitSurface surface = testing::surface_of(oracle::meshes::icosahedron());
  BoundOptions options;
  const double rows = collect(surface, options).summary.max_radius;
  options.method = BoundMethod::control_box;
  const Collected boxes = collect(surface, options);
  EXPECT_GT(boxes.summary.max_radius, rows);
  for (const PieceEnclosure& piece : boxes.pieces) {
    for (const Point3& p : piece.corners) {
      for (std::size_t k = 0; k < 3; ++k) {
        EXPECT_GE(p[k], piece.box->lower[k]);
        EXPECT_LE(p[k], piece.box->upper[k]);
      }
    }
  }
}

TEST(bound, refuses_results_that_do_not_fit_a_double) {
  oracle::TwinMesh twin = oracle::meshes::icosahedron();
  for (oracle::Point& p : twin.points) {
    for (double& x : p) x *= 1.79e308;
  }
  const LimitSurface surface = testing::surface_of(twin);
  BoundOptions options;
  options.level = 0;
  EXPECT_NO_THROW(static_cast<void>(collect(surface, options)));  // inside the control points' hull: it fits
}

TEST(bound, stops_when_asked) {
  const LimitSurface surface = testing::surface_of(oracle::meshes::icosahedron());
  const std::atomic<bool> stop{true};
  WorkMonitor monitor;
  monitor.stop = &stop;
  EXPECT_THROW(bound(
                   surface, {}, [](const PieceEnclosure&) {}, monitor),
               Interrupted);
}

}  // namespace
}  // namespace snug
