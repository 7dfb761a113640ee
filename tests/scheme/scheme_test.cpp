#include <snug/scheme/scheme.h>

#include <gtest/gtest.h>
#include <snug/base/error.h>
#include <testing/twins.h>

namespace snug {
namespace {

std::string refusal(const ControlMesh& mesh, const SchemeOptions& options = {}) {
  try {
    require_subdividable(mesh, options);
  } catch (const InputError& error) {
    EXPECT_EQ(error.problem(), InputProblem::refused);
    return error.what();
  }
  return "";
}

TEST(require_subdividable, accepts_every_manifold_triangle_mesh) {
  for (const oracle::TwinMesh& twin : testing::assorted_meshes(9)) {
    EXPECT_EQ(refusal(testing::control_mesh(twin), testing::rules(twin)), "");
  }
  for (const std::uint32_t n : {3u, 1000u}) {
    EXPECT_EQ(refusal(testing::control_mesh(oracle::meshes::bipyramid(n))), "");
  }
}

TEST(require_subdividable, refuses_valences_out_of_range) {
  EXPECT_NE(refusal(testing::control_mesh(oracle::meshes::bipyramid(1001)))
                .find("interior vertex 0 has 1001 faces"),
            std::string::npos);
}

TEST(require_subdividable, refuses_polygons_and_other_schemes) {
  ControlMesh quad;
  quad.points = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}};
  const VertexId corners[4] = {VertexId(0), VertexId(1), VertexId(2), VertexId(3)};
  quad.add_face(corners);
  EXPECT_NE(refusal(quad, {Scheme::loop, BoundaryRule::edge_only}).find("face 0 has 4 vertices"),
            std::string::npos);
  EXPECT_NE(refusal(quad, {Scheme::catmark, BoundaryRule::edge_only}).find("not supported yet"),
            std::string::npos);
  EXPECT_EQ(natural_scheme(quad), Scheme::catmark);
}

TEST(require_subdividable, refuses_only_tags_that_change_the_surface) {
  ControlMesh mesh = testing::control_mesh(oracle::meshes::grid(2, 2));
  mesh.tags.creases = {{VertexId(0), VertexId(1), 10}, {VertexId(4), VertexId(8), 0}};  // boundary; zero
  mesh.tags.corners = {{VertexId(2), 10}, {VertexId(4), 0}};
  // Of the four corners of this grid two have one face; vertex 2 is one of them.
  EXPECT_EQ(refusal(mesh), "");
  EXPECT_NE(refusal(mesh, {Scheme::loop, BoundaryRule::edge_only}).find("vertex 2 is tagged"),
            std::string::npos);
  mesh.tags.creases[1].sharpness = 0.5;
  EXPECT_NE(refusal(mesh).find("edge (4, 8)"), std::string::npos);
  mesh.tags.creases.clear();
  mesh.tags.holes = {FaceId(1)};
  EXPECT_NE(refusal(mesh).find("face 1 is tagged as a hole"), std::string::npos);
}

}  // namespace
}  // namespace snug
