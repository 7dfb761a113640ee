#include <snug/search/closed_mesh.h>

#include <algorithm>
#include <cmath>
#include <random>

#include <gtest/gtest.h>
#include <snug/search/feet.h>
#include <snug/search/offset_mesh.h>
#include <support/point.h>

namespace snug::closed_mesh_test {
namespace {

// Triangles anywhere, through each other, one a needle, one far away.
PieceSet any_set(std::mt19937_64& random) {
  std::uniform_real_distribution<double> unit(-0.8, 0.8);
  const auto any = [&] { return Point3{unit(random), unit(random), unit(random)}; };
  std::vector<QuadraticTriangle> pieces;
  for (int i = 0; i < 5; ++i) pieces.push_back(flat_quadratic({any(), any(), any()}));
  const Point3 p = any(), q = any();
  pieces.push_back(flat_quadratic({p, q, q + Vector3{1e-9, 0, 0}}));
  pieces.push_back(
      flat_quadratic({any() + Vector3{2, 0, 0}, any() + Vector3{2, 0, 0}, any() + Vector3{2, 0, 0}}));
  PieceSet set(std::move(pieces));
  set.prepare(1);
  return set;
}

ClosedMesh around(const PieceSet& set, double offset, int threads = 1, double cell = 1.1) {
  auto mesh = offset_mesh(
      set, {.offset = offset, .cell = cell * offset, .most_cells = 1'000'000, .threads = threads}, {});
  EXPECT_TRUE(mesh.has_value());
  return std::move(*mesh);
}

double volume(const ClosedMesh& mesh) {
  double sum = 0;
  for (const auto& [a, b, c] : mesh.triangles) {
    sum += dot(mesh.points[a] - Point3{}, cross(mesh.points[b] - Point3{}, mesh.points[c] - Point3{})) / 6;
  }
  return sum;
}

TEST(closed_mesh, around_any_set_is_a_manifold_about_the_offset) {
  std::mt19937_64 random(5);
  for (const double offset : {0.4, 0.15, 0.05}) {
    for (int i = 0; i < 4; ++i) {
      const PieceSet set = any_set(random);
      const ClosedMesh mesh = around(set, offset);
      EXPECT_TRUE(is_manifold(mesh));
      EXPECT_GT(volume(mesh), 0);
      for (const Point3& p : mesh.points) {
        EXPECT_NEAR(nearest_foot(set, p).distance, offset, 0.75 * offset);
      }
      // The same for any number of threads.
      const ClosedMesh again = around(set, offset, 3);
      EXPECT_EQ(mesh.points, again.points);
      EXPECT_EQ(mesh.triangles, again.triangles);
    }
  }
  const PieceSet set = any_set(random);
  EXPECT_FALSE(offset_mesh(set, {.offset = 0.01, .cell = 0.01, .most_cells = 1000}, {}).has_value());
}

// Feet on triangles without area may be far from the nearest: distances that are too large leave cubes out, and are no reason for a
// mesh with holes.
TEST(closed_mesh, around_needles_is_a_manifold_whatever_their_feet_are) {
  std::mt19937_64 random(7);
  std::uniform_real_distribution<double> unit(-0.8, 0.8);
  for (int trial = 0; trial < 40; ++trial) {
    std::vector<QuadraticTriangle> pieces;
    for (int i = 0; i < 6; ++i) {
      const Point3 p{unit(random), unit(random), unit(random)}, q{unit(random), unit(random), unit(random)};
      // On a line, or off it by as little as rounding; the third corner between, beyond or at one of the others.
      const double share = std::array{0.5, 1.7, 0.0, 1.0, unit(random)}[random() % 5];
      const double off = std::array{0.0, 1e-17, 1e-16, 1e-12}[random() % 4];
      pieces.push_back(flat_quadratic({p, q, p + share * (q - p) + Vector3{off, -off, 2 * off}}));
    }
    PieceSet set(std::move(pieces));
    set.prepare(1);
    EXPECT_TRUE(is_manifold(around(set, trial % 2 == 0 ? 0.1 : 0.04))) << trial;
  }
}

// The wall of a cavity, and what is in it.
TEST(closed_mesh, has_only_the_outermost_shells) {
  std::vector<QuadraticTriangle> pieces;
  const auto octahedron = [&](double size) {
    for (int side = 0; side < 8; ++side) {
      const Point3 a{(side & 1) != 0 ? size : -size, 0, 0}, b{0, (side & 2) != 0 ? size : -size, 0},
          c{0, 0, (side & 4) != 0 ? size : -size};
      pieces.push_back(flat_quadratic({a, b, c}));
    }
  };
  octahedron(1);
  octahedron(0.2);
  PieceSet both(pieces);
  pieces.resize(8);
  PieceSet one(pieces);
  both.prepare(1);
  one.prepare(1);
  const ClosedMesh mesh = around(both, 0.03), alone = around(one, 0.03);
  EXPECT_EQ(mesh.triangles.size(), alone.triangles.size());
  EXPECT_NEAR(volume(mesh), 4.0 / 3, 0.3);
}

TEST(closed_mesh, stays_a_manifold_when_edges_collapse_and_sides_are_halved) {
  std::mt19937_64 random(6);
  std::size_t collapsed = 0, refused = 0;
  for (int i = 0; i < 12; ++i) {
    const PieceSet set = any_set(random);
    const ClosedMesh whole = around(set, 0.1);
    ClosedMesh mesh = whole;
    // From careful to reckless, down to a handful of triangles.
    const double error = std::ldexp(0.01, i);
    std::vector<std::uint8_t> kept(whole.points.size());
    if (i % 3 == 1) {
      for (std::uint8_t& k : kept) k = random() % 10 == 0;
    }
    const auto accept = [&](const Triangle& t) {
      const bool is_small = distance(t[0], t[1]) < 0.3;
      refused += !is_small;
      return is_small;
    };
    simplify(mesh, error, i % 3 == 2 ? std::function<bool(const Triangle&)>(accept) : nullptr, kept, 1, {});
    ASSERT_TRUE(is_manifold(mesh)) << i;
    EXPECT_LT(mesh.triangles.size(), whole.triangles.size());
    collapsed += whole.triangles.size() - mesh.triangles.size();
    for (std::size_t v = 0; v < kept.size(); ++v) {
      if (kept[v] == 0) continue;
      EXPECT_NE(std::find(mesh.points.begin(), mesh.points.end(), whole.points[v]), mesh.points.end());
    }
    for (int round = 0; round < 4; ++round) {
      std::vector<std::uint8_t> marks(mesh.triangles.size());
      for (std::uint8_t& m : marks) m = random() % 3 == 0;
      const std::size_t before = mesh.triangles.size();
      const double size = volume(mesh);
      const auto added = halve_longest_sides(mesh, marks);
      ASSERT_TRUE(is_manifold(mesh)) << i;
      EXPECT_EQ(mesh.triangles.size(), before + 2 * added.size());
      EXPECT_EQ(marks.size(), mesh.triangles.size());
      EXPECT_NEAR(volume(mesh), size, 1e-9);
    }
  }
  EXPECT_GT(collapsed, 10'000u);
  EXPECT_GT(refused, 100u);
}

// Large meshes are collapsed in blocks, side by side.
TEST(closed_mesh, collapses_do_not_depend_on_threads) {
  std::mt19937_64 random(8);
  const PieceSet set = any_set(random);
  const ClosedMesh whole = around(set, 0.02);
  EXPECT_GT(whole.triangles.size(), 20'000u);
  std::vector<std::uint8_t> kept(whole.points.size());
  for (std::uint8_t& k : kept) k = random() % 50 == 0;
  const auto accept = [](const Triangle& t) { return distance(t[0], t[1]) < 0.2; };
  ClosedMesh one = whole, three = whole;
  simplify(one, 2e-3, accept, kept, 1, {});
  simplify(three, 2e-3, accept, kept, 3, {});
  EXPECT_EQ(one.points, three.points);
  EXPECT_EQ(one.triangles, three.triangles);
  EXPECT_TRUE(is_manifold(one));
  EXPECT_LT(3 * one.triangles.size(), whole.triangles.size());
  for (std::size_t v = 0; v < kept.size(); ++v) {
    if (kept[v] == 0 || v % 16 != 0) continue;
    EXPECT_NE(std::find(one.points.begin(), one.points.end(), whole.points[v]), one.points.end());
  }
}

// What is beyond the ball's centre on the outside is no part of it, however far from the ball's mesh.
TEST(closed_mesh, around_a_set_and_what_no_ball_gets_to) {
  const auto box = [](double hole) {
    // Four sides and a floor of a cube; a lid with a slit.
    std::vector<QuadraticTriangle> pieces;
    const auto square = [&](const Point3& a, const Point3& b, const Point3& c, const Point3& d) {
      pieces.push_back(flat_quadratic({a, b, c}));
      pieces.push_back(flat_quadratic({a, c, d}));
    };
    const auto corner = [](double x, double y, double z) { return Point3{x - 0.5, y - 0.5, z - 0.5}; };
    square(corner(0, 0, 0), corner(1, 0, 0), corner(1, 1, 0), corner(0, 1, 0));
    square(corner(0, 0, 0), corner(1, 0, 0), corner(1, 0, 1), corner(0, 0, 1));
    square(corner(0, 1, 0), corner(1, 1, 0), corner(1, 1, 1), corner(0, 1, 1));
    square(corner(0, 0, 0), corner(0, 1, 0), corner(0, 1, 1), corner(0, 0, 1));
    square(corner(1, 0, 0), corner(1, 1, 0), corner(1, 1, 1), corner(1, 0, 1));
    square(corner(0, 0, 1), corner(0.5 - hole / 2, 0, 1), corner(0.5 - hole / 2, 1, 1), corner(0, 1, 1));
    square(corner(0.5 + hole / 2, 0, 1), corner(1, 0, 1), corner(1, 1, 1), corner(0.5 + hole / 2, 1, 1));
    PieceSet set(std::move(pieces));
    set.prepare(1);
    return set;
  };
  constexpr double radius = 0.1, offset = 0.03;
  for (const auto& [hole, size] : {std::pair{0.18, 1.15}, {0.26, 0.33}}) {
    const PieceSet set = box(hole);
    const RollingBall ball(around(set, radius, 1, 0.2), radius - offset, 1);
    const auto mesh = offset_mesh(
        set, {.offset = offset, .cell = 0.03, .most_cells = 1'000'000, .ball = &ball, .threads = 1}, {});
    ASSERT_TRUE(mesh.has_value());
    EXPECT_TRUE(is_manifold(*mesh));
    EXPECT_NEAR(volume(*mesh), size, 0.12) << hole;
  }
}

TEST(closed_mesh, is_no_manifold_with_a_hole_a_fin_or_a_pinched_vertex) {
  const ClosedMesh tetrahedron{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}},
                               {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {2, 0, 3}}};
  EXPECT_TRUE(is_manifold(tetrahedron));
  ClosedMesh open = tetrahedron;
  open.triangles.pop_back();
  EXPECT_FALSE(is_manifold(open));
  ClosedMesh turned = tetrahedron;
  std::swap(turned.triangles[2][0], turned.triangles[2][1]);
  EXPECT_FALSE(is_manifold(turned));
  // Two that share a vertex.
  ClosedMesh pinched = tetrahedron;
  pinched.points.insert(pinched.points.end(), {{-1, 0, 0}, {0, -1, 0}, {0, 0, -1}});
  pinched.triangles.insert(pinched.triangles.end(), {{0, 4, 5}, {0, 6, 4}, {4, 6, 5}, {5, 6, 0}});
  EXPECT_FALSE(is_manifold(pinched));
  // A tetrahedron has no edge to collapse.
  ClosedMesh least = tetrahedron;
  simplify(least, 10, nullptr, {}, 1, {});
  EXPECT_TRUE(is_manifold(least));
  EXPECT_EQ(least.triangles.size(), 4u);
}

}  // namespace
}  // namespace snug::closed_mesh_test
