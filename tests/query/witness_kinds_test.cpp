// The verdict does not depend on the kind of witness: it is the same for exact, approximate and no witnesses. Approximate ones are as near their limit points as they say.

#include <gtest/gtest.h>
#include <snug/collide.h>
#include <snug/evaluate.h>
#include <testing/counts.h>
#include <testing/placements.h>
#include <testing/scheme_surfaces.h>
#include <testing/surfaces.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <map>

namespace snug::witness_kinds_test {
namespace {

using testing::NamedSurface;

// The limit point at the place that a witness is said to have, by the general evaluation.
void expect_near_limit(const Surface& surface, const Motion& pose, const LimitPoint& witness,
                       const std::string& where) {
  const std::optional<Place>& at = witness.at;
  ASSERT_TRUE(at && surface.has(*at)) << where;
  const SurfacePoint point = evaluate(surface, *at);
  const Point3 placed = pose.apply(point.point);
  // Parameters are rounded to 2^-51; around many faces points move by more than parameters do.
  const double rounding = 1e-11 * (surface.size() + max_abs(pose.offset()));
  for (std::size_t k = 0; k < 3; ++k) {
    ASSERT_NEAR(placed[k], witness.point[k], witness.error + 2 * point.error + rounding)
        << where << " face " << at->owner << " corner " << at->corner << " u " << at->u << " v " << at->v;
  }
}

struct Counts {
  std::map<Verdict, std::size_t> verdicts;
  std::size_t witnesses = 0, close = 0, inner = 0;
};

// One question with a workspace of its own, so that nothing is left of the one before.
Collision ask(const Surface& a, const Surface& b, const std::array<Motion, 2>& poses, CollideOptions options,
              Run run, WitnessKind kind) {
  Workspace empty;
  run.workspace = &empty;
  options.witness = kind;
  return collide(a.at(poses[0]), b.at(poses[1]), options, run);
}

void expect_one_verdict(const Surface& a, const Surface& b, const std::array<Motion, 2>& poses,
                        const CollideOptions& options, const Run& run, const std::string& where,
                        Counts& counts) {
  const Collision exact = ask(a, b, poses, options, run, WitnessKind::exact),
                  near = ask(a, b, poses, options, run, WitnessKind::approximate),
                  none = ask(a, b, poses, options, run, WitnessKind::none);
  ++counts.verdicts[exact.verdict];
  counts.inner += exact.contained.has_value();
  for (const Collision* const other : {&near, &none}) {
    EXPECT_EQ(other->verdict, exact.verdict) << where;
    EXPECT_EQ(other->contained, exact.contained) << where;
    EXPECT_EQ(other->outcome, exact.outcome) << where;
    // Whether there is more to measure depends on the upper end, which depends on the witness.
    if (!options.measure) {
      EXPECT_LE(other->distance.lower, exact.distance.lower) << where;
      if (other == &near) {
        EXPECT_EQ(other->distance.lower, exact.distance.lower) << where;
      }
    }
    EXPECT_EQ(other->stats.splits, exact.stats.splits) << where;
    EXPECT_EQ(other->stats.box_tests, exact.stats.box_tests) << where;
    EXPECT_EQ(other->stats.triangle_tests, exact.stats.triangle_tests) << where;
    // Bounds of one distance.
    EXPECT_LE(other->distance.lower, exact.distance.upper) << where;
    EXPECT_LE(exact.distance.lower, other->distance.upper) << where;
    EXPECT_EQ(std::isfinite(other->distance.upper), std::isfinite(exact.distance.upper)) << where;
    if (exact.verdict == Verdict::within) {
      EXPECT_LE(other->distance.upper, (options.margin + *options.tolerance) * (1 + 1e-12)) << where;
    }
  }
  EXPECT_EQ(near.distance.upper, none.distance.upper) << where;
  EXPECT_LE(none.stats.evaluations, near.stats.evaluations) << where;
  EXPECT_LE(near.stats.evaluations, exact.stats.evaluations) << where;
  EXPECT_FALSE(none.witness) << where;
  EXPECT_EQ(near.witness.has_value(), exact.witness.has_value()) << where;
  if (!near.witness || !exact.witness || near.contained) return;
  ++counts.witnesses;
  counts.close += std::max((*near.witness)[0].error, (*near.witness)[1].error) < 1e-3 * a.size();
  for (std::size_t s = 0; s < 2; ++s) {
    const Surface& surface = s == 0 ? a : b;
    expect_near_limit(surface, poses[s], (*near.witness)[s], where + ", near");
    expect_near_limit(surface, poses[s], (*exact.witness)[s], where);
  }
  // The limit points that they stand for are no farther apart than the upper bound.
  if (near.verdict != Verdict::intersecting) {
    const Point3 p = poses[0].apply(evaluate(a, *(*near.witness)[0].at).point),
                 q = poses[1].apply(evaluate(b, *(*near.witness)[1].at).point);
    EXPECT_LE(distance(p, q), near.distance.upper + 1e-10 * (a.size() + b.size())) << where;
  }
}

TEST(witness_kinds, leave_the_verdict_as_it_is) {
  std::mt19937_64 random(91);
  Counts counts;
  testing::for_each_surface(91, [&](const NamedSurface& s) {
    std::size_t patches = 0;
    for (std::size_t p = 0; p < s.surface.patch_count(); ++p) patches += s.surface.has_patch(PatchId(p));
    if (patches == 0) return;
    const BoundMethod method = random() % 4 == 0 ? BoundMethod::table : BoundMethod::rows;
    const Surface a = testing::public_surface(s.surface.mesh(), s.surface.options(), {.bounds = method}),
                  b = testing::public_surface(s.surface.mesh(), s.surface.options(), {.tight = true});
    for (int trial = 0; trial < 5; ++trial) {
      const double size = s.surface.size(), far = size * std::array{0.05, 0.4, 1.0}[random() % 3];
      std::array<Motion, 2> poses;
      for (Motion& pose : poses) {
        pose = testing::random_placement(random, testing::random_vector(random, far));
      }
      CollideOptions options;
      options.tolerance = size * std::array{0.0, 1e-9, 1e-3, 0.05}[random() % 4];
      options.margin = size * (random() % 2 == 0 ? 0 : 0.1 * testing::unit(random));
      const snug::Run run{.max_splits = std::array{3u, 30u, 3000u}[random() % 3]};
      options.prove_contact = random() % 2 == 0;
      options.measure = random() % 2 == 0;
      expect_one_verdict(a, b, poses, options, run, s.name + ", trial " + std::to_string(trial), counts);
    }
  });
  std::printf("  %zu separated, %zu within, %zu intersecting, %zu undecided; %zu witnesses, %zu close\n",
              counts.verdicts[Verdict::separated], counts.verdicts[Verdict::within],
              counts.verdicts[Verdict::intersecting], counts.verdicts[Verdict::undecided], counts.witnesses,
              counts.close);
  for (const auto verdict :
       {Verdict::separated, Verdict::within, Verdict::intersecting, Verdict::undecided}) {
    EXPECT_GT(counts.verdicts[verdict], testing::share(30)) << name_of(verdict);
  }
  EXPECT_GT(counts.witnesses, testing::share(300));
  EXPECT_GT(counts.close, counts.witnesses / 8);
}

// Solids, one in the other or not: a common point of both is a witness, too.
TEST(witness_kinds, leave_the_verdict_about_solids_as_it_is) {
  std::mt19937_64 random(92);
  Counts counts;
  for (const Scheme scheme : {Scheme::loop, Scheme::catmark, Scheme::flat}) {
    const oracle::TaggedMesh shape = oracle::meshes::triangulated(oracle::meshes::cube());
    ControlMesh small = testing::control_mesh(shape);
    for (Point3& p : small.points) p = {0.2 * p.x, 0.2 * p.y, 0.2 * p.z};
    const Surface a(testing::control_mesh(shape), {.scheme = scheme}), b(small, {.scheme = scheme});
    for (int trial = 0; trial < 200; ++trial) {
      std::array<Motion, 2> poses;
      for (Motion& pose : poses)
        pose = testing::random_placement(random, testing::random_vector(random, 0.8));
      CollideOptions options{.tolerance = 1e-6, .margin = 0};
      options.solid = true;
      options.measure = trial % 2 == 0;
      options.prove_contact = trial % 4 < 2;
      expect_one_verdict(a, b, poses, options, {}, std::string(name_of(scheme)) + " " + std::to_string(trial),
                         counts);
    }
  }
  EXPECT_GT(counts.inner, 10u);
  EXPECT_GT(counts.verdicts[Verdict::separated], 50u);
  EXPECT_GT(counts.verdicts[Verdict::intersecting], 50u);
}

}  // namespace
}  // namespace snug::witness_kinds_test
