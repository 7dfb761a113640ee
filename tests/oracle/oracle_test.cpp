#include <gtest/gtest.h>
#include <oracle/distance_twin.h>
#include <oracle/loop_twin.h>
#include <oracle/test_meshes.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <set>
#include <stdexcept>
#include <utility>
#include <vector>

namespace oracle::oracle_test {
namespace {

using meshes::bipyramid;
using meshes::disturbed;
using meshes::grid;
using meshes::icosahedron;
using meshes::octahedron;
using meshes::quartered;
using meshes::wheel;

constexpr double kInfinity = std::numeric_limits<double>::infinity();

double separation(const Point& a, const Point& b) {
  return std::hypot(a[0] - b[0], a[1] - b[1], a[2] - b[2]);
}

Point moved(const Placement& m, const Point& p) {
  Point q{};
  for (std::size_t r = 0; r < 3; ++r)
    q[r] = m[4 * r] * p[0] + m[4 * r + 1] * p[1] + m[4 * r + 2] * p[2] + m[4 * r + 3];
  return q;
}

Placement translation(double x, double y, double z) { return {1, 0, 0, x, 0, 1, 0, y, 0, 0, 1, z}; }

/// A random rotation, then a random direction times `far`.
Placement random_placement(std::mt19937_64& random, double far) {
  std::normal_distribution<double> normal;
  double w = normal(random), x = normal(random), y = normal(random), z = normal(random);
  const double length = std::sqrt(w * w + x * x + y * y + z * z);
  w /= length, x /= length, y /= length, z /= length;
  const Point t{normal(random), normal(random), normal(random)};
  const double s = far / separation(t, {0, 0, 0});
  return {1 - 2 * (y * y + z * z), 2 * (x * y - z * w),     2 * (x * z + y * w),     s * t[0],
          2 * (x * y + z * w),     1 - 2 * (x * x + z * z), 2 * (y * z - x * w),     s * t[1],
          2 * (x * z - y * w),     2 * (y * z + x * w),     1 - 2 * (x * x + y * y), s * t[2]};
}

/// The affine image of the parameters of a sample, in double.
Point flat_point(const TwinMesh& mesh, const LimitSample& s) {
  const Triangle& t = mesh.triangles[s.face];
  Point p{};
  for (std::size_t x = 0; x < 3; ++x)
    p[x] = (1 - s.u - s.v) * mesh.points[t[0]][x] + s.u * mesh.points[t[1]][x] + s.v * mesh.points[t[2]][x];
  return p;
}

/// Samples of all kinds: uniform, near corners, near a point, at a point.
std::vector<LimitSample> many_samples(const TwinMesh& mesh, Arithmetic arithmetic) {
  auto all = sample_uniform(mesh, 3, arithmetic);
  const auto add = [&](const std::vector<LimitSample>& more) {
    all.insert(all.end(), more.begin(), more.end());
  };
  for (std::uint32_t face = 0; face < mesh.triangles.size(); face += 7) {
    for (std::uint32_t corner = 0; corner < 3; ++corner)
      add(sample_near_corner(mesh, face, corner, 60, arithmetic));
    add(sample_near_point(mesh, face, 0.1, 0.7, 40, arithmetic));
    add(sample_at(mesh, face, 0.3, 0.55, arithmetic));
  }
  return all;
}

std::vector<TwinMesh> assorted_meshes() {
  std::mt19937_64 random(20240601);
  std::vector<TwinMesh> all{disturbed(icosahedron(), 12, 0.3, random),
                            disturbed(bipyramid(3), 6, 0.3, random),
                            disturbed(bipyramid(50), 0, 0.3, random)};
  for (const Boundary boundary : {Boundary::edge_and_corner, Boundary::edge_only, Boundary::none}) {
    all.push_back(disturbed(grid(4, 3, boundary), 9, 0.3, random));
    all.push_back(disturbed(wheel(9, boundary), 4, 0.3, random));
  }
  for (double& x : all[0].points[0]) x *= 1e200;
  for (Point& p : all[1].points)
    for (double& x : p) x *= 1e-290;
  return all;
}

TEST(loop_twin, reproduces_linear_functions_on_a_regular_grid) {
  const TwinMesh mesh = grid(5, 5, Boundary::none);
  std::vector<LimitSample> samples = sample_uniform(mesh, 4);
  const std::uint32_t inner = samples[0].face;
  for (const auto& s : sample_near_corner(mesh, inner, 1, 60)) samples.push_back(s);
  for (const auto& s : sample_near_point(mesh, inner, 1.0 / 3, 0.25, 60)) samples.push_back(s);
  for (const auto& s : sample_at(mesh, inner, 0.1, 0.7)) samples.push_back(s);
  ASSERT_GT(samples.size(), 300U);
  for (const LimitSample& s : samples) {
    const Point p = flat_point(mesh, s);
    for (std::size_t x = 0; x < 3; ++x) ASSERT_NEAR(s.position[x], p[x], s.error + 4e-15);
  }
}

TEST(loop_twin, reproduces_quadratics_up_to_their_laplacian) {
  TwinMesh mesh = grid(5, 5, Boundary::none);
  for (Point& p : mesh.points) p[2] = p[0] * p[0] + 3 * p[0] * p[1];
  // Half the mean of the form over the six steps (+-1, 0), (0, +-1), +-(1, 1): (4 + 3 * 2) / 12.
  std::vector<LimitSample> samples = sample_uniform(mesh, 3);
  for (const auto& s : sample_near_corner(mesh, samples[0].face, 2, 60)) samples.push_back(s);
  for (const LimitSample& s : samples) {
    const Point p = flat_point(mesh, s);
    ASSERT_NEAR(s.position[2], p[0] * p[0] + 3 * p[0] * p[1] + 10.0 / 12, 1e-13);
  }
}

TEST(loop_twin, octahedron_corners_are_at_24_55ths) {
  const TwinMesh mesh = octahedron();
  for (const LimitSample& s : sample_uniform(mesh, 0)) {
    const std::size_t corner = s.u == 1 ? 1 : s.v == 1 ? 2 : 0;
    const Point& control = mesh.points[mesh.triangles[s.face][corner]];
    for (std::size_t x = 0; x < 3; ++x) EXPECT_DOUBLE_EQ(s.position[x], control[x] * 24 / 55);
  }
}

TEST(loop_twin, boundary_is_a_cubic_b_spline) {
  // Along the edge y = 0 of a long strip: p(t) for control points x = 0, 1, 4, 9 is the quadratic plus 1/3.
  for (const Boundary boundary : {Boundary::edge_and_corner, Boundary::edge_only}) {
    TwinMesh mesh = grid(6, 1, boundary);
    for (Point& p : mesh.points) p[2] = p[0] * p[0] + 100 * p[1];
    int seen = 0;
    for (const LimitSample& s : sample_uniform(mesh, 4)) {
      const Point p = flat_point(mesh, s);
      if (p[1] != 0 || p[0] < 1 || p[0] > 5) continue;
      ++seen;
      ASSERT_NEAR(s.position[2], p[0] * p[0] + 1.0 / 3, 1e-13);
    }
    EXPECT_GE(seen, 65);
  }
}

TEST(loop_twin, boundary_rules_differ_where_they_should) {
  const auto corner_of = [](Boundary boundary) {  // the face alone at the point (1, 0)
    const auto samples = sample_at(grid(1, 1, boundary), 0, 1, 0);
    return samples.empty() ? Point{-9, -9, -9} : samples[0].position;
  };
  EXPECT_EQ(corner_of(Boundary::edge_and_corner), (Point{1, 0, 0}));
  EXPECT_NEAR(corner_of(Boundary::edge_only)[0], 5.0 / 6, 1e-15);
  EXPECT_NEAR(corner_of(Boundary::edge_only)[1], 1.0 / 6, 1e-15);
  EXPECT_EQ(corner_of(Boundary::none), (Point{-9, -9, -9}));
  std::set<std::uint32_t> faces;
  for (const LimitSample& s : sample_uniform(grid(3, 3, Boundary::none), 1)) faces.insert(s.face);
  EXPECT_EQ(faces, (std::set<std::uint32_t>{8, 9}));
}

TEST(loop_twin, counts_and_parameters_are_as_promised) {
  const auto samples = sample_uniform(octahedron(), 2);
  ASSERT_EQ(samples.size(), 8U * 15);
  EXPECT_EQ(samples[1].u, 0.25);
  EXPECT_EQ(samples[5].v, 0.25);
  EXPECT_EQ(samples[16].face, 1U);
  EXPECT_EQ(sample_near_corner(octahedron(), 3, 0, 60).size(), 3U + 3 * 60);
  // At level 54 one edge point still has parameters that doubles hold: (1 - 2^-53, 2^-54).
  EXPECT_EQ(sample_near_corner(octahedron(), 3, 1, 60).size(), 3U + 3 * 53 + 1);
}

TEST(loop_twin, samples_shared_by_faces_agree) {
  // The same limit point by way of whole mesh, corner descents of several faces, and direct evaluation.
  std::mt19937_64 random(7);
  const TwinMesh mesh = disturbed(icosahedron(), 10, 0.2, random);
  for (const LimitSample& s : sample_uniform(mesh, 3)) {
    const auto again = sample_at(mesh, s.face, s.u, s.v);
    ASSERT_EQ(again.size(), 1U);
    for (std::size_t x = 0; x < 3; ++x)
      ASSERT_LE(std::abs(again[0].position[x] - s.position[x]), again[0].error + s.error);
  }
}

TEST(loop_twin, a_descent_reports_the_points_it_says) {
  std::mt19937_64 random(8);
  const TwinMesh mesh = disturbed(bipyramid(7), 5, 0.2, random);
  for (std::uint32_t corner = 0; corner < 3; ++corner)
    for (const LimitSample& s : sample_near_corner(mesh, 4, corner, 45)) {
      const auto again = sample_at(mesh, s.face, s.u, s.v);
      ASSERT_EQ(again.size(), 1U);
      for (std::size_t x = 0; x < 3; ++x)
        ASSERT_LE(std::abs(again[0].position[x] - s.position[x]), again[0].error + s.error);
    }
}

TEST(loop_twin, samples_near_a_corner_shrink_with_the_subdominant_eigenvalue) {
  for (const std::uint32_t n : {3U, 5U, 8U, 40U}) {
    const double eigenvalue = 3.0 / 8 + std::cos(2 * std::acos(-1.0) / n) / 4;
    const auto samples = sample_near_corner(bipyramid(n), 0, 0, 40);  // corner 0 is the apex
    const auto radius = [&](std::size_t level) {
      double r = 0;
      for (std::size_t i = 3 * level; i < 3 * level + 3; ++i)
        r = std::max(r, std::hypot(samples[i].position[0] - samples[0].position[0],
                                   samples[i].position[1] - samples[0].position[1]));
      return r;
    };
    EXPECT_NEAR(radius(30) / radius(29), eigenvalue, 1e-6) << "valence " << n;
  }
}

TEST(loop_twin, quad_stays_within_its_error_of_the_interval_twin) {
  for (const TwinMesh& mesh : assorted_meshes()) {
    const auto quad = many_samples(mesh, Arithmetic::quad);
    const auto exact = many_samples(mesh, Arithmetic::interval);
    ASSERT_EQ(quad.size(), exact.size());
    std::size_t same = 0;
    for (std::size_t i = 0; i < quad.size(); ++i) {
      ASSERT_EQ(quad[i].face, exact[i].face);
      ASSERT_EQ(quad[i].u, exact[i].u);
      ASSERT_EQ(quad[i].v, exact[i].v);
      for (std::size_t x = 0; x < 3; ++x)
        ASSERT_LE(std::abs(quad[i].position[x] - exact[i].position[x]), quad[i].error + exact[i].error);
      if (quad[i].position == exact[i].position) {
        // The error of the interval is the true one, up to 2^-150: the quad's may not be less, and hardly is
        // more.
        ++same;
        ASSERT_GE(quad[i].error, exact[i].error * (1 - 1e-14));
      }
    }
    EXPECT_GE(same, quad.size() * 99 / 100);
  }
}

TEST(loop_twin, error_is_no_more_than_the_last_rounding_and_the_stated_bound) {
  const auto samples = sample_near_corner(bipyramid(1000), 0, 0, 60);
  ASSERT_EQ(samples.size(), 183U);
  for (const LimitSample& s : samples) {
    const double largest =
        std::max({std::abs(s.position[0]), std::abs(s.position[1]), std::abs(s.position[2])});
    EXPECT_LE(s.error, 0x1p-53 * largest + 61 * 1008 * 0x1p-111);
    EXPECT_GT(s.error, 0);
  }
}

TEST(loop_twin, refuses_what_it_cannot_sample) {
  TwinMesh mesh = octahedron();
  EXPECT_THROW((void)sample_uniform(mesh, 13), std::invalid_argument);
  EXPECT_THROW((void)sample_at(mesh, 8, 0, 0), std::invalid_argument);
  EXPECT_THROW((void)sample_at(mesh, 0, 0.75, 0.5), std::invalid_argument);
  EXPECT_THROW((void)sample_near_corner(mesh, 0, 3, 1), std::invalid_argument);
  TwinMesh broken = mesh;
  broken.points[0][1] = std::nan("");
  EXPECT_THROW((void)sample_uniform(broken, 1), std::invalid_argument);
  EXPECT_THROW((void)sample_at(broken, 0, 0, 0), std::invalid_argument);
  broken = mesh;
  broken.triangles.push_back({0, 2, 1});  // a third face at an edge
  EXPECT_THROW((void)sample_uniform(broken, 1), std::invalid_argument);
  broken = mesh;
  broken.triangles.push_back({0, 6, 7});  // a second fan at a point
  broken.points.push_back({2, 0, 0});
  broken.points.push_back({2, 1, 0});
  EXPECT_THROW((void)sample_uniform(broken, 1), std::invalid_argument);
  EXPECT_THROW((void)sample_at(broken, 0, 0, 0), std::invalid_argument);
  broken = mesh;
  broken.triangles.push_back({0, 1, 6});
  EXPECT_THROW((void)sample_uniform(broken, 1), std::invalid_argument);
  EXPECT_THROW((void)sample_uniform(bipyramid(1001), 0), std::invalid_argument);
}

TEST(distance_twin, octahedra_along_an_axis) {
  const double gap = 4 - 48.0 / 55;
  const TwinDistance d = brute_distance(octahedron(), kUnmoved, octahedron(), translation(4, 0, 0), 1e-6);
  EXPECT_LE(d.lower, gap);
  EXPECT_GE(d.upper, gap);
  EXPECT_LE(d.upper - d.lower, 1.1e-6);
  EXPECT_NEAR(separation(d.on_a, {24.0 / 55, 0, 0}), 0, 1e-2);
}

TEST(distance_twin, icosahedra_by_symmetry) {
  // Corner to corner, in the frame of the mesh and turned together.
  const TwinMesh mesh = icosahedron();
  const double top = sample_at(mesh, 0, 0, 0)[0].position[2], gap = 3 - 2 * top;
  std::mt19937_64 random(3);
  DistanceTwin twin(mesh, mesh);
  for (int i = 0; i < 5; ++i) {
    const Placement a = i == 0 ? kUnmoved : random_placement(random, 1);
    Placement b = a;
    for (std::size_t r = 0; r < 3; ++r) b[4 * r + 3] += 3 * a[4 * r + 2];
    const TwinDistance d = twin.query(a, b, {1e-6});
    EXPECT_LE(d.lower, gap + 1e-14);
    EXPECT_GE(d.upper, gap - 1e-14);
    EXPECT_LE(d.upper - d.lower, 1.1e-6);
  }
}

TEST(distance_twin, bounds_agree_with_dense_samples) {
  std::mt19937_64 random(4);
  const TwinMesh a = disturbed(icosahedron(), 15, 0.15, random),
                 b = disturbed(grid(3, 3, Boundary::edge_only), 5, 0.2, random);
  const auto samples_a = sample_uniform(a, 3), samples_b = sample_uniform(b, 4);
  DistanceTwin twin(a, b);
  SurfaceTwin on_a(a), on_b(b);
  int apart = 0, touching = 0;
  for (int i = 0; i < 24; ++i) {
    const Placement place_a = random_placement(random, 0.3 * i), place_b = random_placement(random, 0);
    const TwinDistance d = twin.query(place_a, place_b, {1e-3});
    std::vector<Point> moved_b;
    for (const LimitSample& s : samples_b) moved_b.push_back(moved(place_b, s.position));
    double nearest = kInfinity;
    for (const LimitSample& s : samples_a) {
      const Point p = moved(place_a, s.position);
      for (const Point& q : moved_b) nearest = std::min(nearest, separation(p, q));
    }
    EXPECT_LE(d.lower, nearest) << i;
    EXPECT_GE(d.upper, nearest - 0.2) << i;  // no closer than the spacing of the samples allows
    EXPECT_LE(d.upper - d.lower, 1e-3 + 1e-11) << i;
    EXPECT_LE(separation(d.on_a, d.on_b), d.upper) << i;
    EXPECT_TRUE(on_a.on_surface(place_a, d.on_a, 1e-10)) << i;
    EXPECT_TRUE(on_b.on_surface(place_b, d.on_b, 1e-10)) << i;
    ++(d.lower > 0 ? apart : touching);
  }
  EXPECT_GT(apart, 3);
  EXPECT_GT(touching, 3);
}

TEST(distance_twin, finer_precision_nests) {
  std::mt19937_64 random(5);
  const TwinMesh mesh = disturbed(icosahedron(), 10, 0.1, random);
  DistanceTwin twin(mesh, mesh);
  for (int i = 0; i < 10; ++i) {
    const Placement a = random_placement(random, 2.2), b = random_placement(random, 0);
    const TwinDistance coarse = twin.query(a, b, {1e-2}), fine = twin.query(a, b, {1e-6});
    EXPECT_LE(coarse.lower, fine.upper);
    EXPECT_LE(fine.lower, coarse.upper);
    EXPECT_LE(fine.upper - fine.lower, 1.1e-6);
  }
}

TEST(distance_twin, meeting_surfaces_have_no_gap_and_nested_ones_do) {
  const TwinMesh mesh = icosahedron();
  const TwinDistance meeting = brute_distance(mesh, kUnmoved, mesh, translation(0.9, 0, 0.1), 1e-6);
  EXPECT_EQ(meeting.lower, 0);
  EXPECT_LE(meeting.upper, 1.1e-6);
  TwinMesh small = mesh;
  for (Point& p : small.points)
    for (double& x : p) x /= 4;
  // The same corner of both is 3/4 of its radius apart, and the surface is nearly a sphere.
  const double apart = 0.75 * sample_at(mesh, 0, 0, 0)[0].position[2];
  const TwinDistance nested = DistanceTwin(mesh, small).query(kUnmoved, kUnmoved, {0, 0.05});
  EXPECT_LE(nested.lower, apart);
  EXPECT_GE(nested.lower, 0.9 * apart);
}

TEST(distance_twin, a_scaled_placement_is_the_scaled_mesh) {
  const Placement scaled{16, 0, 0, 0, 0, 16, 0, 0, 0, 0, 16, 0};
  TwinMesh large = octahedron();
  for (Point& p : large.points)
    for (double& x : p) x *= 16;
  const TwinMesh mesh = octahedron();
  const Placement apart = translation(5, 5, 5);  // the middles of two faces are nearest
  const TwinDistance d = brute_distance(mesh, scaled, mesh, apart, 1e-5);
  const TwinDistance e = brute_distance(large, kUnmoved, mesh, apart, 1e-5);
  EXPECT_GT(d.lower, 1);
  EXPECT_LE(d.lower, e.upper);
  EXPECT_LE(e.lower, d.upper);
}

TEST(surface_twin, finds_limit_points_on_the_surface) {
  std::mt19937_64 random(6);
  for (const Boundary boundary : {Boundary::edge_and_corner, Boundary::edge_only, Boundary::none}) {
    const TwinMesh mesh = disturbed(grid(4, 4, boundary), 8, 0.2, random);
    SurfaceTwin twin(mesh);
    const Placement place = random_placement(random, 1);
    const auto samples = sample_uniform(mesh, 4);
    for (std::size_t i = 0; i < samples.size(); i += 17) {
      const Point p = moved(place, samples[i].position);
      EXPECT_TRUE(twin.on_surface(place, p, 1e-11));
      EXPECT_TRUE(twin.on_surface(place, p, 1e-11, samples[i].face));
      EXPECT_LE(twin.distance_to(place, p, {1e-10}).upper, 1.1e-10);
    }
  }
}

TEST(surface_twin, tells_points_off_the_surface) {
  const TwinMesh mesh = octahedron();
  SurfaceTwin twin(mesh);
  const double corner = 24.0 / 55;
  EXPECT_FALSE(twin.on_surface(kUnmoved, {corner + 1e-9, 0, 0}, 1e-10));
  EXPECT_TRUE(twin.on_surface(kUnmoved, {corner + 1e-9, 0, 0}, 1e-8));
  EXPECT_FALSE(on_surface(mesh, kUnmoved, {corner, 0, 0}, 1e-3, 1));  // face 1 does not reach that corner
  EXPECT_TRUE(on_surface(mesh, kUnmoved, {corner, 0, 0}, 1e-10, 0));
  const PointDistance far = twin.distance_to(kUnmoved, {10, 0, 0}, {1e-8});
  EXPECT_LE(far.lower, 10 - corner);
  EXPECT_GE(far.upper, 10 - corner);
  EXPECT_LE(far.upper - far.lower, 1.1e-8);
}

TEST(surface_twin, distance_from_the_centre_is_that_of_the_nearest_sample) {
  std::mt19937_64 random(9);
  const TwinMesh mesh = disturbed(icosahedron(), 10, 0.1, random);
  double nearest = kInfinity;
  for (const LimitSample& s : sample_uniform(mesh, 6))
    nearest = std::min(nearest, separation(s.position, {0, 0, 0}));
  const PointDistance d = SurfaceTwin(mesh).distance_to(kUnmoved, {0, 0, 0}, {0, 1e-4});
  EXPECT_LE(d.lower, nearest);
  EXPECT_NEAR(d.upper, nearest, 2e-4);
}

TEST(surface_twin, refuses_what_has_no_surface) {
  EXPECT_THROW(SurfaceTwin(grid(1, 1, Boundary::none)), std::invalid_argument);
  SurfaceTwin twin(grid(3, 3, Boundary::none));
  EXPECT_THROW((void)twin.on_surface(kUnmoved, {0, 0, 0}, 1, 0), std::invalid_argument);
  EXPECT_THROW((void)twin.on_surface(translation(kInfinity, 0, 0), {0, 0, 0}, 1), std::invalid_argument);
}

}  // namespace
}  // namespace oracle::oracle_test
