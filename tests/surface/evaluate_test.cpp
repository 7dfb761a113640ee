#include <snug/surface/evaluate.h>

#include <gtest/gtest.h>
#include <oracle/loop_twin.h>
#include <testing/instruction_sets.h>
#include <testing/patches.h>
#include <testing/scheme_surfaces.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <random>
#include <tuple>
#include <vector>

namespace snug::evaluate_test {
namespace {

TEST(evaluate, holds_its_error_at_every_scale) {
  for (const double size : {1e-300, 0x1p-400, 1e-20, 1.0, 0x1p300, 7e250}) {
    oracle::TwinMesh twin = oracle::meshes::bipyramid(7);
    for (oracle::Point& p : twin.points) p = {size * (p[0] + 3), size * p[1], size * p[2]};
    const LimitSurface surface = testing::surface_of(twin);
    for (const oracle::LimitSample& s : oracle::sample_uniform(twin, 2)) {
      const SurfacePoint point = evaluate(surface, {s.face, 0, s.u, s.v});
      const SurfacePoint alone = PatchEvaluator(surface, PatchId(s.face))(TriangleParameter{s.u, s.v});
      for (std::size_t k = 0; k < 3; ++k) {
        EXPECT_LE(std::fabs(point.point[k] - s.position[k]), point.error + s.error);
        EXPECT_LE(std::fabs(alone.point[k] - s.position[k]), alone.error + s.error);
      }
      EXPECT_LT(point.error, 1e-13 * size + 1e-307);
      ASSERT_TRUE(point.normal);
      EXPECT_NEAR(length(*point.normal), 1, 1e-14);
    }
  }
}

// Quads, triangles and a pentagon, with a boundary; of a closed mesh all vertices have surfaces in dual schemes.
LimitSurface mixed_surface(Scheme scheme, double scale = 1) {
  std::mt19937_64 random(3);
  oracle::TaggedMesh mesh = scheme == Scheme::loop || scheme == Scheme::flat
                                ? oracle::meshes::triangulated(oracle::meshes::quad_grid(4, 3))
                            : scheme == Scheme::doo_sabin || scheme == Scheme::midedge
                                ? oracle::meshes::prism(5)
                                : oracle::meshes::mixed_strip();
  mesh = oracle::meshes::shaken(std::move(mesh), 0.2, random);
  ControlMesh control = testing::control_mesh(mesh);
  for (Point3& p : control.points) p = {scale * (p.x + 2), scale * p.y, scale * p.z};
  return LimitSurface(std::move(control), {scheme}, std::make_shared<BoundsCache>());
}

// Many a face, corners and edges among them, in random order.
std::vector<Place> shuffled_places(const LimitSurface& surface, std::size_t a_patch) {
  std::mt19937_64 random(4);
  std::vector<Place> places;
  for (std::uint32_t owner = 0; owner < surface.owner_count(); ++owner) {
    const auto [begin, end] = surface.patches_of(owner);
    if (begin == end || !surface.has_patch(PatchId(begin))) continue;
    const bool triangular = surface.rules().triangular();
    for (std::uint32_t corner = 0; corner < (triangular ? 1 : (end - begin) / 2); ++corner) {
      for (std::size_t i = 0; i < a_patch; ++i) {
        const auto coordinate = [&] {
          return i % 4 == 0 ? static_cast<double>(random() % 5) / 4 : testing::unit(random);
        };
        const double u = coordinate(), v = coordinate();
        places.push_back({owner, corner, u, triangular ? std::min(v, 1 - u) : v});
      }
    }
  }
  std::shuffle(places.begin(), places.end(), random);
  return places;
}

constexpr std::array every_scheme{Scheme::loop,    Scheme::catmark,  Scheme::doo_sabin,
                                  Scheme::midedge, Scheme::bilinear, Scheme::flat};

void expect_same_bits(const SurfacePoint& a, const SurfacePoint& b, const std::string& where) {
  EXPECT_EQ(a.point, b.point) << where;
  EXPECT_EQ(a.error, b.error) << where;
  EXPECT_EQ(a.tangents, b.tangents) << where;
  EXPECT_EQ(a.differentiable, b.differentiable) << where;
  EXPECT_EQ(a.normal, b.normal) << where;
  EXPECT_EQ(a.normal_error, b.normal_error) << where;
}

TEST(evaluate_many, answers_as_one_by_one_in_any_order_whatever_the_threads) {
  for (const Scheme scheme : every_scheme) {
    const LimitSurface surface = mixed_surface(scheme);
    std::vector<Place> places = shuffled_places(surface, 200);
    for (const bool sorted : {false, true}) {
      if (sorted) {
        std::sort(places.begin(), places.end(), [](const auto& a, const auto& b) {
          return std::tie(a.owner, a.corner) < std::tie(b.owner, b.corner);
        });
      }
      std::vector<SurfacePoint> alone;
      for (const Place& at : places) alone.push_back(evaluate(surface, at));
      for (const int threads : {1, 2, 3, 8}) {
        const std::vector<SurfacePoint> together = evaluate(surface, places, threads);
        ASSERT_EQ(together.size(), places.size());
        for (std::size_t i = 0; i < places.size(); ++i)
          expect_same_bits(together[i], alone[i], name_of(scheme));
        if (::testing::Test::HasFailure()) return;
      }
    }
  }
}

TEST(evaluate_many, gives_the_same_bits_on_every_instruction_set) {
  for (const Scheme scheme : every_scheme) {
    const LimitSurface surface = mixed_surface(scheme);
    const std::vector<Place> places = shuffled_places(surface, 60);
    const std::vector<SurfacePoint> first = evaluate(surface, places, 1);
    std::size_t sets = 0;
    testing::EachInstructionSet().run([&](const char* name) {
      ++sets;
      const std::vector<SurfacePoint> again = evaluate(surface, places, 1);
      for (std::size_t i = 0; i < places.size(); ++i) expect_same_bits(again[i], first[i], name);
    });
    EXPECT_GT(sets, 0u);
  }
}

TEST(evaluate_many, refuses_a_place_that_is_not_there_among_others) {
  const LimitSurface surface = mixed_surface(Scheme::catmark);
  for (const Place wrong : {Place{1000, 0, 0, 0}, {0, 9, 0, 0}, {0, 0, 2, 0}, {0, 0, 0, NAN}}) {
    std::vector<Place> places = shuffled_places(surface, 50);
    places[places.size() / 2] = wrong;
    EXPECT_THROW(static_cast<void>(evaluate(surface, places, 2)), InputError);
    std::vector<float> out(3 * places.size());
    EXPECT_THROW(evaluate(surface, places, {out}, 2), InputError);
  }
}

TEST(evaluate_in_single_precision, holds_its_error) {
  for (const Scheme scheme : every_scheme) {
    for (const double scale : {0x1p-146, 0x1p-130, 1.0, 0x1p100}) {
      const LimitSurface surface = mixed_surface(scheme, scale);
      const std::vector<Place> places = shuffled_places(surface, 100);
      std::vector<float> positions(3 * places.size()), normals(3 * places.size()), alone(3 * places.size());
      const double error = evaluate(surface, places, {positions, normals}, 2);
      EXPECT_EQ(evaluate(surface, places, {alone}, 1), error);
      EXPECT_EQ(positions, alone);
      EXPECT_LE(error, 8 * scale * 0x1p-24 + 0x1p-149);
      for (std::size_t i = 0; i < places.size(); ++i) {
        const SurfacePoint point = evaluate(surface, places[i]);
        Vector3 off = point.normal.value_or(Vector3{});
        for (std::size_t a = 0; a < 3; ++a) {
          EXPECT_LE(std::fabs(static_cast<double>(positions[3 * i + a]) - point.point[a]) + point.error,
                    error);
          off[a] -= static_cast<double>(normals[3 * i + a]);
        }
        EXPECT_LE(length(off), 0x1p-24);
      }
    }
  }
}

TEST(evaluate_in_single_precision, refuses_what_does_not_fit) {
  const LimitSurface surface = mixed_surface(Scheme::catmark, 0x1p130);
  const std::vector<Place> places = shuffled_places(surface, 10);
  std::vector<float> out(3 * places.size());
  testing::EachInstructionSet().run([&](const char* name) {
    try {
      evaluate(surface, places, {out}, 1);
      ADD_FAILURE() << name;
    } catch (const InputError& error) {
      EXPECT_EQ(error.problem(), InputProblem::unrepresentable) << name;
    }
  });
}

TEST(evaluate, of_flat_and_bilinear_faces_is_linear_between_their_corners) {
  for (const Scheme scheme : {Scheme::flat, Scheme::bilinear}) {
    const LimitSurface surface = mixed_surface(scheme);
    for (const Place& at : shuffled_places(surface, 60)) {
      const auto face = surface.mesh().face(FaceId(at.owner));
      if (face.size() > 4 || (scheme == Scheme::bilinear && face.size() == 3)) continue;
      const auto corner = [&](std::size_t k) { return surface.mesh().points[face[k].index()]; };
      const auto [u, v] = std::pair{at.u, at.v};
      const std::array<double, 4> weights =
          scheme == Scheme::flat ? std::array{1 - u - v, u, v, 0.0}
                                 : std::array{(1 - u) * (1 - v), u * (1 - v), u * v, (1 - u) * v};
      Vector3 sum;
      for (std::size_t k = 0; k < face.size(); ++k) sum = sum + weights[k] * (corner(k) - Point3{});
      const SurfacePoint point = evaluate(surface, at);
      EXPECT_LE(max_abs(point.point - (Point3{} + sum)), point.error + 1e-15);
      EXPECT_TRUE(point.differentiable);
    }
  }
}

}  // namespace
}  // namespace snug::evaluate_test
