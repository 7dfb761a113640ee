// Verdicts against the brute-force twin, on random placements of which a third are tuned to a true distance
// between 0.5 and 2 tolerances. SNUG_PLACEMENTS sets how many; the default keeps the test short.

#include <snug/query/pair_queries.h>

#include <gtest/gtest.h>
#include <oracle/distance_twin.h>
#include <testing/counts.h>
#include <testing/patches.h>
#include <testing/placements.h>

#include <cstdlib>
#include <iostream>
#include <map>

#include "testing/verdict_only.h"

namespace snug::collide_test {
namespace {

struct Contestants {
  oracle::TwinMesh twin_a, twin_b;
  LimitSurface a, b;
  SurfaceBvh model_a, model_b;
  SurfaceWorkspace scratch_a, scratch_b;
  oracle::DistanceTwin distance_twin;
  oracle::SurfaceTwin surface_a, surface_b;

  Contestants(oracle::TwinMesh x, oracle::TwinMesh y)
      : twin_a(std::move(x)),
        twin_b(std::move(y)),
        a(testing::surface_of(twin_a)),
        b(testing::surface_of(twin_b)),
        model_a(a, {.threads = 1}),
        model_b(b, {.threads = 1, .min_lazy = 0, .part_level = 1}),
        scratch_a(model_a),
        scratch_b(model_b),
        distance_twin(twin_a, twin_b),
        surface_a(twin_a),
        surface_b(twin_b) {}
};

int placements() { return static_cast<int>(testing::number_of("SNUG_PLACEMENTS", 400)); }

TEST(collide, agrees_with_brute_force) {
  std::mt19937_64 random(29);
  namespace meshes = oracle::meshes;
  std::vector<std::unique_ptr<Contestants>> pairs;
  pairs.push_back(std::make_unique<Contestants>(meshes::disturbed(meshes::icosahedron(), 10, 0.15, random),
                                                meshes::bipyramid(7)));
  pairs.push_back(std::make_unique<Contestants>(meshes::disturbed(meshes::grid(4, 4), 4, 0.3, random),
                                                meshes::octahedron()));
  pairs.push_back(std::make_unique<Contestants>(
      meshes::disturbed(meshes::grid(3, 4, oracle::Boundary::edge_only), 4, 0.3, random),
      meshes::disturbed(meshes::bipyramid(12), 4, 0.1, random)));
  pairs.push_back(std::make_unique<Contestants>(
      meshes::disturbed(meshes::quartered(meshes::octahedron()), 6, 0.1, random),
      meshes::disturbed(meshes::bipyramid(4), 2, 0.2, random)));

  std::map<std::string, int> counts;
  const int total = placements();
  int tuned = 0;
  for (int trial = 0; trial < total; ++trial) {
    Contestants& pair = *pairs[static_cast<std::size_t>(trial) % pairs.size()];
    const double size = std::max(pair.a.size(), pair.b.size());
    const double tolerance =
        size * 0.05 * std::pow(0.02, static_cast<double>(random() >> 11) * 0x1p-53);  // 5 % to 0.1 %
    const Motion place_a = testing::random_placement(random, {0.1, 0.2, 0.3});
    Motion place_b = testing::random_placement(random, testing::random_vector(random, 0.9 * size));
    oracle::TwinDistance truth =
        pair.distance_twin.query(place_a.numbers(), place_b.numbers(), {1e-3 * size, 0});
    const bool tune = trial % 3 == 0 && truth.lower > 0;
    if (tune) {
      // Along the line of the nearest points the distance falls as the step grows, to first order and never
      // faster.
      const double target = tolerance * (0.5 + 1.5 * static_cast<double>(random() >> 11) * 0x1p-53);
      for (int step = 0; step < 3; ++step) {
        Vector3 d;
        for (std::size_t k = 0; k < 3; ++k) d[k] = truth.on_a[k] - truth.on_b[k];
        const double pull = (length(d) - target) / length(d);
        place_b = place_b.with_offset(place_b.offset() + pull * d);
        truth = pair.distance_twin.query(place_a.numbers(), place_b.numbers(), {0.02 * tolerance, 1e-3});
      }
    }
    tuned += truth.upper >= 0.5 * tolerance && truth.lower <= 2 * tolerance;
    const CollideOptions options = testing::verdict_only(tolerance);
    const Collision answer =
        collide({pair.model_a, pair.scratch_a, place_a}, {pair.model_b, pair.scratch_b, place_b}, options);
    ++counts[name_of(answer.verdict)];
    ASSERT_NE(answer.verdict, Verdict::undecided) << trial;
    ASSERT_LE(answer.distance.lower, truth.upper) << trial;
    if (answer.verdict == Verdict::separated) {
      ASSERT_GT(answer.distance.lower, 0);
      ASSERT_GT(truth.upper, 0) << "false separated " << trial;
      // Once more with a margin: asked for 1e-3 more than the truth, it must not be called separated.
      const CollideOptions beyond = testing::verdict_only(tolerance, truth.upper * 1.001);
      const Collision again =
          collide({pair.model_a, pair.scratch_a, place_a}, {pair.model_b, pair.scratch_b, place_b}, beyond);
      ASSERT_EQ(again.verdict, Verdict::within) << trial;
      ASSERT_GE(again.distance.upper, truth.lower) << trial;
    }
    if (truth.lower > tolerance) {
      ASSERT_EQ(answer.verdict, Verdict::separated) << trial;
    }
    if (std::isfinite(answer.distance.upper)) {
      ASSERT_GE(answer.distance.upper, truth.lower) << trial;
    }
    if (answer.verdict == Verdict::within) {
      const auto& w = *answer.witness;
      ASSERT_LE(distance(w[0], w[1]), tolerance) << trial;
      ASSERT_LE(answer.distance.upper, tolerance) << trial;
      const oracle::Point on_a{w[0].x, w[0].y, w[0].z}, on_b{w[1].x, w[1].y, w[1].z};
      ASSERT_TRUE(pair.surface_a.on_surface(place_a.numbers(), on_a, 1e-11 * size)) << trial;
      ASSERT_TRUE(pair.surface_b.on_surface(place_b.numbers(), on_b, 1e-11 * size)) << trial;
    }
  }
  std::cout << total << " placements, " << tuned << " between 0.5 and 2 tolerances:";
  for (const auto& [verdict, count] : counts) std::cout << ' ' << verdict << ' ' << count;
  std::cout << '\n';
  EXPECT_GE(3 * tuned, total * 7 / 10);
  EXPECT_GT(counts["separated"], total / 10);
  EXPECT_GT(counts["within"], total / 12);
}

}  // namespace
}  // namespace snug::collide_test
