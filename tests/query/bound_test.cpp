#include <snug/bound.h>

#include <gtest/gtest.h>
#include <support/error.h>
#include <testing/surfaces.h>

#include <atomic>
#include <vector>

namespace snug::bound_test {
namespace {

struct Collected {
  std::vector<PatchEnclosure> pieces;
  BoundSummary summary;
};

Collected collect(const Surface& surface, const BoundOptions& options, const Run& run = {}) {
  Collected result;
  result.summary = bound(
      surface, options, [&](const PatchEnclosure& piece) { result.pieces.push_back(piece); }, run);
  return result;
}

bool same(const Collected& a, const Collected& b) {
  if (a.pieces.size() != b.pieces.size() || a.summary.splits != b.summary.splits) return false;
  for (std::size_t i = 0; i < a.pieces.size(); ++i) {
    const PatchEnclosure &x = a.pieces[i], &y = b.pieces[i];
    if (x.patch.owner != y.patch.owner || x.patch.part != y.patch.part || x.piece != y.piece ||
        x.level != y.level || x.corners != y.corners || x.offset.base != y.offset.base ||
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
  const Surface surface = testing::public_surface(
      oracle::meshes::disturbed(oracle::meshes::quartered(oracle::meshes::icosahedron()), 20, 0.1, random));
  BoundOptions options;
  options.error = 0.005;
  options.normals = true;
  const Collected serial = collect(surface, options, {.threads = 1});
  for (const int threads : {0, 2, 4}) {
    EXPECT_TRUE(same(serial, collect(surface, options, {.threads = threads}))) << threads;
  }
  const std::uint64_t budget = serial.summary.splits / 2;
  const Collected half = collect(surface, options, {.max_splits = budget});
  EXPECT_TRUE(same(half, collect(surface, options, {.threads = 1, .max_splits = budget})));
  EXPECT_EQ(half.summary.outcome, Outcome::budget_spent);
  EXPECT_EQ(half.summary.splits, budget);
}

TEST(bound, meets_its_tolerance_with_pieces_that_tile_every_face) {
  const Surface surface = testing::public_surface(oracle::meshes::icosahedron());
  BoundOptions options;
  options.error = 0.01;
  const Collected result = collect(surface, options);
  EXPECT_EQ(result.summary.outcome, Outcome::complete);
  EXPECT_LE(result.summary.max_radius, 0.005);
  std::vector<double> area(surface.owner_count(), 0);
  for (const PatchEnclosure& piece : result.pieces)
    area[piece.patch.owner] += std::ldexp(1.0, -2 * static_cast<int>(piece.level));
  for (const double a : area) EXPECT_EQ(a, 1);
}

TEST(bound, says_whether_rounding_or_the_budget_stops_it) {
  BoundOptions options;
  options.error = 1e-17;
  const Surface curved = testing::public_surface(oracle::meshes::octahedron());
  EXPECT_EQ(collect(curved, options, {.max_splits = 20000}).summary.outcome, Outcome::budget_spent);
  const Surface flat(testing::control_mesh(oracle::meshes::octahedron()), {.scheme = Scheme::flat});
  EXPECT_EQ(collect(flat, options, {.max_splits = 20000}).summary.outcome, Outcome::at_rounding);
}

TEST(bound, refuses_results_that_do_not_fit_a_double) {
  oracle::TwinMesh twin = oracle::meshes::icosahedron();
  for (oracle::Point& p : twin.points) {
    for (double& x : p) x *= 1.79e308;
  }
  const Surface surface = testing::public_surface(twin);
  BoundOptions options;
  options.level = 0;
  EXPECT_NO_THROW(static_cast<void>(collect(surface, options)));  // inside the control points' hull: it fits
}

TEST(bound, stops_when_asked) {
  const Surface surface = testing::public_surface(oracle::meshes::icosahedron());
  const std::atomic<bool> stop{true};
  WorkMonitor monitor;
  monitor.stop = &stop;
  EXPECT_THROW(bound(surface, {}, [](const PatchEnclosure&) {}, {.monitor = &monitor}), Interrupted);
}

}  // namespace
}  // namespace snug::bound_test
