// More meshes, for those who have them: SNUG_EXTRA_MODELS names a folder. Every OBJ and OFF file in it that
// is accepted is bounded and compared with the twin.

#include <snug/bound.h>
#include <snug/distance.h>

#include <gtest/gtest.h>
#include <oracle/loop_twin.h>
#include <snug/search/surface_data.h>
#include <support/error.h>
#include <testing/containment.h>
#include <testing/counts.h>
#include <testing/surfaces.h>

#include <cstdlib>
#include <filesystem>
#include <iostream>

#include <testing/places.h>
#include "testing/verdict_only.h"

namespace snug::extra_models_test {
namespace {

// What the twin samples in a few seconds.
std::size_t max_faces() { return testing::long_check() ? 8000 : 3000; }

// Checks samples of every face against the union of its pieces; returns how many there were.
std::size_t check(const Surface& surface, const BoundOptions& options,
                  const std::vector<oracle::LimitSample>& samples, const std::string& name) {
  std::vector<std::vector<PatchEnclosure>> pieces(surface.owner_count());
  bound(surface, options, [&](const PatchEnclosure& piece) { pieces[piece.patch.owner].push_back(piece); });
  for (const oracle::LimitSample& s : samples) {
    const testing::Extended p{s.position[0], s.position[1], s.position[2]};
    const long double slack = 2.0L * s.error;
    bool in_offset = false, in_interval = false;
    for (const PatchEnclosure& piece : pieces[s.face]) {
      in_offset = in_offset || testing::within_radius(p, piece.offset.base, piece.offset.radius + slack);
      in_interval = in_interval || testing::in_interval_triangle(p, piece.interval, slack);
      if (in_offset && in_interval) break;
    }
    EXPECT_TRUE(in_offset && in_interval) << name << ", face " << s.face << " at " << s.u << ", " << s.v;
    if (::testing::Test::HasFailure()) return 0;
  }
  return samples.size();
}

TEST(extra_models, limit_points_lie_inside_their_enclosures) {
  const char* folder = std::getenv("SNUG_EXTRA_MODELS");
  if (!folder) GTEST_SKIP() << "SNUG_EXTRA_MODELS names no folder";
  std::size_t accepted = 0, refused = 0, points = 0;
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    const std::string path = entry.path().string();
    if (!path.ends_with(".obj") && !path.ends_with(".off")) continue;
    try {
      const ControlMesh mesh = read_mesh(path);
      if (mesh.face_count() > max_faces()) continue;
      SchemeOptions rules{natural_scheme(mesh), mesh.tags.boundary.value_or(BoundaryRule::edge_and_corner)};
      const Surface surface = testing::public_surface(mesh, rules);
      // The twin knows plain Loop surfaces.
      const bool tagged =
          !mesh.tags.creases.empty() || !mesh.tags.corners.empty() || !mesh.tags.holes.empty();
      if (rules.scheme != Scheme::loop || tagged || !surface.data()->limit().topology().is_manifold())
        continue;
      const auto samples =
          oracle::sample_uniform(testing::twin_mesh(mesh, rules.boundary), mesh.face_count() > 1500 ? 1
                                                                           : testing::long_check()  ? 3
                                                                                                    : 2);
      BoundOptions options;
      points += check(surface, options, samples, path);
      options.error = 0.01 * surface.size();
      points += check(surface, options, samples, path);
      points +=
          check(testing::public_surface(mesh, rules, {.bounds = BoundMethod::table}), options, samples, path);
      ++accepted;
    } catch (const InputError&) {
      ++refused;
    }
    if (HasFailure()) return;
  }
  std::cout << accepted << " meshes accepted, " << refused << " refused, " << points << " checks\n";
  EXPECT_GT(accepted, 0u);
}

// Leaves that a well-known mesh of 1418 triangles needs, where it is there: tightness must not get lost.
TEST(extra_models, venus_needs_few_leaves) {
  const char* folder = std::getenv("SNUG_EXTRA_MODELS");
  const std::string path = std::string(folder ? folder : "") + "/venus.off";
  if (!folder || !std::filesystem::exists(path)) GTEST_SKIP() << "no venus.off in SNUG_EXTRA_MODELS";
  const Surface surface = load(path);
  for (const auto& [tolerance, most] : {std::pair{0.02, 1450u}, {0.01, 1700u}, {0.005, 3100u}}) {
    BoundOptions options;
    options.error = tolerance * surface.size();
    EXPECT_LE(bound(surface, options, [](const PatchEnclosure&) {}).count, most) << tolerance;
  }
}

// Counter-examples to proofs that were wrong once, with what is true of them.
TEST(extra_models, counter_examples_are_answered_right) {
  const char* folder = std::getenv("SNUG_EXTRA_MODELS");
  const std::string path = std::string(folder ? folder : "") + "/solid/";
  if (!folder || !std::filesystem::exists(path)) GTEST_SKIP() << "no folder solid in SNUG_EXTRA_MODELS";
  const auto ask = [&](const std::string& a, const std::string& b, Scheme scheme, BoundMethod method) {
    const SurfaceOptions how{.scheme = scheme, .bounds = method};
    const Surface surface_a = load(a, how), surface_b = load(b, how);
    CollideOptions options = testing::verdict_only();
    options.solid = method == BoundMethod::rows;
    const Collision found = collide(surface_a, surface_b, options);
    const Distance gap = distance(surface_a, surface_b);
    EXPECT_TRUE(method == BoundMethod::rows || gap.distance.upper > 0);
    return found.verdict;
  };
  EXPECT_EQ(ask(path + "prism.obj", path + "inside.obj", Scheme::catmark, BoundMethod::rows),
            Verdict::intersecting);
  EXPECT_EQ(ask(path + "prism.obj", path + "outside.obj", Scheme::catmark, BoundMethod::rows),
            Verdict::separated);
  EXPECT_EQ(ask(testing::models_dir() + "/bracket.obj", path + "inside_bracket.obj", Scheme::midedge,
                BoundMethod::rows),
            Verdict::intersecting);
  EXPECT_NE(ask(path + "needle_a.obj", path + "needle_b.obj", Scheme::loop, BoundMethod::table),
            Verdict::intersecting);
}

}  // namespace
}  // namespace snug::extra_models_test
