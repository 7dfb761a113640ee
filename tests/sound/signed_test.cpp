// Signed distances: of random solids of every scheme against refined meshes, and of polyhedra with sharp
// edges, whose limit surface is the polyhedron itself, against exact rational arithmetic.
//
//   SNUG_PLACEMENTS=1000000 build/release/bin/tests/sound_test --gtest_filter='signed_distance.*'
//
// asks about so many points; SNUG_FIRST=N begins with solid N.

#include <snug/distance.h>

#include <gtest/gtest.h>
#include <oracle/polyhedron_twin.h>
#include <snug/search/surface_data.h>
#include <support/error.h>
#include <testing/solid_cases.h>
#include <testing/surfaces.h>

#include <cmath>
#include <iostream>

namespace snug::signed_test {
namespace {

constexpr std::uint64_t points_a_solid = 250;

using testing::between;
using testing::number_of;

// Bounds of the distance to the limit surface: that to boxes around hulls, that to limit points.
struct Bounds {
  double lower, upper;
};

Bounds twin_distance(const oracle::WindingTwin& twin, const std::vector<Point3>& limit_points,
                     const Point3& q) {
  Bounds bounds{twin.distance_to_boxes({q.x, q.y, q.z}), INFINITY};
  for (const Point3& p : limit_points) bounds.upper = std::min(bounds.upper, length_sq(p - q));
  bounds.upper = std::sqrt(bounds.upper);
  return bounds;
}

std::vector<Point3> limit_points_of(const testing::SolidCase& c) {
  std::vector<Point3> points;
  if (const oracle::Rules* const rules = std::get_if<oracle::Rules>(&c.scheme)) {
    for (const auto& s : oracle::sample_faces(c.mesh, *rules, 2)) {
      points.push_back({s.position[0], s.position[1], s.position[2]});
    }
  } else {
    for (const auto& s : oracle::sample_dual(c.mesh, std::get<oracle::DualScheme>(c.scheme), 3)) {
      points.push_back({s.position[0], s.position[1], s.position[2]});
    }
  }
  return points;
}

TEST(signed_distance, agrees_with_refined_meshes) {
  const std::uint64_t solids = (number_of("SNUG_PLACEMENTS", 10'000) + points_a_solid - 1) / points_a_solid;
  const std::uint64_t first = number_of("SNUG_FIRST", 0);
  std::size_t asked = 0, told = 0, inside = 0, unreached = 0;
  double widest = 0;
  for (std::uint64_t i = first; i < first + solids && !HasFailure(); ++i) {
    const testing::SolidCase c = testing::solid_case(i);
    std::mt19937_64 random(i + 5);
    try {
      const Surface surface = testing::public_surface(testing::control_mesh(c), c.options);
      const oracle::WindingTwin twin(c.mesh, c.scheme, testing::twin_levels(c.mesh, 400));
      const std::vector<Point3> limit_points = limit_points_of(c);
      const Ball& ball = surface.data()->bvh().ball();
      std::vector<Point3> points;
      for (std::uint64_t k = 0; k < points_a_solid; ++k) {
        Point3 q = k % 2 == 0 ? ball.centre : limit_points[random() % limit_points.size()];
        const double reach =
            ball.radius * (k % 2 == 0 ? between(random, 0.05, 1.1) : std::exp2(-between(random, 0, 12)));
        for (std::size_t x = 0; x < 3; ++x) q[x] += between(random, -1, 1) * reach;
        points.push_back(q);
      }
      Precision options{.absolute = 0, .relative = 0};
      options.absolute = std::exp2(-between(random, 3, 20)) * surface.size();
      const std::vector<SignedDistance> answers = signed_distance(surface, points, options, {.threads = 1});
      for (std::size_t k = 0; k < points.size(); ++k) {
        const SignedDistance& answer = answers[k];
        const Bounds truth = twin_distance(twin, limit_points, points[k]);
        const std::optional<int> number = twin({points[k].x, points[k].y, points[k].z});
        ++asked;
        told += number.has_value();
        inside += number.value_or(0) != 0;
        const double slack = 1e-12 * ball.radius;
        ASSERT_LE(answer.distance.lower, answer.distance.upper) << c.name;
        if (number) {
          const double lower = *number == 0 ? truth.lower : -truth.upper,
                       upper = *number == 0 ? truth.upper : -truth.lower;
          ASSERT_LE(answer.distance.lower, upper + slack) << c.name << ", point " << k;
          ASSERT_GE(answer.distance.upper, lower - slack) << c.name << ", point " << k;
          // Some points run into the budget of pieces.
          unreached += answer.outcome != Outcome::complete;
          if (answer.outcome == Outcome::complete)
            widest = std::max(widest, (answer.distance.upper - answer.distance.lower) / *options.absolute);
        } else {
          ASSERT_LE(std::max(answer.distance.lower, -answer.distance.upper), truth.upper + slack)
              << c.name << ", point " << k;
          ASSERT_GE(std::max(-answer.distance.lower, answer.distance.upper), truth.lower - slack)
              << c.name << ", point " << k;
        }
      }
    } catch (const InputError&) {
      continue;  // the same triangle twice
    }
  }
  std::cout << "  " << asked << " points, the twin tells " << told << ", " << inside
            << " of them inside; widest interval " << widest << " times what was asked, " << unreached
            << " not reached\n";
  EXPECT_GT(inside * 40, asked);
  EXPECT_LE(widest, 1);
  EXPECT_LE(unreached * 1000, told);
}

// Every edge infinitely sharp: the limit surface of a triangle is the triangle, as the flat and the bilinear
// scheme have it by themselves.
ControlMesh sharp_mesh(const oracle::TaggedMesh& shape) {
  oracle::TaggedMesh sharp = shape;
  for (const auto& polygon : shape.polygons) {
    for (std::size_t k = 0; k < polygon.size(); ++k) {
      sharp.creases.push_back({polygon[k], polygon[(k + 1) % polygon.size()], oracle::kInfinitelySharp});
    }
  }
  return testing::control_mesh(sharp);
}

TEST(signed_distance, of_sharp_polyhedra_is_exact) {
  const std::uint64_t solids = (number_of("SNUG_PLACEMENTS", 10'000) + 999) / 1000;
  std::size_t asked = 0, on_surface = 0, inside = 0, untold = 0;
  for (std::uint64_t i = 0; i < solids && !HasFailure(); ++i) {
    std::mt19937_64 random(i + 77);
    oracle::TaggedMesh shape = oracle::meshes::triangulated(testing::random_solid(random));
    for (oracle::Point& p : shape.points)
      for (double& x : p) x = std::round(8 * x);
    std::vector<oracle::Triangle> triangles;
    for (const auto& t : shape.polygons) triangles.push_back({t[0], t[1], t[2]});
    const oracle::PolyhedronTwin twin(shape.points, triangles);
    std::optional<Surface> surface;
    try {
      constexpr std::array schemes{Scheme::loop, Scheme::catmark, Scheme::flat, Scheme::bilinear};
      const Scheme scheme = schemes[i % schemes.size()];
      surface.emplace(traits_of(scheme).local ? testing::control_mesh(shape) : sharp_mesh(shape),
                      SurfaceOptions{.scheme = scheme});
      static_cast<void>(contains(*surface, Point3{}));
    } catch (const InputError&) {
      continue;  // the same triangle twice, or four at an edge
    }
    for (int k = 0; k < 60; ++k) {
      // Lattice points lie in planes of faces, on edges and at corners; others a hair away from them.
      Point3 q;
      for (std::size_t x = 0; x < 3; ++x) {
        q[x] = std::round(between(random, -16, 16)) / (k % 4 == 0 ? 1 : 2);
        if (k % 3 == 0) q[x] += std::ldexp(between(random, -1, 1), -static_cast<int>(random() % 50));
      }
      Precision options{.absolute = 0, .relative = 0};
      options.relative = 1e-9;
      const SignedDistance answer = signed_distance(*surface, q, options);
      const oracle::Point exact{q.x, q.y, q.z};
      const mpq_class square = twin.squared_distance(exact);
      const std::optional<int> number = twin.winding(exact);
      ++asked;
      inside += number.value_or(0) != 0;
      const double low = number == 0 ? answer.distance.lower : -answer.distance.upper,
                   high = number == 0 ? answer.distance.upper : -answer.distance.lower;
      if (!number) {
        ++on_surface;
        EXPECT_LE(answer.distance.lower, 0);
        EXPECT_GE(answer.distance.upper, 0);
        continue;
      }
      EXPECT_GE(high, 0) << i << ' ' << k;
      EXPECT_LE(square, mpq_class(high) * mpq_class(high)) << i << ' ' << k;
      if (low > 0) {
        EXPECT_GE(square, mpq_class(low) * mpq_class(low)) << i << ' ' << k;
      }
      const bool sign_told = answer.distance.lower > 0 || answer.distance.upper < 0 ||
                             answer.distance.lower == 0 || answer.distance.upper == 0;
      untold += !sign_told && square > 1e-20;
    }
  }
  std::cout << "  " << asked << " points, " << on_surface << " on the surface, " << inside << " inside, "
            << untold << " without a sign though more than 1e-10 away\n";
  EXPECT_GT(on_surface, 0u);
  EXPECT_GT(inside * 20, asked);
  EXPECT_LE(untold * 200, asked);
}

TEST(signed_distance, is_refused_for_open_surfaces_and_bad_points) {
  const Surface open(testing::control_mesh(oracle::meshes::quad_grid(3, 3)), {.scheme = Scheme::catmark});
  for (const Point3& q : {Point3{0, 0, 1}, Point3{1e9, 0, 0}}) {
    EXPECT_THROW(static_cast<void>(signed_distance(open, q)), InputError);
    EXPECT_THROW(static_cast<void>(contains(open, q)), InputError);
  }
  const Surface cube(testing::control_mesh(oracle::meshes::cube()), {.scheme = Scheme::catmark});
  EXPECT_THROW(static_cast<void>(contains(cube, Point3{NAN, 0, 0})), InputError);
  EXPECT_THROW(static_cast<void>(signed_distance(cube, Point3{0, INFINITY, 0})), InputError);
  EXPECT_EQ(contains(cube, Point3{1e300, 0, 0}), std::optional<bool>(false));
  EXPECT_EQ(contains(cube, Point3{0.5, 0.5, 0.5}), std::optional<bool>(true));
}

}  // namespace
}  // namespace snug::signed_test
