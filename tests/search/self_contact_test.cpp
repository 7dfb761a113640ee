#include <snug/search/self_contact.h>

#include <gtest/gtest.h>
#include <oracle/test_meshes.h>
#include <testing/patches.h>

#include <algorithm>
#include <random>
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
  for (const auto& [a, b] : found) reported[a] = reported[b] = true;
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
    EXPECT_GT(mesh.contacts(), 0u) << trial;
    mesh.points[v] = mesh.points[other[trial % 3]];
    EXPECT_GT(mesh.contacts(), 0u) << trial;
  }
}

TEST(self_contact, of_neighbours) {
  const std::vector<Point3> fold{{0, 0, 0},     {1, 0, 0},    {0.5, 1, 0},
                                 {0.5, 0.5, 0}, {0.5, -1, 0}, {0.5, 1, 1e-9}};
  EXPECT_EQ((Mesh{fold, {{0, 1, 2}, {1, 0, 3}}}.contacts()), 1u) << "folded onto itself";
  EXPECT_EQ((Mesh{fold, {{0, 1, 2}, {1, 0, 4}}}.contacts()), 0u) << "flat";
  EXPECT_EQ((Mesh{fold, {{0, 1, 2}, {1, 0, 5}}}.contacts()), 0u) << "a narrow angle";
  EXPECT_EQ((Mesh{fold, {{0, 1, 2}, {0, 1, 2}}}.contacts()), 1u) << "twice the same";
  EXPECT_EQ((Mesh{fold, {{0, 1, 2}, {2, 1, 0}}}.contacts()), 1u);
  EXPECT_EQ((Mesh{fold, {{0, 1, 1}}}.contacts()), 0u) << "only one triangle";
  // Two that share a vertex: side by side, crossing, one's edge on the other's.
  const std::vector<Point3> fan{{0, 0, 0},    {1, 0, 0},   {1, 1, 0},   {0.5, 1, 0}, {-1, 0.5, 0},
                                {2, 0.5, -1}, {2, 0.5, 1}, {1, 0.2, 0}, {1, 0.5, 1}};
  EXPECT_EQ((Mesh{fan, {{0, 1, 2}, {0, 3, 4}}}.contacts()), 0u);
  EXPECT_EQ((Mesh{fan, {{0, 1, 2}, {0, 5, 6}}}.contacts()), 1u) << "through it";
  EXPECT_EQ((Mesh{fan, {{0, 1, 2}, {0, 7, 8}}}.contacts()), 1u) << "an edge in it";
}

// Against samples: what shows no contact has none.
TEST(self_contact, denies_none) {
  std::mt19937_64 random(8);
  const auto unit = [&] { return static_cast<double>(random() >> 11) * 0x1p-53; };
  int denied = 0;
  for (int trial = 0; trial < 3000; ++trial) {
    std::vector<Point3> points(6);
    for (Point3& p : points) p = {unit(), unit(), unit()};
    const std::size_t common = static_cast<std::size_t>(trial % 3);
    Names a{0, 1, 2}, b{3, 4, 5};
    for (std::size_t k = 0; k < common; ++k) b[k] = a[k];
    if (!self_contacts(points, std::vector<Names>{a, b}, 1, 1).empty()) continue;
    ++denied;
    // Away from common vertices and edges the triangles are on different sides of zero distance.
    double least = INFINITY;
    for (int s = 0; s < 400; ++s) {
      const auto point = [&](const Names& t) {
        double u = unit(), v = unit();
        if (u + v > 1) u = 1 - u, v = 1 - v;
        return points[t[0]] + u * (points[t[1]] - points[t[0]]) + v * (points[t[2]] - points[t[0]]);
      };
      const Point3 x = point(a), y = point(b);
      least = std::min(least, distance(x, y));
    }
    EXPECT_GT(least, 0);
  }
  EXPECT_GT(denied, 1000);
}

}  // namespace
}  // namespace snug::self_contact_test
