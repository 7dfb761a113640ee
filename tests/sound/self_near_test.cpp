// self_contact() with a tolerance: sheets, spheres, folds, bodies and boundaries whose distances are known.

#include <snug/contacts.h>

#include <gtest/gtest.h>
#include <oracle/tagged_shapes.h>
#include <snug/query/self_near.h>
#include <snug/run.h>
#include <testing/tagged.h>

#include <cmath>
#include <limits>
#include <memory>
#include <numbers>
#include <random>
#include <string>
#include <vector>

namespace snug::self_near_test {
namespace {

namespace meshes = oracle::meshes;

enum class Faces { quads, triangles, fans };  // fans: four triangles around a point in each quad

std::string text_of(Faces faces) {
  return faces == Faces::quads ? "quads" : faces == Faces::triangles ? "triangles" : "fans";
}

// A strip over a profile in the x-z plane.
oracle::TaggedMesh strip(const std::vector<std::array<double, 2>>& profile, double width,
                         std::uint32_t across, Faces faces) {
  oracle::TaggedMesh mesh;
  for (const auto& [x, z] : profile) {
    for (std::uint32_t j = 0; j <= across; ++j) mesh.points.push_back({x, width * j / across, z});
  }
  const std::uint32_t row = across + 1;
  for (std::uint32_t i = 0; i + 1 < profile.size(); ++i) {
    for (std::uint32_t j = 0; j < across; ++j) {
      const std::array<std::uint32_t, 4> c{i * row + j, (i + 1) * row + j, (i + 1) * row + j + 1,
                                           i * row + j + 1};
      if (faces == Faces::quads) {
        mesh.polygons.push_back({c[0], c[1], c[2], c[3]});
      } else if (faces == Faces::triangles) {
        mesh.polygons.push_back({c[0], c[1], c[2]});
        mesh.polygons.push_back({c[0], c[2], c[3]});
      } else {
        oracle::Point middle{};
        for (const std::uint32_t v : c) {
          for (std::size_t k = 0; k < 3; ++k) middle[k] += 0.25 * mesh.points[v][k];
        }
        const auto m = static_cast<std::uint32_t>(mesh.points.size());
        mesh.points.push_back(middle);
        for (std::size_t k = 0; k < 4; ++k) mesh.polygons.push_back({c[k], c[(k + 1) % 4], m});
      }
    }
  }
  return mesh;
}

// Two legs at this gap, joined by half a circle.
oracle::TaggedMesh fold(double gap, Faces faces) {
  std::vector<std::array<double, 2>> profile;
  for (int i = 0; i <= 6; ++i) profile.push_back({2.1 - 0.35 * i, 0});
  for (int i = 1; i < 8; ++i) {
    const double t = std::numbers::pi * i / 8;
    profile.push_back({-0.5 * gap * std::sin(t), 0.5 * gap * (1 - std::cos(t))});
  }
  for (int i = 0; i <= 6; ++i) profile.push_back({0.35 * i, gap});
  return strip(profile, 0.6, 2, faces);
}

SelfContact ask(const oracle::TaggedMesh& mesh, Scheme scheme, const SelfContactOptions& options,
                const Run& run = {}) {
  return self_contact(Surface(testing::control_mesh(mesh), {.scheme = scheme}), options, run);
}

bool suits(Scheme scheme, Faces faces) {
  if (scheme == Scheme::loop) return faces != Faces::quads;
  return faces == (scheme == Scheme::doo_sabin ? Faces::fans : Faces::quads);
}

constexpr std::array all_schemes{Scheme::loop, Scheme::catmark, Scheme::doo_sabin, Scheme::midedge};

TEST(self_near, sheets_are_near_from_their_gap_on) {
  constexpr double gap = 0.3;
  int clear = 0, could = 0;
  for (const Faces faces : {Faces::quads, Faces::triangles, Faces::fans}) {
    const oracle::TaggedMesh mesh = fold(gap, faces);
    for (const Scheme scheme : all_schemes) {
      if (!suits(scheme, faces)) continue;
      // Places that are undecided anyway stay so.
      const SelfVerdict plain = ask(mesh, scheme, {}, {.max_splits = 5000}).verdict;
      ASSERT_NE(plain, SelfVerdict::intersecting);
      for (const double part : {0.9, 1.1}) {
        for (const double radius : {2.5, 4.0}) {
          if (radius < 4 && scheme != Scheme::loop) continue;
          const double tolerance = part * gap;
          const SelfContact found =
              ask(mesh, scheme, {.within = tolerance, .radius = radius * tolerance}, {.max_splits = 100'000});
          const std::string name = std::string(name_of(scheme)) + ", " + text_of(faces) + ", " +
                                   std::to_string(part) + ", " + std::to_string(radius);
          EXPECT_EQ(found.radius, radius * tolerance);
          if (part < 1) {
            EXPECT_TRUE(found.verdict == plain || found.verdict == SelfVerdict::undecided) << name;
            clear += found.verdict == SelfVerdict::clear ? 1 : 0;
            could += plain == SelfVerdict::clear ? 1 : 0;
            continue;
          }
          ASSERT_EQ(found.verdict, SelfVerdict::near) << name;
          for (const SelfContactPair& pair : found.pairs) {
            EXPECT_EQ(pair.verdict, SelfVerdict::near);
            const double d = distance(pair.points[0].point, pair.points[1].point);
            EXPECT_LE(d, tolerance * (1 + 1e-12)) << name;
            EXPECT_LE(pair.distance.lower, d * (1 + 1e-12)) << name;
            EXPECT_LE(pair.distance.upper, tolerance * (1 + 1e-12)) << name;
            // On the two legs: the way leads around the bend.
            EXPECT_GT(std::fabs(pair.points[0].point.z - pair.points[1].point.z), 0.5 * gap) << name;
            EXPECT_GT(pair.points[0].point.x + pair.points[1].point.x + 1.6 * gap, radius * tolerance)
                << name;
          }
        }
      }
    }
  }
  EXPECT_GT(could, 2);
  EXPECT_GE(clear, 0.8 * could) << could;
}

TEST(self_near, round_bodies_are_never_near_themselves) {
  for (const std::uint32_t n : {3u, 4u, 7u}) {
    for (const Scheme scheme : all_schemes) {
      oracle::TaggedMesh body = meshes::prism(n);
      if (scheme == Scheme::loop) body = meshes::triangulated(body);
      for (const double tolerance : {0.01, 0.3, 1e9}) {
        const SelfContact found =
            ask(body, scheme, {.within = tolerance, .radius = 2 * tolerance}, {.max_splits = 10'000});
        EXPECT_NE(found.verdict, SelfVerdict::near) << name_of(scheme) << " " << n << " " << tolerance;
        // With room for ways that are not quite the shortest ones.
        if (scheme == Scheme::catmark && n == 4) {
          EXPECT_EQ(ask(body, scheme, {.within = tolerance}).verdict, SelfVerdict::clear)
              << n << " " << tolerance;
        }
      }
    }
  }
}

TEST(self_near, a_body_beside_another_is_far_along_the_surface) {
  oracle::TaggedMesh both = meshes::cube();
  const oracle::TaggedMesh cube = meshes::cube();
  for (auto p : cube.points) {
    p[0] += 1.5;
    both.points.push_back(p);
  }
  for (auto face : cube.polygons) {
    for (auto& v : face) v += 8;
    both.polygons.push_back(face);
  }
  // The hulls are 0.5 apart, the middles of their faces less than 1.2.
  EXPECT_EQ(ask(both, Scheme::catmark, {.within = 1.2}).verdict, SelfVerdict::near);
  EXPECT_EQ(ask(both, Scheme::catmark, {.within = 1.2, .radius = 1e300}).verdict, SelfVerdict::near);
  EXPECT_NE(ask(both, Scheme::catmark, {.within = 0.49}, {.max_splits = 100'000}).verdict, SelfVerdict::near);
  EXPECT_EQ(ask(both, Scheme::catmark, {.within = 0.1}, {.max_splits = 100'000}).verdict, SelfVerdict::clear);
}

TEST(self_near, a_wedge_is_near_where_ways_around_its_edge_are_long) {
  for (const Faces faces : {Faces::quads, Faces::triangles, Faces::fans}) {
    for (const Scheme scheme : {Scheme::loop, Scheme::catmark}) {
      if (!suits(scheme, faces)) continue;
      for (const double degrees : {16.0, 31.0, 90.0}) {
        const double half = degrees / 2 * std::numbers::pi / 180;
        std::vector<std::array<double, 2>> profile;
        for (int i = -8; i <= 8; ++i) {
          profile.push_back({0.25 * std::abs(i) * std::cos(half), 0.25 * i * std::sin(half)});
        }
        oracle::TaggedMesh mesh = strip(profile, 0.5, 2, faces);
        for (std::uint32_t j = 0; j < 2; ++j) mesh.creases.push_back({8 * 3 + j, 8 * 3 + j + 1, 10});
        const SelfVerdict plain = ask(mesh, scheme, {}, {.max_splits = 5000}).verdict;
        const SelfContact found = ask(mesh, scheme, {.within = 0.2}, {.max_splits = 30'000});
        const std::string name =
            std::string(name_of(scheme)) + ", " + text_of(faces) + ", " + std::to_string(degrees);
        // Chords are sin(half) times the way: R / T = 4.
        if (std::sin(half) > 0.25) {
          EXPECT_NE(found.verdict, SelfVerdict::near) << name;
        }
        if (std::sin(half) > 0.26) {
          EXPECT_TRUE(found.verdict == plain || found.verdict == SelfVerdict::undecided) << name;
        }
        if (std::sin(half) < 0.25) {
          EXPECT_NE(found.verdict, SelfVerdict::clear) << name;
        }
        if (std::sin(half) < 0.19) {
          EXPECT_EQ(found.verdict, SelfVerdict::near) << name;
        }
      }
    }
  }
}

// Nearness alone, whatever else is undecided of such wedges.
TEST(self_near, of_wedges_hangs_on_the_stretch_of_their_edge) {
  for (const double degrees : {24.0, 26.0, 60.0, 90.0}) {
    const double half = degrees / 2 * std::numbers::pi / 180;
    std::vector<std::array<double, 2>> profile;
    for (int i = -4; i <= 4; ++i) {
      profile.push_back({0.25 * std::abs(i) * std::cos(half), 0.25 * i * std::sin(half)});
    }
    oracle::TaggedMesh mesh = strip(profile, 0.5, 2, Faces::quads);
    for (std::uint32_t j = 0; j < 2; ++j) mesh.creases.push_back({4 * 3 + j, 4 * 3 + j + 1, 10});
    const LimitSurface surface(testing::control_mesh(mesh), {Scheme::catmark},
                               std::make_shared<BoundsCache>());
    const double tolerance = surface.scale().apply(0.06);
    const Nearness found =
        find_nearness(SurfaceBvh(surface), LevelComplex(surface),
                      {.tolerance = tolerance, .radius = 4 * tolerance, .budget = 100'000, .levels = 12}, {});
    EXPECT_EQ(found.near.empty() && found.unresolved.empty(), std::sin(half) > 0.25) << degrees;
  }
}

TEST(self_near, thin_discs_are_near_themselves_inside) {
  for (const double height : {0.05, 0.1, 0.2, 0.3}) {
    for (std::uint32_t n = 4; n <= 8; ++n) {
      oracle::TaggedMesh disc;
      disc.points = {{0, 0, height}, {0, 0, -height}};
      for (std::uint32_t i = 0; i < n; ++i) {
        const double t = 2 * std::numbers::pi * i / n;
        disc.points.push_back({std::cos(t), std::sin(t), 0});
        disc.polygons.push_back({0, 2 + i, 2 + (i + 1) % n});
        disc.polygons.push_back({1, 2 + (i + 1) % n, 2 + i});
      }
      // Thinner than the tolerance, and the way around the rim is at least as long as the disc is wide.
      const double tolerance = 1.05 * height;
      const SelfContact found =
          ask(disc, Scheme::loop, {.within = tolerance, .radius = 2 * tolerance}, {.max_splits = 50'000});
      if (height <= 0.1) {
        EXPECT_EQ(found.verdict, SelfVerdict::near) << n << " " << height;
      } else {
        EXPECT_NE(found.verdict, SelfVerdict::intersecting) << n << " " << height;
      }
    }
  }
}

TEST(self_near, flat_sheets_with_boundaries_are_clear) {
  const oracle::TaggedMesh sheet = meshes::quad_grid(4, 3);
  for (const Scheme scheme : {Scheme::catmark, Scheme::doo_sabin, Scheme::midedge, Scheme::loop}) {
    const oracle::TaggedMesh mesh = scheme == Scheme::loop ? meshes::triangulated(sheet) : sheet;
    for (const double tolerance : {1e-6, 0.3, 20.0}) {
      const SelfContact found = ask(mesh, scheme, {.within = tolerance}, {.max_splits = 50'000});
      EXPECT_NE(found.verdict, SelfVerdict::near) << name_of(scheme) << " " << tolerance;
      if (scheme == Scheme::catmark && tolerance > 0.1) {
        EXPECT_EQ(found.verdict, SelfVerdict::clear) << tolerance;
      }
    }
  }
}

TEST(self_near, what_meets_itself_does_so_with_a_tolerance_too) {
  oracle::TaggedMesh both = meshes::cube();
  for (auto p : meshes::cube().points) {
    p[0] += 0.3;
    both.points.push_back(p);
  }
  for (auto face : meshes::cube().polygons) {
    for (auto& v : face) v += 8;
    both.polygons.push_back(face);
  }
  EXPECT_EQ(ask(both, Scheme::catmark, {.within = 0.1}).verdict, SelfVerdict::intersecting);
}

TEST(self_near, does_not_depend_on_threads_scale_or_place) {
  for (const double tolerance : {0.2, 0.4}) {
    const oracle::TaggedMesh mesh = fold(0.3, Faces::triangles);
    const SelfContact one =
        ask(mesh, Scheme::loop, {.within = tolerance}, {.threads = 1, .max_splits = 30'000});
    const SelfContact four =
        ask(mesh, Scheme::loop, {.within = tolerance}, {.threads = 4, .max_splits = 30'000});
    EXPECT_EQ(one.verdict, four.verdict);
    EXPECT_EQ(one.stars, four.stars);
    EXPECT_EQ(one.pair_tests, four.pair_tests);
    ASSERT_EQ(one.pairs.size(), four.pairs.size());
    for (std::size_t i = 0; i < one.pairs.size(); ++i) EXPECT_EQ(one.pairs[i].points, four.pairs[i].points);
    for (const double scale : {0x1p-600, 0x1p600}) {
      oracle::TaggedMesh scaled = mesh;
      for (auto& p : scaled.points) {
        for (double& x : p) x *= scale;
      }
      const SelfContact other =
          ask(scaled, Scheme::loop, {.within = tolerance * scale}, {.max_splits = 30'000});
      EXPECT_EQ(other.verdict, one.verdict);
      EXPECT_EQ(other.pair_tests, one.pair_tests);
    }
  }
}

TEST(self_near, refuses_lengths_that_are_none) {
  const oracle::TaggedMesh mesh = meshes::cube();
  constexpr double infinite = std::numeric_limits<double>::infinity(),
                   none = std::numeric_limits<double>::quiet_NaN();
  const std::vector<double> lengths{none, infinite, -infinite, -1, -0.0, 0, 1e-320, 0.1, 1, 1e300, 1.7e308};
  std::vector<std::optional<double>> all{std::nullopt};
  all.insert(all.end(), lengths.begin(), lengths.end());
  for (const auto& tolerance : all) {
    for (const auto& radius : all) {
      const bool sound =
          (!tolerance && !radius) || (tolerance && *tolerance > 0 && std::isfinite(*tolerance) &&
                                      (!radius || (std::isfinite(*radius) && *radius / 2 >= *tolerance)));
      try {
        const SelfContact found =
            ask(mesh, Scheme::catmark, {.within = tolerance, .radius = radius}, {.max_splits = 2000});
        EXPECT_TRUE(sound) << tolerance.value_or(-7) << " " << radius.value_or(-7);
        EXPECT_NE(found.verdict, SelfVerdict::near);
        EXPECT_NE(found.verdict, SelfVerdict::intersecting);
      } catch (const InputError& error) {
        EXPECT_FALSE(sound) << tolerance.value_or(-7) << " " << radius.value_or(-7);
        EXPECT_EQ(error.problem(), InputProblem::value);
        EXPECT_NE(std::string(error.what()).find("self contact:"), std::string::npos) << error.what();
      }
    }
  }
  EXPECT_NE(ask(fold(0.3, Faces::quads), Scheme::catmark, {.within = 0.4}, {.max_splits = 0}).verdict,
            SelfVerdict::clear);
}

}  // namespace
}  // namespace snug::self_near_test
