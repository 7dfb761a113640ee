// The promise of hulls against the twins: whatever is verified sandwiches the surface.
//
//   SNUG_PLACEMENTS=2000 build/release/bin/tests/sound_test --gtest_filter='hulls.*'

#include <snug/hull.h>

#include <gtest/gtest.h>
#include <testing/counts.h>
#include <testing/hulls.h>
#include <testing/scheme_surfaces.h>
#include <testing/solid_cases.h>
#include <testing/surfaces.h>

#include <cmath>
#include <iostream>
#include <map>
#include <numbers>

namespace snug::hull_test {
namespace {

using oracle::TaggedMesh;
using testing::both;
using testing::HullCounts;

// Results for the surfaces.
struct Outcomes {
  HullCounts counts;
  std::size_t verified = 0;
  std::map<std::string, std::size_t> others;

  void print(const char* name) const {
    std::cout << name << ": " << verified << " verified, " << counts.hulls << " hulls, " << counts.triangles
              << " triangles, " << counts.points << " points, " << counts.chords << " chords, "
              << counts.sides << " sides";
    for (const auto& [why, count] : others) std::cout << "; " << why << ' ' << count;
    std::cout << '\n';
  }
};

void check(const TaggedMesh& mesh, const oracle::WindingScheme& scheme, const SchemeOptions& options,
           HullOptions how, const std::string& name, Outcomes& outcomes) {
  Hulls found;
  try {
    const Surface surface = testing::public_surface(testing::control_mesh(mesh), options);
    how.error = *how.error * surface.size();
    found = hull(surface, how, {.max_splits = 15'000});
  } catch (const InputError& error) {
    EXPECT_TRUE(error.problem() == InputProblem::refused || error.problem() == InputProblem::value)
        << name << ": " << error.what();
    ++outcomes.others["refused"];
    return;
  }
  EXPECT_EQ(found.outcome == Outcome::complete, found.problems.empty()) << name;
  if (found.outcome != Outcome::complete) {
    ++outcomes.others[name_of(found.problems[0].fault)];
    return;
  }
  ++outcomes.verified;
  testing::expect_sandwich(mesh, scheme, found, *how.error, 3, name, outcomes.counts);
}

// Of every scheme, smooth, creased and with corners; one or several components, some inside out.
TEST(hulls, of_random_solids_sandwich_them) {
  Outcomes outcomes;
  const std::uint64_t solids = testing::number_of("SNUG_PLACEMENTS", 10);
  for (std::uint64_t number = 0; number < solids && !HasFailure(); ++number) {
    testing::SolidCase c = testing::solid_case(number);
    std::mt19937_64 random(number);
    if (random() % 4 == 0) {
      for (auto& polygon : c.mesh.polygons) std::reverse(polygon.begin(), polygon.end());
    }
    HullOptions how{.error = std::array{0.08, 0.03, 0.01}[random() % 3]};
    how.single_precision = random() % 4 == 0;
    check(c.mesh, c.scheme, c.options, how, c.name, outcomes);
  }
  outcomes.print("solids");
  EXPECT_GT(outcomes.verified, solids / 3);
}

// Every tag, boundary rule and sort of non-manifold place, mostly open.
TEST(hulls, of_surfaces_with_every_tag_sandwich_them) {
  for (const auto scheme : {oracle::PrimalScheme::catmull_clark, oracle::PrimalScheme::loop}) {
    Outcomes outcomes;
    std::size_t number = 0;
    for (const testing::TaggedCase& c : testing::tagged_cases(scheme, 77)) {
      if (HasFailure()) return;
      // Of each shape's six cases, plain or tagged with each boundary rule, one by turns; or every second one.
      const std::size_t i = number++, shape = i / 6;
      if (testing::long_check() ? (i + shape) % 2 != 0 : i % 6 != 5 * shape % 6) continue;
      check(c.mesh, c.rules, testing::options_of(c.rules), {.error = number % 2 == 1 ? 0.04 : 0.015},
            c.name + ", " + testing::text_of(c.rules), outcomes);
    }
    outcomes.print(scheme == oracle::PrimalScheme::loop ? "loop" : "catmark");
    EXPECT_GT(outcomes.verified, 8u);
  }
}

// Two poles of many faces, a wavy rim between them.
TaggedMesh bipyramid(std::uint32_t n) {
  TaggedMesh mesh;
  for (std::uint32_t i = 0; i < n; ++i) {
    const double a = 2 * std::numbers::pi * i / n;
    mesh.points.push_back({std::cos(a), std::sin(a), 0});
    const std::uint32_t j = (i + 1) % n;
    mesh.polygons.push_back({i, j, n});
    mesh.polygons.push_back({j, i, n + 1});
  }
  mesh.points.push_back({0, 0, 1});
  mesh.points.push_back({0, 0, -1});
  return mesh;
}

// A fan of triangles around one vertex, its rim raised and lowered.
TaggedMesh fan(std::uint32_t n) {
  TaggedMesh mesh;
  for (std::uint32_t i = 0; i < n; ++i) {
    const double a = 2 * std::numbers::pi * i / n;
    mesh.points.push_back({std::cos(a), std::sin(a), 0.1 * std::cos(2 * a)});
    mesh.polygons.push_back({i, (i + 1) % n, n});
  }
  mesh.points.push_back({0, 0, 0.3});
  return mesh;
}

// From moderate to the largest valences, closed and at boundaries. Around such a vertex triangles are narrow, and their normals may
// be anything: vertices that went the shortest way past their planes passed each other, and up to a hundred times as many were needed.
TEST(hulls, of_poles_of_any_valence_sandwich_them) {
  Outcomes outcomes;
  for (const std::uint32_t n : {12u, 36u, 90u, 360u}) {
    const auto hulls_of = [&](const TaggedMesh& mesh, const oracle::Rules& rules, std::size_t most,
                              const char* name) {
      const Surface surface =
          testing::public_surface(testing::control_mesh(mesh), testing::options_of(rules));
      const double error = 0.05 * surface.size();
      const Hulls found = hull(surface, {.error = error}, {.max_splits = 100'000});
      ASSERT_EQ(found.outcome, Outcome::complete) << name << n;
      EXPECT_LE(std::max(found.inner->triangles.size(), found.outer->triangles.size()), most * n)
          << name << n;
      testing::expect_sandwich(mesh, rules, found, error, n > 36 ? 2 : 3, name + std::to_string(n),
                               outcomes.counts);
      ++outcomes.verified;
    };
    const oracle::Rules loop{.scheme = oracle::PrimalScheme::loop};
    hulls_of(fan(n), loop, 40, "fan ");
    if (n <= 36) hulls_of(bipyramid(n), loop, 80, "bipyramid ");
    if (n <= 90) hulls_of(oracle::meshes::pole(n, false), {}, 120, "pole ");
    if (n == 12) hulls_of(oracle::meshes::pole(n, true), {}, 80, "open pole ");
  }
  outcomes.print("poles");
}

// Each of the narrow faces has a ripple: facets that follow these turn over, and four times as many are needed, unless their vertices
// go the way that the surface faces on the whole.
TEST(hulls, of_poles_with_ripples_take_few_triangles) {
  const TaggedMesh mesh = bipyramid(90);
  const oracle::Rules rules{.scheme = oracle::PrimalScheme::loop};
  const Surface surface = testing::public_surface(testing::control_mesh(mesh), testing::options_of(rules));
  const double error = 0.01 * surface.size();
  const Hulls found = hull(surface, {.error = error, .outer = false});
  ASSERT_EQ(found.outcome, Outcome::complete);
  EXPECT_LE(found.inner->triangles.size(), 20'000u);
  HullCounts counts;
  testing::expect_sandwich(mesh, rules, found, error, 2, "ripples", counts);
}

// Faces much narrower than the tolerance: facets that are moved as far turn over, and the proof that they are off the
// surface splits more pieces than a query usually may.
TEST(hulls, of_poles_of_many_narrow_faces_sandwich_them) {
  const TaggedMesh mesh = bipyramid(testing::long_check() ? 256 : 160);
  const oracle::Rules rules{.scheme = oracle::PrimalScheme::loop};
  const Surface surface = testing::public_surface(testing::control_mesh(mesh), testing::options_of(rules));
  const Hulls found = hull(surface, {.error = 0.02, .inner = false});
  ASSERT_EQ(found.outcome, Outcome::complete);
  EXPECT_LE(found.outer->triangles.size(), 200'000u);
  HullCounts counts;
  testing::expect_sandwich(mesh, rules, found, 0.02, testing::long_check() ? 3 : 2, "poles", counts);
}

// Two parts of each pair of kinds, from far apart to through each other: usually at one of the distances, each kind at all.
// Beside or above each other alike: a pair is drawn in one order.
TEST(hulls, of_parts_beside_each_other_sandwich_them) {
  namespace meshes = oracle::meshes;
  TaggedMesh sharp = meshes::cube(), semi = meshes::prism(5), plate = meshes::cube(),
             bumpy = meshes::quad_grid(3, 3), needle = meshes::pyramid(5), hollow = meshes::cube();
  for (std::size_t k = 0; k < 4; ++k) {
    for (const auto& polygon : sharp.polygons)
      sharp.creases.push_back({polygon[k], polygon[(k + 1) % 4], 10});
  }
  for (std::size_t k = 0; k < 5; ++k) {
    const auto& polygon = semi.polygons[0];
    semi.creases.push_back({polygon[k], polygon[(k + 1) % 5], 1.7});
  }
  semi.corners.push_back({0, 10});
  for (oracle::Point& p : plate.points) p[2] *= 0.03;
  bumpy.points[5][2] = 1;
  needle.points[0][2] += 4;
  hollow = both(hollow, hollow);
  for (std::size_t v = 8; v < 16; ++v) {
    for (double& x : hollow.points[v]) x = 0.5 + 0.5 * (x - 0.5);
  }
  for (std::size_t f = 6; f < 12; ++f) std::reverse(hollow.polygons[f].begin(), hollow.polygons[f].end());
  const std::vector<std::pair<std::string, TaggedMesh>> kinds{{"smooth", meshes::cube()},
                                                              {"sharp", sharp},
                                                              {"semi-sharp", semi},
                                                              {"plate", plate},
                                                              {"open", bumpy},
                                                              {"needle", needle},
                                                              {"hollow", hollow},
                                                              {"flat", meshes::quad_grid(2, 2)}};
  const std::array distances{1.0, 0.03, 0.002, 0.0, -0.2};
  const std::uint64_t pairs = kinds.size() * (kinds.size() + 1) / 2,
                      of_each = std::clamp<std::uint64_t>(
                          testing::number_of("SNUG_PLACEMENTS", pairs) / pairs, 1, distances.size());
  Outcomes outcomes;
  std::mt19937_64 random(5);
  std::size_t next = 0;
  for (std::size_t first = 0; first < kinds.size(); ++first) {
    for (std::size_t second = first; second < kinds.size(); ++second) {
      const auto& [name_a, a] = kinds[first];
      const auto& [name_b, b] = kinds[second];
      for (std::uint64_t i = 0; i < of_each; ++i) {
        const double apart = distances[next++ % distances.size()];
        double high = -INFINITY, low = INFINITY;
        const std::size_t axis = random() % 3;
        for (const oracle::Point& p : a.points) high = std::max(high, p[axis]);
        for (const oracle::Point& p : b.points) low = std::min(low, p[axis]);
        oracle::Point by{0.1 * testing::unit(random), 0.1 * testing::unit(random),
                         0.1 * testing::unit(random)};
        by[axis] = high - low + apart;
        check(both(a, testing::moved(b, 1, by)), oracle::Rules{}, testing::options_of(oracle::Rules{}),
              {.error = 0.02}, name_a + " beside " + name_b + " at " + std::to_string(apart), outcomes);
        if (HasFailure()) return;
      }
    }
  }
  outcomes.print("pairs");
  EXPECT_GT(outcomes.verified, next / 4);
}

}  // namespace
}  // namespace snug::hull_test
