#include <snug/mesh/statistics.h>

#include <gtest/gtest.h>
#include <testing/twins.h>

namespace snug {
namespace {

TEST(statistics, of_an_icosahedron) {
  const MeshStatistics s = statistics(testing::control_mesh(oracle::meshes::icosahedron()), 6);
  EXPECT_EQ(s.edges, 30u);
  EXPECT_TRUE(s.closed);
  EXPECT_EQ(s.components, 1u);
  EXPECT_EQ(s.min_valence, 5u);
  EXPECT_EQ(s.max_valence, 5u);
  EXPECT_EQ(s.extraordinary, 12u);
}

TEST(statistics, of_a_grid_count_its_boundary) {
  const MeshStatistics s = statistics(testing::control_mesh(oracle::meshes::grid(4, 3)), 6);
  EXPECT_FALSE(s.closed);
  EXPECT_EQ(s.boundary_edges, 14u);
  EXPECT_EQ(s.extraordinary, 4u);  // the corners: two have 2 edges, two have 3
}

TEST(statistics, of_nothing_are_zero) {
  const MeshStatistics s = statistics(ControlMesh{}, 6);
  EXPECT_EQ(s.edges, 0u);
  EXPECT_FALSE(s.closed);
}

TEST(statistics, pass_over_faces_with_vertices_that_are_not_there) {
  ControlMesh mesh;
  mesh.points.resize(3);
  const VertexId good[3] = {VertexId(0), VertexId(1), VertexId(2)},
                 bad[3] = {VertexId(0), VertexId(1), VertexId(9)};
  mesh.add_face(good);
  mesh.add_face(bad);
  EXPECT_EQ(statistics(mesh, 6).edges, 3u);
}

}  // namespace
}  // namespace snug
