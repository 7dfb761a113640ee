#include <snug/mesh/primitives.h>

#include <cmath>
#include <map>
#include <random>

#include <gtest/gtest.h>

namespace snug::primitives_test {
namespace {

using Long = long double;
struct LongVector {
  Long x, y, z;
};
LongVector from(const Point3& a, const Point3& b) {
  return {Long{b.x} - a.x, Long{b.y} - a.y, Long{b.z} - a.z};
}
Long product(const LongVector& a, const LongVector& b) { return a.x * b.x + a.y * b.y + a.z * b.z; }

struct Facet {
  LongVector normal;  // of length 1, outwards
  Long height;        // of its plane over the origin
};
Facet facet(const ControlMesh& mesh, std::size_t f) {
  const auto face = mesh.face(FaceId(f));
  const Point3 &a = mesh.points[face[0].index()], &b = mesh.points[face[1].index()],
               &c = mesh.points[face[2].index()];
  const LongVector u = from(a, b), v = from(a, c);
  LongVector n{u.y * v.z - u.z * v.y, u.z * v.x - u.x * v.z, u.x * v.y - u.y * v.x};
  const Long size = std::sqrt(product(n, n));
  n = {n.x / size, n.y / size, n.z / size};
  return {n, product(n, from({0, 0, 0}, a))};
}

// Each edge belongs to two facets, which turn against each other.
void expect_closed(const ControlMesh& mesh) {
  std::map<std::pair<std::uint32_t, std::uint32_t>, int> edges;
  for (std::size_t f = 0; f < mesh.face_count(); ++f) {
    const auto face = mesh.face(FaceId(f));
    ASSERT_EQ(face.size(), 3u);
    for (std::size_t k = 0; k < 3; ++k) ++edges[{face[k].value(), face[(k + 1) % 3].value()}];
  }
  for (const auto& [edge, count] : edges) {
    EXPECT_EQ(count, 1);
    EXPECT_EQ(edges.count({edge.second, edge.first}), 1u);
  }
}

TEST(primitives, boxes_are_exact_and_face_outwards) {
  const ControlMesh mesh = box_mesh({1, 2, 3});
  expect_closed(mesh);
  EXPECT_EQ(mesh.face_count(), 12u);
  Long volume = 0;
  for (std::size_t f = 0; f < 12; ++f) {
    const Facet own = facet(mesh, f);
    EXPECT_GT(own.height, 0);
    const auto face = mesh.face(FaceId(f));
    const LongVector u = from(mesh.points[face[0].index()], mesh.points[face[1].index()]),
                     v = from(mesh.points[face[0].index()], mesh.points[face[2].index()]);
    const LongVector n{u.y * v.z - u.z * v.y, u.z * v.x - u.x * v.z, u.x * v.y - u.y * v.x};
    volume += std::sqrt(product(n, n)) * own.height / 6;
  }
  EXPECT_EQ(static_cast<double>(volume), 6);
}

TEST(primitives, spheres_are_inside_and_no_farther_than_they_say) {
  std::mt19937_64 random(1);
  for (const double error : {0.3, 0.05, 0.01, 2e-3, 5e-4}) {
    const double radius = std::exp2(static_cast<double>(random() % 40) - 20) * 1.1;
    const OuterMesh sphere = sphere_mesh(radius, error);
    expect_closed(sphere.mesh);
    for (std::size_t f = 0; f < sphere.mesh.face_count(); ++f)
      ASSERT_GE(facet(sphere.mesh, f).height, Long{radius});
    Long farthest = 0;
    for (const Point3& p : sphere.mesh.points) {
      const LongVector v = from({0, 0, 0}, p);
      farthest = std::max(farthest, std::sqrt(product(v, v)));
    }
    EXPECT_LE(farthest - radius, Long{sphere.outward});
    EXPECT_LE(sphere.outward, error * radius);
    EXPECT_GT(farthest - radius, 0.99L * sphere.outward);
  }
}

TEST(primitives, cylinders_are_inside_and_no_farther_than_they_say) {
  std::mt19937_64 random(2);
  for (const double error : {0.3, 0.05, 0.01, 1e-3, 1e-5}) {
    const double radius = std::exp2(static_cast<double>(random() % 40) - 20) * 1.1, length = radius * 3.3;
    const OuterMesh cylinder = cylinder_mesh(radius, length, error);
    expect_closed(cylinder.mesh);
    for (std::size_t f = 0; f < cylinder.mesh.face_count(); ++f) {
      const Facet own = facet(cylinder.mesh, f);
      const bool cap = std::fabs(own.normal.z) > 0.5L;
      ASSERT_GE(own.height, cap ? Long{length} / 2 : Long{radius});
      EXPECT_TRUE(cap || std::fabs(own.normal.z) < 1e-15L) << own.normal.z;
    }
    Long farthest = 0;
    for (const Point3& p : cylinder.mesh.points) {
      EXPECT_EQ(std::fabs(p.z), length / 2);
      farthest = std::max(farthest, std::sqrt(Long{p.x} * p.x + Long{p.y} * p.y));
    }
    EXPECT_LE(farthest - radius, Long{cylinder.outward});
    EXPECT_LE(cylinder.outward, error * radius);
  }
}

}  // namespace
}  // namespace snug::primitives_test
