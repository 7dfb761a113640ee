#include <oracle/hausdorff_twin.h>

#include <gtest/gtest.h>
#include <oracle/polyhedron_twin.h>
#include <oracle/tagged_shapes.h>

#include <cmath>
#include <limits>
#include <random>
#include <stdexcept>

namespace oracle::hausdorff_twin_test {
namespace {

using Set = std::vector<Corners>;

Set triangles(const TaggedMesh& mesh) {
  Set set;
  for (const auto& t : meshes::triangulated(mesh).polygons) {
    set.push_back({mesh.points[t[0]], mesh.points[t[1]], mesh.points[t[2]]});
  }
  return set;
}

Set changed(Set set, double scale, const Point& by) {
  for (Corners& t : set)
    for (Point& p : t)
      for (std::size_t x = 0; x < 3; ++x) p[x] = scale * p[x] + by[x];
  return set;
}

Set halved(const Set& set) {
  Set parts;
  for (const auto& [a, b, c] : set) {
    const Point m{(a[0] + b[0]) / 2, (a[1] + b[1]) / 2, (a[2] + b[2]) / 2};
    parts.push_back({a, m, c});
    parts.push_back({m, b, c});
  }
  return parts;
}

void expect_distance(const Set& from, const Set& to, long double truth, Side side = Side::any) {
  const HausdorffBounds found = one_sided_hausdorff(from, to, {1e-9L, side});
  EXPECT_LE(found.lower, truth);
  EXPECT_GE(found.upper, truth);
  EXPECT_LE(found.upper - found.lower, 1e-8L);
  EXPECT_FALSE(found.spent);
}

TEST(hausdorff_twin, knows_cubes) {
  const Set cube = triangles(meshes::cube());
  expect_distance(cube, cube, 0);
  expect_distance(halved(halved(cube)), cube, 0);
  expect_distance(cube, halved(halved(halved(cube))), 0);
  const long double diagonal = std::sqrt(3.0L);
  expect_distance(cube, changed(cube, 1, {0.25, 0, 0}), 0.25L);
  expect_distance(cube, changed(cube, 1, {10, 0, 0}), 10);
  expect_distance(changed(cube, 3, {-1, -1, -1}), cube, diagonal);
  expect_distance(cube, changed(cube, 3, {-1, -1, -1}), 1);
  // The middle of the larger one's faces is the farthest from nowhere; the smaller one is as far everywhere.
  expect_distance(changed(cube, 0.5, {0.25, 0.25, 0.25}), cube, 0.25L);
  expect_distance(cube, {{Point{0.5, 0.5, 0.5}, Point{0.5, 0.5, 0.5}, Point{0.5, 0.5, 0.5}}}, diagonal / 2);
  // Without the lid: from the middle of a square to its sides.
  Set open = cube;
  for (std::size_t f = 0; f < open.size();) {
    const bool lid = open[f][0][2] == 1 && open[f][1][2] == 1 && open[f][2][2] == 1;
    lid ? static_cast<void>(open.erase(open.begin() + static_cast<std::ptrdiff_t>(f)))
        : static_cast<void>(++f);
  }
  ASSERT_EQ(open.size(), 10u);
  expect_distance(cube, open, 0.5L);
  expect_distance(open, cube, 0);
}

TEST(hausdorff_twin, knows_what_is_inside_and_what_outside) {
  const Set cube = triangles(meshes::cube());
  const Set inner = changed(cube, 0.5, {0.25, 0.25, 0.25}), outer = changed(cube, 3, {-1, -1, -1});
  expect_distance(inner, cube, 0.25L, Side::inside);
  expect_distance(inner, cube, 0, Side::outside);
  expect_distance(outer, cube, std::sqrt(3.0L), Side::outside);
  expect_distance(outer, cube, 0, Side::inside);
  const Set across = changed(cube, 1, {0.25, 0, 0});
  expect_distance(across, cube, 0.25L, Side::outside);
  expect_distance(across, cube, 0.25L, Side::inside);
  expect_distance(cube, cube, 0, Side::inside);
  expect_distance(cube, cube, 0, Side::outside);
  // Turned inside out the solid is the same.
  Set turned = cube;
  for (Corners& t : turned) std::swap(t[0], t[1]);
  expect_distance(across, turned, 0.25L, Side::inside);
  Set open = cube;
  open.pop_back();
  EXPECT_THROW(static_cast<void>(one_sided_hausdorff(inner, open, {0, Side::inside})), std::invalid_argument);
}

Point random_point(std::mt19937_64& random, int extent) {
  std::uniform_int_distribution<int> coordinate(-extent, extent);
  return {double(coordinate(random)), double(coordinate(random)), double(coordinate(random))};
}

Set random_set(std::mt19937_64& random, std::size_t count, int extent) {
  Set set;
  while (set.size() < count) {
    set.push_back({random_point(random, extent), random_point(random, extent), random_point(random, extent)});
  }
  return set;
}

PolyhedronTwin exact(const Set& set) {
  std::vector<Point> points;
  std::vector<Triangle> faces;
  for (const Corners& t : set) {
    const auto first = static_cast<std::uint32_t>(points.size());
    points.insert(points.end(), t.begin(), t.end());
    faces.push_back({first, first + 1, first + 2});
  }
  return {points, faces};
}

mpq_class square_of(long double x) {
  const double high = static_cast<double>(x);
  const mpq_class sum = mpq_class(high) + mpq_class(static_cast<double>(x - high));
  return sum * sum;
}

// Points of triangles with whole-numbered corners, in exact arithmetic: none is farther than the upper end,
// and the farthest one is as far as the lower end.
TEST(hausdorff_twin, contains_what_exact_points_say) {
  std::mt19937_64 random(3);
  std::size_t reached = 0;
  for (int trial = 0; trial < 300 && !HasFailure(); ++trial) {
    const int extent = trial % 2 == 0 ? 16 : 2;  // on a small lattice many are degenerate or in one plane
    const Set from = random_set(random, 1 + random() % 3, extent),
              to = random_set(random, 1 + random() % 12, extent);
    const HausdorffBounds found = one_sided_hausdorff(from, to, {1e-6L * extent, Side::any, 4000});
    reached += !found.spent;
    EXPECT_TRUE(found.spent || found.upper - found.lower <= 1.01e-6L * extent) << trial;
    const PolyhedronTwin twin = exact(to);
    mpq_class most = 0;
    const int steps = 8;
    for (const auto& [a, b, c] : from)
      for (int i = 0; i <= steps; ++i)
        for (int j = 0; i + j <= steps; ++j) {
          Point p;
          for (std::size_t x = 0; x < 3; ++x) p[x] = (i * a[x] + j * b[x] + (steps - i - j) * c[x]) / steps;
          most = std::max(most, twin.squared_distance(p));
        }
    EXPECT_GE(square_of(found.upper), most) << trial;
    if (found.lower > 0) {
      EXPECT_LE(square_of(found.lower * (1 - 1e-14L)), twin.squared_distance(found.farthest)) << trial;
      EXPECT_LE(distance_to_triangles(found.farthest, from).lower, 1e-14L * extent) << trial;
    }
  }
  EXPECT_GT(reached, 280u);
}

// On each side of random closed polyhedra.
TEST(hausdorff_twin, contains_what_exact_points_of_a_side_say) {
  std::mt19937_64 random(4);
  std::size_t counted[2]{};
  for (int trial = 0; trial < 40 && !HasFailure(); ++trial) {
    TaggedMesh shape = meshes::triangulated(meshes::shaken(
        trial % 2 == 0 ? meshes::prism(3 + static_cast<std::uint32_t>(random() % 3)) : meshes::cube(), 0.3,
        random));
    for (Point& p : shape.points)
      for (double& x : p) x = std::round(16 * x);
    const Set to = triangles(shape), from = random_set(random, 1 + random() % 3, 24);
    std::vector<Triangle> faces;
    for (const auto& t : shape.polygons) faces.push_back({t[0], t[1], t[2]});
    const PolyhedronTwin twin(shape.points, faces);
    const HausdorffBounds bounds[2]{one_sided_hausdorff(from, to, {1e-4L, Side::inside}),
                                    one_sided_hausdorff(from, to, {1e-4L, Side::outside})};
    const HausdorffBounds all = one_sided_hausdorff(from, to, {1e-4L});
    EXPECT_LE(std::max(bounds[0].lower, bounds[1].lower), all.upper);
    EXPECT_GE(std::max(bounds[0].upper, bounds[1].upper), all.lower);
    const int steps = 10;
    for (const auto& [a, b, c] : from)
      for (int i = 0; i <= steps; ++i)
        for (int j = 0; i + j <= steps; ++j) {
          Point p;
          for (std::size_t x = 0; x < 3; ++x) p[x] = (i * a[x] + j * b[x] + (steps - i - j) * c[x]) / steps;
          const std::optional<int> winding = twin.winding(p);
          if (!winding) continue;
          const std::size_t side = *winding != 0 ? 0 : 1;
          ++counted[side];
          EXPECT_GE(square_of(bounds[side].upper), twin.squared_distance(p)) << trial;
        }
    for (const std::size_t side : {0u, 1u}) {
      if (bounds[side].lower == 0) continue;
      const std::optional<int> winding = twin.winding(bounds[side].farthest);
      EXPECT_TRUE(winding && (*winding != 0) == (side == 0)) << trial;
      EXPECT_LE(square_of(bounds[side].lower * (1 - 1e-14L)), twin.squared_distance(bounds[side].farthest))
          << trial;
    }
  }
  EXPECT_GT(counted[0], 100u);
  EXPECT_GT(counted[1], 300u);
}

TEST(hausdorff_twin, does_not_depend_on_the_unit) {
  std::mt19937_64 random(5);
  for (int trial = 0; trial < 20; ++trial) {
    const Set from = random_set(random, 3, 9), to = random_set(random, 5, 9);
    const HausdorffBounds plain = one_sided_hausdorff(from, to, {1e-4L});
    for (const int power : {-1000, -500, 500, 1000}) {
      const double s = std::ldexp(1.0, power);
      const HausdorffBounds scaled =
          one_sided_hausdorff(changed(from, s, {}), changed(to, s, {}), {std::ldexp(1e-4L, power)});
      EXPECT_EQ(scaled.lower, std::ldexp(plain.lower, power));
      EXPECT_EQ(scaled.upper, std::ldexp(plain.upper, power));
    }
  }
}

TEST(hausdorff_twin, needs_triangles) {
  const Set cube = triangles(meshes::cube());
  EXPECT_THROW(static_cast<void>(one_sided_hausdorff({}, cube, {})), std::invalid_argument);
  EXPECT_THROW(static_cast<void>(one_sided_hausdorff(cube, {}, {})), std::invalid_argument);
}

}  // namespace
}  // namespace oracle::hausdorff_twin_test
