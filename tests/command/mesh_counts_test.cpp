#include <apps/snug/mesh_counts.h>

#include <cmath>

#include <gtest/gtest.h>
#include <testing/six_sheets.h>
#include <testing/twins.h>

namespace snug::command::mesh_counts_test {
namespace {

using testing::six_sheets;

TEST(mesh_counts, of_an_icosahedron) {
  const MeshCounts s = count_elements(testing::control_mesh(oracle::meshes::icosahedron()), 6);
  EXPECT_EQ(s.edges, 30u);
  EXPECT_TRUE(s.closed);
  EXPECT_EQ(s.components, 1u);
  EXPECT_EQ(s.min_valence, 5u);
  EXPECT_EQ(s.max_valence, 5u);
  EXPECT_EQ(s.extraordinary, 12u);
}

TEST(mesh_counts, of_a_grid_count_its_boundary) {
  const MeshCounts s = count_elements(testing::control_mesh(oracle::meshes::grid(4, 3)), 6);
  EXPECT_FALSE(s.closed);
  EXPECT_EQ(s.boundary_edges, 14u);
  EXPECT_EQ(s.extraordinary, 4u);  // the corners: two have 2 edges, two have 3
}

TEST(mesh_counts, know_whether_the_boxes_of_components_meet) {
  for (const double x : {0.5, 1.0, 1.25}) {
    for (const double y : {0.0, 1.25}) {
      ControlMesh mesh;
      for (const Vector3& at : {Vector3{0, 0, 0}, Vector3{x, y, 0}, Vector3{-9, 0, 0}}) {
        const std::size_t first = mesh.points.size();
        for (const Point3& p : {Point3{0, 0, 0}, Point3{1, 0, 0}, Point3{0, 1, 1}})
          mesh.points.push_back(p + at);
        mesh.add_face(std::array{VertexId(first), VertexId(first + 1), VertexId(first + 2)});
      }
      mesh.points.push_back({x, y, 0});  // of no face
      const MeshCounts s = count_elements(mesh, 6);
      EXPECT_EQ(s.components, 3u);
      EXPECT_EQ(s.boxes_meet, x <= 1 && y <= 1) << x << ' ' << y;
    }
  }
}

TEST(mesh_counts, of_nothing_are_zero) {
  const MeshCounts s = count_elements(ControlMesh{}, 6);
  EXPECT_EQ(s.edges, 0u);
  EXPECT_FALSE(s.closed);
}

TEST(mesh_counts, pass_over_faces_with_vertices_that_are_not_there) {
  ControlMesh mesh;
  mesh.points.resize(3);
  const VertexId good[3] = {VertexId(0), VertexId(1), VertexId(2)},
                 bad[3] = {VertexId(0), VertexId(1), VertexId(9)};
  mesh.add_face(good);
  mesh.add_face(bad);
  EXPECT_EQ(count_elements(mesh, 6).edges, 3u);
}

TEST(coincidences, of_six_sheets) {
  const Coincidences exact = coincidences(six_sheets(0));
  EXPECT_EQ(exact.vertices, 24u);
  EXPECT_EQ(exact.places, 8u);
  EXPECT_EQ(exact.edges, 24u);
  EXPECT_EQ(exact.near, 0u);
  const Coincidences near = coincidences(six_sheets(1e-7));
  EXPECT_EQ(near.vertices, 0u);
  EXPECT_EQ(near.near, 16u);
  EXPECT_NEAR(near.nearest, 1e-7 * std::sqrt(2.0), 1e-14);
  EXPECT_NEAR(near.farthest, 1e-7 * std::sqrt(2.0), 1e-14);
  const Coincidences apart = coincidences(six_sheets(1e-3));
  EXPECT_EQ(apart.vertices + apart.near, 0u);
}

TEST(coincidences, a_closed_mesh_with_distinct_vertices_and_one_that_is_broken_have_none) {
  ControlMesh mesh = six_sheets(0);
  weld(mesh);
  mesh.points.push_back(mesh.points[0]);  // no face uses it
  EXPECT_EQ(coincidences(mesh).vertices, 0u);
  EXPECT_EQ(coincidences(mesh).near, 0u);
  mesh = six_sheets(0);
  mesh.face_vertices[5] = VertexId(99);
  EXPECT_EQ(coincidences(mesh).vertices, 0u);
  EXPECT_EQ(coincidences(ControlMesh{}).vertices, 0u);
}

}  // namespace
}  // namespace snug::command::mesh_counts_test
