#include <snug/geometry/triangle_distance.h>

#include <gtest/gtest.h>
#include <support/direction.h>
#include <testing/containment.h>
#include <testing/counts.h>
#include <testing/instruction_sets.h>

#include <bit>
#include <random>
#include <string>
#include <vector>

namespace snug::triangle_distance_test {
namespace {

using testing::Extended;

Extended at(const Triangle& t, long double b, long double c) {
  Extended p;
  for (std::size_t k = 0; k < 3; ++k) p[k] = t[0][k] + b * (t[1][k] - t[0][k]) + c * (t[2][k] - t[0][k]);
  return p;
}

// Upper bound of the distance by alternating projections from many starts, in extended precision.
long double sampled_distance(const Triangle& a, const Triangle& b) {
  long double best = INFINITY;
  constexpr int steps = 6;
  for (int i = 0; i <= steps; ++i) {
    for (int j = 0; i + j <= steps; ++j) {
      best = std::min(best, testing::distance_to_triangle(at(a, i / 6.0L, j / 6.0L), b));
      best = std::min(best, testing::distance_to_triangle(at(b, i / 6.0L, j / 6.0L), a));
    }
  }
  return best;
}

Triangle any_triangle(std::mt19937_64& random, double size, const Point3& centre) {
  std::uniform_real_distribution<double> unit(-size, size);
  Triangle t;
  for (Point3& p : t) p = centre + Vector3{unit(random), unit(random), unit(random)};
  if (random() % 4 == 0) t[2] = t[0] + 1e-8 * (t[2] - t[0]);  // needle
  if (random() % 8 == 0) t[2] = t[1];                         // segment
  return t;
}

TEST(nearest_triangles, never_claims_more_than_the_distance) {
  std::mt19937_64 random(20);
  for (int trial = 0; trial < static_cast<int>(testing::fewer(100000)); ++trial) {
    const double size = std::ldexp(1.0, -static_cast<int>(random() % 30));
    const Point3 centre{1, -0.7, 0.3};
    const Triangle a = any_triangle(random, size, centre);
    Triangle b = any_triangle(random, size, centre + Vector3{size, 0, 0.5 * size});
    if (trial % 3 == 0) {  // parallel, a hair above
      const Vector3 n{0, 0, size * 1e-6};
      for (std::size_t k = 0; k < 3; ++k) b[k] = a[k] + n;
    }
    const NearestTriangles near = nearest(a, b);
    ASSERT_LE(near.certain_distance, sampled_distance(a, b) + 1e-18L) << trial;  // its own rounding
    ASSERT_GE(near.certain_distance, 0);
  }
}

TEST(nearest_triangles, is_as_good_as_the_points_it_finds) {
  std::mt19937_64 random(21);
  int loose = 0;
  for (int trial = 0; trial < 20000; ++trial) {
    const Triangle a = any_triangle(random, 0.5, {0, 0, 0}), b = any_triangle(random, 0.5, {0.8, 0, 0.5});
    const NearestTriangles near = nearest(a, b);
    const Extended p = at(a, near.on_a.b, near.on_a.c), q = at(b, near.on_b.b, near.on_b.c);
    const Extended d = testing::minus(p, q);
    const auto found = static_cast<double>(std::sqrt(testing::inner(d, d)));
    loose += near.certain_distance < found - 1e-7;
    ASSERT_LE(near.certain_distance, found);
  }
  EXPECT_LE(loose, 20);
}

// Facets of a fillet: edges on one line but for a rounding. Quotients of roundings once were crossings here.
TEST(nearest_triangles, keeps_triangles_with_edges_on_one_line_apart) {
  std::mt19937_64 random(23);
  std::uniform_real_distribution<double> unit(-1, 1);
  for (int trial = 0; trial < static_cast<int>(testing::fewer(50'000)); ++trial) {
    const bool along_axis = trial % 2 == 0;
    const Point3 begin{0.3 + unit(random), unit(random), unit(random)};
    const Vector3 line =
        along_axis ? Vector3{1, 0, 0} : normalized({unit(random), unit(random), unit(random)});
    const auto on_line = [&](double s) {
      Point3 p = begin + s * line;
      for (std::size_t a = 0; a < 3; ++a) p[a] *= 1 + 0x1p-53 * static_cast<double>(random() % 4);
      return p;
    };
    const auto across = [&] { return 0.02 * cross(line, Vector3{unit(random), unit(random), unit(random)}); };
    const double gap = 0x1p-10 + 0.02 * std::abs(unit(random));
    Triangle a{on_line(0), on_line(-0.03), on_line(-0.01) + across()};
    Triangle b{on_line(gap) + across(), on_line(gap), on_line(gap + 0.02)};
    const auto distance = static_cast<double>(sampled_distance(a, b));
    const double certain = nearest(a, b).certain_distance;
    ASSERT_LE(certain, distance + 1e-18) << trial;
    ASSERT_GE(certain, 0.9 * gap) << trial;
  }
}

TEST(nearest_triangles, sees_piercing_and_coplanar_overlap_as_contact) {
  const Triangle flat{Point3{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  const Triangle through{Point3{0.2, 0.2, -1}, {0.3, 0.2, 1}, {0.2, 0.3, 1}};
  EXPECT_EQ(nearest(flat, through).certain_distance, 0);
  EXPECT_EQ(nearest(through, flat).certain_distance, 0);
  const Triangle inside{Point3{0.1, 0.1, 0}, {0.2, 0.1, 0}, {0.1, 0.2, 0}};
  EXPECT_EQ(nearest(flat, inside).certain_distance, 0);
  EXPECT_EQ(nearest(flat, flat).certain_distance, 0);
}

// ---- the search against a plain one, case by case ----

struct Pair {
  long double distance_sq = INFINITY;
  Barycentric on_a, on_b;
};

Vector3 corner(const Triangle& t, std::size_t k) { return t[k % 3] - Point3{}; }

Barycentric on_edge(std::size_t edge, double t) {
  if (edge == 0) return {t, 0};
  if (edge == 1) return {1 - t, t};
  return {0, 1 - t};
}

double clamped(double t) { return t > 0 ? std::min(t, 1.0) : 0.0; }

long double distance_sq(const Triangle& a, Barycentric on_a, const Triangle& b, Barycentric on_b) {
  const Extended d = testing::minus(at(a, on_a.b, on_a.c), at(b, on_b.b, on_b.c));
  return testing::inner(d, d);
}

void try_pair(const Triangle& a, Barycentric on_a, const Triangle& b, Barycentric on_b, Pair& best) {
  const long double found = distance_sq(a, on_a, b, on_b);
  if (found < best.distance_sq) best = {found, on_a, on_b};
}

void try_edges(const Triangle& a, std::size_t i, const Triangle& b, std::size_t j, Pair& best) {
  const Vector3 d = corner(a, i + 1) - corner(a, i), e = corner(b, j + 1) - corner(b, j);
  const Vector3 r = corner(a, i) - corner(b, j);
  const double dd = length_sq(d), ee = length_sq(e), de = dot(d, e), dr = dot(d, r), er = dot(e, r);
  const double denominator = dd * ee - de * de;
  double s = denominator > 0 ? clamped((de * er - dr * ee) / denominator) : 0;
  double t = ee > 0 ? (de * s + er) / ee : 0;
  if (!(t >= 0 && t <= 1)) {
    t = clamped(t);
    s = dd > 0 ? clamped((de * t - dr) / dd) : 0;
  }
  try_pair(a, on_edge(i, s), b, on_edge(j, t), best);
}

bool pierces(const Triangle& a, std::size_t edge, const Triangle& b, double& t, Barycentric& on_b) {
  const Vector3 p = corner(a, edge), d = corner(a, edge + 1) - p;
  const Vector3 e1 = b[1] - b[0], e2 = b[2] - b[0], h = cross(d, e2);
  const double det = dot(e1, h);
  if (det == 0) return false;
  const Vector3 s = p - corner(b, 0), q = cross(s, e1);
  on_b = {dot(s, h) / det, dot(d, q) / det};
  t = dot(e2, q) / det;
  return t >= 0 && t <= 1 && on_b.b >= 0 && on_b.c >= 0 && on_b.b + on_b.c <= 1;
}

bool on_one_side(const Triangle& plane, const Triangle& other) {
  const Vector3 normal = cross(plane[1] - plane[0], plane[2] - plane[0]);
  const auto height = [&](std::size_t k) { return dot(normal, other[k] - plane[0]); };
  return (height(0) > 0 && height(1) > 0 && height(2) > 0) ||
         (height(0) < 0 && height(1) < 0 && height(2) < 0);
}

// Relative to one corner, as the library takes them.
Triangle relative(const Triangle& t, const Point3& origin) {
  return {Point3{} + (t[0] - origin), Point3{} + (t[1] - origin), Point3{} + (t[2] - origin)};
}

Pair plain_search(const Triangle& a, const Triangle& b) {
  const bool apart = on_one_side(a, b) || on_one_side(b, a);
  for (std::size_t i = 0; i < 3 && !apart; ++i) {
    double t = 0;
    Barycentric inside;
    if (pierces(a, i, b, t, inside)) return {0, on_edge(i, t), inside};
    if (pierces(b, i, a, t, inside)) return {0, inside, on_edge(i, t)};
  }
  Pair best;
  const TriangleFoot foot_a(corner(a, 0), corner(a, 1), corner(a, 2)),
      foot_b(corner(b, 0), corner(b, 1), corner(b, 2));
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t j = 0; j < 3; ++j) try_edges(a, i, b, j, best);
    try_pair(a, on_edge(i, 0), b, foot_b(corner(a, i)), best);
    try_pair(a, foot_a(corner(b, i)), b, on_edge(i, 0), best);
  }
  return best;
}

// Pairs of all sorts of triangles, of sizes from 1e-9 to 4.
std::pair<Triangle, Triangle> any_pair(std::mt19937_64& random) {
  std::uniform_real_distribution<double> unit(-1, 1);
  const double size = std::pow(10.0, -4.3 + 4.7 * unit(random));
  const auto any = [&](double scale) {
    return Vector3{scale * unit(random), scale * unit(random), scale * unit(random)};
  };
  const Point3 centre = Point3{} + any(1);
  Triangle a = any_triangle(random, size, centre);
  Triangle b = any_triangle(random, size, centre + any(2 * size));
  if (random() % 16 == 0) b = {b[0], b[0], b[0]};
  switch (random() % 8) {
    case 0:  // equal, or so
      b = a;
      for (Point3& p : b) p = p + any(random() % 2 == 0 ? 0 : 1e-9 * size);
      break;
    case 1:  // a common edge
      b[0] = a[1];
      b[1] = a[0];
      break;
    case 2:  // a common corner
      b[random() % 3] = a[random() % 3];
      break;
    case 3: {  // parallel, or nearly so
      const Vector3 by = any(size);
      for (std::size_t k = 0; k < 3; ++k) b[k] = a[k] + by + any(random() % 2 == 0 ? 0 : 1e-8 * size);
      break;
    }
    case 4: {  // nearly touching
      const Pair near = plain_search(a, b);
      const Extended p = at(a, near.on_a.b, near.on_a.c), q = at(b, near.on_b.b, near.on_b.c);
      for (Point3& c : b) {
        for (std::size_t k = 0; k < 3; ++k) c[k] += static_cast<double>((p[k] - q[k]) * (1 - 1e-7L));
      }
      break;
    }
    case 5:  // in one plane
      for (std::size_t k = 0; k < 3; ++k) a[k].z = b[k].z = centre.z;
      break;
    default:
      break;
  }
  if (random() % 2 == 0) std::swap(a, b);
  return {a, b};
}

TEST(nearest_triangles, finds_points_as_near_as_a_plain_search) {
  std::mt19937_64 random(22);
  int crossing = 0, apart = 0;
  for (int trial = 0; trial < 100000; ++trial) {
    const auto [first, second] = any_pair(random);
    const NearestTriangles near = nearest(first, second);
    const Triangle a = relative(first, first[0]), b = relative(second, first[0]);
    const Pair plain = plain_search(a, b);
    for (const Barycentric& p : {near.on_a, near.on_b}) {
      ASSERT_TRUE(p.b >= 0 && p.c >= 0 && p.b + p.c <= 1) << trial;
    }
    double reach = 0;
    for (std::size_t k = 0; k < 3; ++k)
      reach = std::max({reach, max_abs(corner(a, k)), max_abs(corner(b, k))});
    const long double found = std::sqrt(distance_sq(a, near.on_a, b, near.on_b));
    const long double expected = std::sqrt(distance_sq(a, plain.on_a, b, plain.on_b));
    ASSERT_LE(found, expected * (1 + 1e-12L) + 16 * unit_roundoff * reach) << trial;
    ASSERT_LE(near.certain_distance, expected) << trial;
    crossing += plain.distance_sq == 0;
    apart += near.certain_distance > 0;
    if (plain.distance_sq == 0) {
      ASSERT_EQ(near.certain_distance, 0) << trial;
    }
  }
  EXPECT_GT(crossing, 5000);
  EXPECT_GT(apart, 50000);
}

TEST(nearest_triangles, say_the_same_on_every_instruction_set) {
  const auto everything = [] {
    std::mt19937_64 random(23);
    std::vector<double> all;
    for (int trial = 0; trial < 5000; ++trial) {
      const auto [a, b] = any_pair(random);
      const NearestTriangles near = nearest(a, b);
      all.insert(all.end(), {near.on_a.b, near.on_a.c, near.on_b.b, near.on_b.c, near.certain_distance});
      if (const auto middle = middle_of_contact(a, b)) {
        all.insert(all.end(), {middle->on_a.b, middle->on_a.c, middle->on_b.b, middle->on_b.c});
      }
    }
    return all;
  };
  const std::vector<double> here = everything();
  testing::EachInstructionSet().run([&](const char* name) {
    const std::vector<double> there = everything();
    ASSERT_EQ(there.size(), here.size()) << name;
    std::size_t differences = 0;
    for (std::size_t i = 0; i < here.size(); ++i) {
      differences += std::bit_cast<std::uint64_t>(here[i]) != std::bit_cast<std::uint64_t>(there[i]);
    }
    EXPECT_EQ(differences, 0u) << name;
  });
}

}  // namespace
}  // namespace snug::triangle_distance_test
