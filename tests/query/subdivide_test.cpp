#include <snug/evaluate.h>

#include <gtest/gtest.h>
#include <snug/mesh/validate.h>
#include <support/error.h>
#include <support/point.h>
#include <testing/twins.h>

namespace snug::subdivide_test {
namespace {

TEST(subdivide, quadruples_faces_and_stays_sound) {
  for (const oracle::TwinMesh& twin : testing::assorted_meshes(25)) {
    const ControlMesh mesh = testing::control_mesh(twin);
    const ControlMesh fine = subdivided(mesh, 2, false, {.boundary = testing::rules(twin).boundary});
    EXPECT_EQ(fine.face_count(), 16 * mesh.face_count());
    EXPECT_TRUE(defects(fine).empty());
  }
}

// The limit surface of a refined mesh is that of the mesh: limit positions of old vertices stay.
TEST(subdivide, moves_vertices_to_limits_that_refinement_keeps) {
  const ControlMesh mesh = testing::control_mesh(oracle::meshes::bipyramid(9));
  const ControlMesh coarse = subdivided(mesh, 0, true), fine = subdivided(mesh, 3, true);
  for (std::size_t v = 0; v < mesh.vertex_count(); ++v)
    EXPECT_LT(distance(coarse.points[v], fine.points[v]), 1e-15);
}

TEST(subdivide, leaves_out_faces_without_a_surface) {
  const ControlMesh mesh = testing::control_mesh(oracle::meshes::grid(4, 4));
  const ControlMesh limit = subdivided(mesh, 0, true, {.boundary = BoundaryRule::none});
  EXPECT_EQ(limit.face_count(), 8u);
  EXPECT_EQ(limit.vertex_count(), 9u);
  EXPECT_EQ(subdivided(mesh, 2, true, {.boundary = BoundaryRule::none}).face_count(), 8u * 16);
}

TEST(subdivide, refuses_levels_that_need_more_faces_than_fit) {
  EXPECT_THROW(static_cast<void>(subdivided(testing::control_mesh(oracle::meshes::icosahedron()), 14)),
               InputError);
}

}  // namespace
}  // namespace snug::subdivide_test
