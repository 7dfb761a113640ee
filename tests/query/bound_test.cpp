#include <snug/query/bound.h>

#include <gtest/gtest.h>
#include <support/error.h>
#include <testing/patches.h>

#include <vector>

namespace snug::bound_test {
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
    if (x.patch != y.patch || !(x.path == y.path) || x.offset.base != y.offset.base ||
        x.offset.radius != y.offset.radius || x.interval.corner != y.interval.corner ||
        x.normals.has_value() != y.normals.has_value()) {
      return false;
    }
    if (x.normals && (x.normals->axis != y.normals->axis || x.normals->angle != y.normals->angle))
      return false;
  }
  return true;
}

TEST(bound, is_the_same_for_any_number_of_threads) {
  std::mt19937_64 random(24);
  const LimitSurface surface = testing::surface_of(
      oracle::meshes::disturbed(oracle::meshes::quartered(oracle::meshes::icosahedron()), 20, 0.1, random));
  BoundOptions options;
  options.tolerance = 0.005;
  options.normals = true;
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

TEST(bound, says_so_when_rounding_stops_it) {
  const LimitSurface surface = testing::surface_of(oracle::meshes::octahedron());
  BoundOptions options;
  options.tolerance = 1e-17;
  options.budget = 20000;
  const Collected result = collect(surface, options);
  EXPECT_FALSE(result.summary.reached);
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
}  // namespace snug::bound_test
