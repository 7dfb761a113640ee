#include <snug/search/self_contact.h>

#include <gtest/gtest.h>
#include <oracle/facet_twin.h>
#include <oracle/hull_twin.h>
#include <oracle/test_meshes.h>
#include <testing/counts.h>
#include <testing/patches.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <map>
#include <numbers>
#include <random>
#include <set>
#include <string>
#include <vector>

namespace snug::self_contact_test {
namespace {

using Names = std::array<std::uint32_t, 3>;

struct Mesh {
  std::vector<Point3> points;
  std::vector<Names> triangles;
  [[nodiscard]] std::size_t contacts() const { return self_contacts(points, triangles, 100, 1).size(); }
};

Mesh some_sphere() {
  const oracle::TwinMesh twin =
      oracle::meshes::quartered(oracle::meshes::quartered(oracle::meshes::icosahedron()));
  const ControlMesh control = testing::surface_of(twin).mesh();
  Mesh mesh{control.points, {}};
  for (Point3& p : mesh.points) p = Point3{} + 0.5 * (p - Point3{});
  for (std::size_t f = 0; f < control.face_count(); ++f) {
    const auto face = control.face(FaceId(f));
    mesh.triangles.push_back({face[0].value(), face[1].value(), face[2].value()});
  }
  return mesh;
}

TEST(self_contact, of_a_sphere_there_is_none) {
  const Mesh mesh = some_sphere();
  EXPECT_EQ(mesh.contacts(), 0u);
  EXPECT_EQ(self_contacts(mesh.points, mesh.triangles, 100, 3),
            self_contacts(mesh.points, mesh.triangles, 100, 1));
}

// Where all triangles meet, each is reported, but not every pair.
TEST(self_contact, of_triangles_on_each_other_takes_little_memory) {
  Mesh mesh;
  constexpr std::uint32_t count = 300;
  for (std::uint32_t t = 0; t < count; ++t) {
    for (const Point3& p : {Point3{0, 0, 0}, Point3{1, 0, 0}, Point3{0, 1, 0}}) mesh.points.push_back(p);
    mesh.triangles.push_back({3 * t, 3 * t + 1, 3 * t + 2});
  }
  const auto found = self_contacts(mesh.points, mesh.triangles, 1'000'000, 2);
  EXPECT_LE(found.size(), 16u * count);
  std::vector<bool> reported(count);
  for (const TrianglePair& pair : found) {
    reported[pair.a] = reported[pair.b] = true;
    EXPECT_EQ(pair.contact, TriangleContact::overlapping);
  }
  EXPECT_EQ(std::count(reported.begin(), reported.end(), true), count);
}

// A vertex pushed through the other side, a little or a lot; onto a triangle; onto another vertex.
TEST(self_contact, finds_a_vertex_that_goes_through) {
  std::mt19937_64 random(3);
  for (int trial = 0; trial < 200; ++trial) {
    Mesh mesh = some_sphere();
    const std::size_t v = random() % mesh.points.size();
    const Names other = mesh.triangles[random() % mesh.triangles.size()];
    if (std::find(other.begin(), other.end(), v) != other.end()) continue;
    const Vector3 middle =
        (1.0 / 3) * ((mesh.points[other[0]] - Point3{}) + (mesh.points[other[1]] - Point3{}) +
                     (mesh.points[other[2]] - Point3{}));
    mesh.points[v] = Point3{} + (trial % 3 == 0 ? 1.0 : 1.01) * middle;
    if (trial % 3 == 0) {  // up to rounding, on either side of it
      std::vector<oracle::Point> points;
      for (const Point3& p : mesh.points) points.push_back({p.x, p.y, p.z});
      EXPECT_EQ(mesh.contacts() > 0, !oracle::HullTwin(points, mesh.triangles).contacts().empty()) << trial;
    } else {
      EXPECT_GT(mesh.contacts(), 0u) << trial;
    }
    mesh.points[v] = mesh.points[other[trial % 3]];
    EXPECT_GT(mesh.contacts(), 0u) << trial;
  }
}

// Narrow triangles around a vertex, in two or three rings, some of whose vertices went past their neighbours or through farther ones:
// whatever touches in exact arithmetic is found, and nothing else.
TEST(self_contact, finds_what_touches_around_a_pole) {
  std::mt19937_64 random(11);
  const auto unit = [&] { return static_cast<double>(random() >> 11) * 0x1p-53; };
  std::size_t touching = 0, reported = 0;
  for (int trial = 0; trial < 120; ++trial) {
    const auto n = static_cast<std::uint32_t>(12 + random() % 90);
    const std::uint32_t rings = 2 + trial % 2;
    Mesh mesh;
    mesh.points.push_back({0, 0, 0.1});
    for (std::uint32_t r = 1; r <= rings; ++r) {
      for (std::uint32_t i = 0; i < n; ++i) {
        // By up to a part of a step round, or, one in ten, by several.
        const double by =
            (trial % 4 == 0 ? 0 : 0.6 * (unit() - 0.5)) + (unit() < 0.02 ? 6 * (unit() - 0.5) : 0.0);
        const double a = 2 * std::numbers::pi * (i + by) / n, radius = 0.3 * r * r / (rings * rings);
        mesh.points.push_back(
            {radius * std::cos(a), radius * std::sin(a), 0.1 - radius * radius + 0.01 * unit()});
        const std::uint32_t j = (i + 1) % n, own = 1 + (r - 1) * n;
        if (r == 1) {
          mesh.triangles.push_back({0, own + i, own + j});
          continue;
        }
        mesh.triangles.push_back({own - n + i, own + i, own + j});
        mesh.triangles.push_back({own - n + i, own + j, own - n + j});
      }
    }
    std::vector<oracle::Point> points;
    for (const Point3& p : mesh.points) points.push_back({p.x, p.y, p.z});
    const auto exact = oracle::HullTwin(points, mesh.triangles).contacts();
    const auto found = self_contacts(mesh.points, mesh.triangles, 1'000'000, 1);
    std::set<std::pair<std::uint32_t, std::uint32_t>> known;
    std::vector<int> of_first(mesh.triangles.size());
    for (const TrianglePair& pair : found) {
      known.insert({pair.a, pair.b});
      ++of_first[pair.a];
    }
    for (const auto& [a, b] : exact) {
      if (of_first[a] >= 16) continue;
      EXPECT_TRUE(known.contains({static_cast<std::uint32_t>(a), static_cast<std::uint32_t>(b)}))
          << trial << ": " << a << ' ' << b;
    }
    touching += exact.size();
    reported += found.size();
  }
  EXPECT_GT(touching, 500u);
  EXPECT_LE(reported, touching);
}

TEST(self_contact, of_neighbours) {
  const std::vector<Point3> fold{{0, 0, 0},     {1, 0, 0},    {0.5, 1, 0},
                                 {0.5, 0.5, 0}, {0.5, -1, 0}, {0.5, 1, 1e-9}};
  EXPECT_EQ((Mesh{fold, {{0, 1, 2}, {1, 0, 3}}}.contacts()), 1u) << "folded onto itself";
  EXPECT_EQ((Mesh{fold, {{0, 1, 2}, {1, 0, 4}}}.contacts()), 0u) << "flat";
  EXPECT_EQ((Mesh{fold, {{0, 1, 2}, {1, 0, 5}}}.contacts()), 0u) << "a narrow angle";
  EXPECT_EQ((Mesh{fold, {{0, 1, 2}, {0, 1, 2}}}.contacts()), 1u) << "twice the same";
  EXPECT_EQ((Mesh{fold, {{0, 1, 2}, {2, 1, 0}}}.contacts()), 1u);
  EXPECT_EQ((Mesh{fold, {{0, 1, 1}}}.contacts()), 1u) << "without area";
  // Two that share a vertex: side by side, crossing, one's edge on the other's.
  const std::vector<Point3> fan{{0, 0, 0},    {1, 0, 0},   {1, 1, 0},   {0.5, 1, 0}, {-1, 0.5, 0},
                                {2, 0.5, -1}, {2, 0.5, 1}, {1, 0.2, 0}, {1, 0.5, 1}};
  EXPECT_EQ((Mesh{fan, {{0, 1, 2}, {0, 3, 4}}}.contacts()), 0u);
  EXPECT_EQ((Mesh{fan, {{0, 1, 2}, {0, 5, 6}}}.contacts()), 1u) << "through it";
  EXPECT_EQ((Mesh{fan, {{0, 1, 2}, {0, 7, 8}}}.contacts()), 1u) << "an edge in it";
}

// On coarse lattices, where most contacts are degenerate: points, planes and edges in common, named by both or not.
TEST(self_contact, is_what_cutting_in_rational_arithmetic_finds) {
  std::mt19937_64 random(8);
  std::map<TriangleContact, int> counts;
  for (int trial = 0; trial < static_cast<int>(testing::fewer(60000)) && !HasFailure(); ++trial) {
    const int steps = 1 + trial % 4;
    std::vector<Point3> points(6);
    for (Point3& p : points) {
      for (std::size_t k = 0; k < 3; ++k) {
        p[k] = static_cast<double>(static_cast<int>(random() % (2 * steps + 1)) - steps) / steps;
        if (trial % 8 == 7) p[k] += 0x1p-50 * static_cast<double>(random() % 3);
      }
    }
    if (trial % 3 == 0) {
      for (Point3& p : points) p.z = 0.5 * p.x;
    }
    const std::size_t common = static_cast<std::size_t>(trial / 4 % 4);
    Names a{0, 1, 2}, b{3, 4, 5};
    for (std::size_t k = 0; k < common; ++k) b[k] = a[(k + trial) % 3];
    std::shuffle(b.begin(), b.end(), random);
    std::vector<oracle::Point> exact;
    for (const Point3& p : points) exact.push_back({p.x, p.y, p.z});
    const auto found = self_contacts(points, std::vector<Names>{a, b}, 3, 1);
    std::vector<TrianglePair> expected;
    if (!oracle::has_area(exact, a)) expected.push_back({0, 0, TriangleContact::collapsed});
    if (!oracle::has_area(exact, b)) expected.push_back({1, 1, TriangleContact::collapsed});
    if (expected.empty()) {
      using oracle::FacetRelation;
      const FacetRelation relation = oracle::relation_of(exact, a, b);
      if (relation != FacetRelation::none) {
        expected.push_back({0, 1,
                            relation == FacetRelation::crossing      ? TriangleContact::crossing
                            : relation == FacetRelation::overlapping ? TriangleContact::overlapping
                                                                     : TriangleContact::touching});
      }
    }
    ASSERT_EQ(found, expected) << trial;
    ++counts[found.empty() ? TriangleContact::none : found[0].contact];
  }
  for (const TriangleContact contact :
       {TriangleContact::none, TriangleContact::crossing, TriangleContact::overlapping,
        TriangleContact::touching, TriangleContact::collapsed}) {
    EXPECT_GT(counts[contact], static_cast<int>(testing::fewer(1500))) << static_cast<int>(contact);
  }
}

// Where parts of products would underflow nothing is said.
// Pairs of which one is wanted, and no others; a fan around a vertex, flat and folded over, has many pairs with a common vertex.
TEST(self_contact, of_some_triangles_are_those_of_all_that_name_one) {
  std::mt19937_64 random(9);
  std::size_t contacts = 0, left_out = 0;
  for (int trial = 0; trial < 60; ++trial) {
    Mesh mesh;
    const auto count = static_cast<std::uint32_t>(4 + random() % 40);
    // Every other time it goes around more than once.
    const double turn = (trial % 2 == 0 ? 1.9 : 2.2) * std::numbers::pi;
    mesh.points.push_back({0, 0, trial % 3 == 0 ? 0 : 0.1});
    for (std::uint32_t k = 0; k <= count; ++k) {
      const double angle = turn * k / count;
      mesh.points.push_back(
          {std::cos(angle), std::sin(angle), trial % 5 == 0 ? 1e-3 * std::sin(5 * angle) : 0});
      if (k > 0) mesh.triangles.push_back({0, k, k + 1});
    }
    std::vector<std::uint8_t> wanted(mesh.triangles.size());
    for (auto& mark : wanted) mark = random() % 3 == 0;
    const auto all = self_contacts(mesh.points, mesh.triangles, 100'000, 1);
    EXPECT_EQ(all.empty(), trial % 2 == 0) << trial;
    std::vector<TrianglePair> expected;
    for (const TrianglePair& pair : all) {
      if (wanted[pair.a] != 0 || wanted[pair.b] != 0) expected.push_back(pair);
    }
    contacts += expected.size();
    left_out += all.size() - expected.size();
    EXPECT_EQ(self_contacts(mesh.points, mesh.triangles, 100'000, 2, {}, wanted), expected) << trial;
  }
  EXPECT_GT(contacts, 50u);
  EXPECT_GT(left_out, 20u);
}

// So many that they are compared part by part: each pair is found as if the two were alone, wherever they lie.
TEST(self_contact, of_many_triangles_are_those_of_each_pair) {
  constexpr std::uint32_t side = 70;  // 9,800 triangles of a sheet
  Mesh mesh;
  for (std::uint32_t j = 0; j <= side; ++j) {
    for (std::uint32_t i = 0; i <= side; ++i) mesh.points.push_back({1.0 * i / side, 1.0 * j / side, 0});
  }
  const auto name = [](std::uint32_t i, std::uint32_t j) { return j * (side + 1) + i; };
  for (std::uint32_t j = 0; j < side; ++j) {
    for (std::uint32_t i = 0; i < side; ++i) {
      mesh.triangles.push_back({name(i, j), name(i + 1, j), name(i, j + 1)});
      mesh.triangles.push_back({name(i + 1, j), name(i + 1, j + 1), name(i, j + 1)});
    }
  }
  const auto sheet = static_cast<std::uint32_t>(mesh.triangles.size());
  std::mt19937_64 random(3);
  const auto unit = [&] { return static_cast<double>(random() >> 11) * 0x1p-53; };
  for (std::uint32_t t = 0; t < 300; ++t) {
    const auto first = static_cast<std::uint32_t>(mesh.points.size());
    const Point3 o{unit(), unit(), 0.01 * (unit() - 0.7)};
    for (int k = 0; k < 3; ++k)
      mesh.points.push_back({o.x + 0.012 * unit(), o.y + 0.012 * unit(), o.z + 0.012 * unit()});
    mesh.triangles.push_back({first, first + 1, first + 2});
  }
  const auto extents = [&](std::uint32_t t) {
    Box3 box;
    for (const std::uint32_t v : mesh.triangles[t]) box.add(mesh.points[v]);
    return box;
  };
  std::vector<TrianglePair> expected;
  for (std::uint32_t b = sheet; b < mesh.triangles.size(); ++b) {
    for (std::uint32_t a = 0; a < b; ++a) {
      const Box3 of_a = extents(a), of_b = extents(b);
      bool near = true;
      for (std::size_t k = 0; k < 3; ++k)
        near = near && of_a.lower[k] <= of_b.upper[k] && of_b.lower[k] <= of_a.upper[k];
      if (!near) continue;
      for (const TrianglePair& pair :
           self_contacts(mesh.points, std::vector<Names>{mesh.triangles[a], mesh.triangles[b]}, 3, 1))
        expected.push_back({a, b, pair.contact});
    }
  }
  std::sort(expected.begin(), expected.end());
  EXPECT_GT(expected.size(), 100u);
  EXPECT_EQ(self_contacts(mesh.points, mesh.triangles, 100'000, 2), expected);
  // Those of the single triangles alone.
  std::vector<std::uint8_t> wanted(mesh.triangles.size());
  std::fill(wanted.begin() + sheet, wanted.end(), std::uint8_t{1});
  EXPECT_EQ(self_contacts(mesh.points, mesh.triangles, 100'000, 1, {}, wanted), expected);
}

// Triangles of a large fan that turns once are not compared with each other. Fans that are open, closed, or go around more than once; flat,
// cones, and with some triangles turned over; two of them with a common rim; beside triangles that pass through them.
TEST(self_contact, of_large_fans_are_those_of_each_pair) {
  std::mt19937_64 random(10);
  const auto unit = [&] { return static_cast<double>(random() >> 11) * 0x1p-53; };
  std::map<std::string, std::size_t> counts;
  for (int trial = 0; trial < 8; ++trial) {
    constexpr std::uint32_t count = 260;
    Mesh mesh;
    const bool closed = trial % 3 == 0, twice = trial % 3 == 1, bent = trial % 2 == 0;
    const double turn = (closed ? 2 : twice ? 2.05 : 1.9) * std::numbers::pi;
    mesh.points.push_back({0, 0, bent ? 0.3 : 0});
    // The other fan is below, or passes through the one.
    mesh.points.push_back(trial % 4 == 0 ? Point3{0.1, 0, -0.4} : Point3{0.9, 0, 0.1});
    for (std::uint32_t k = 0; k <= count; ++k) {
      const double angle = turn * k / count + (trial == 5 && k % 90 == 7 ? 0.1 : 0);
      mesh.points.push_back({std::cos(angle), std::sin(angle), bent ? 0.01 * unit() : 0});
    }
    const auto rim = [&](std::uint32_t k) { return 2 + (closed ? k % count : k); };
    for (std::uint32_t k = 0; k < count; ++k) {
      mesh.triangles.push_back({0, rim(k), rim(k + 1)});
      if (trial % 2 == 0) mesh.triangles.push_back({1, rim(k + 1), rim(k)});
    }
    for (int k = 0; trial % 2 == 1 && k < 3; ++k) {
      const auto first = static_cast<std::uint32_t>(mesh.points.size());
      for (const double z : {-0.2, 0.2, 0.3}) mesh.points.push_back({unit() - 0.5, unit() - 0.5, z});
      mesh.triangles.push_back({first, first + 1, first + 2});
    }
    // Of every seventh pair.
    const auto is_asked = [](std::uint32_t a, std::uint32_t b) { return (a + 3 * b) % 7 == 0; };
    std::vector<TrianglePair> expected, asked;
    for (std::uint32_t a = 0; a < mesh.triangles.size(); ++a) {
      for (std::uint32_t b = a + 1; b < mesh.triangles.size(); ++b) {
        if (!is_asked(a, b)) continue;
        for (const TrianglePair& pair :
             self_contacts(mesh.points, std::vector<Names>{mesh.triangles[a], mesh.triangles[b]}, 3, 1))
          expected.push_back({a, b, pair.contact});
      }
    }
    const auto all = self_contacts(mesh.points, mesh.triangles, 100'000, 2);
    std::copy_if(all.begin(), all.end(), std::back_inserter(asked),
                 [&](const TrianglePair& pair) { return is_asked(pair.a, pair.b); });
    EXPECT_EQ(asked, expected) << trial;
    for (const TrianglePair& pair : expected)
      counts["of two fans"] += pair.a % 2 != pair.b % 2 && trial % 4 == 2;
    counts[twice ? "twice" : closed ? "closed" : "open"] += expected.size();
    counts[expected.empty() ? "clear" : "in contact"] += 1;
  }
  for (const char* name : {"twice", "of two fans", "in contact"}) EXPECT_GT(counts[name], 2u) << name;
}

TEST(self_contact, of_coordinates_too_small_for_exact_signs_is_unknown) {
  const std::vector<Point3> points{{0, 0, 0},     {1, 0, 0}, {0, 1, 0}, {1, 1, 1e-200},
                                   {0.1, 0.1, 0}, {2, 2, 2}, {2, 1, 2}};
  EXPECT_EQ(self_contacts(points, std::vector<Names>{{0, 1, 2}, {1, 3, 2}}, 9, 1),
            (std::vector<TrianglePair>{{0, 1, TriangleContact::unknown}, {1, 1, TriangleContact::unknown}}));
}

}  // namespace
}  // namespace snug::self_contact_test
