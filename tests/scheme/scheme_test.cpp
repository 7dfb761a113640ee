#include <snug/scheme/scheme.h>

#include <gtest/gtest.h>
#include <support/error.h>
#include <testing/twins.h>

namespace snug::scheme_test {
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
  for (const std::uint32_t n : {3u, 512u}) {
    EXPECT_EQ(refusal(testing::control_mesh(oracle::meshes::bipyramid(n))), "");
  }
}

TEST(require_subdividable, refuses_valences_out_of_range) {
  EXPECT_NE(
      refusal(testing::control_mesh(oracle::meshes::bipyramid(513))).find("interior vertex 0 has 513 faces"),
      std::string::npos);
}

TEST(require_subdividable, takes_polygons_but_for_loop) {
  ControlMesh quad;
  quad.points = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}};
  const VertexId corners[4] = {VertexId(0), VertexId(1), VertexId(2), VertexId(3)};
  quad.add_face(corners);
  EXPECT_NE(refusal(quad, {Scheme::loop, BoundaryRule::edge_only}).find("face 0 has 4 vertices"),
            std::string::npos);
  for (const Scheme scheme : {Scheme::catmark, Scheme::doo_sabin, Scheme::midedge}) {
    EXPECT_EQ(refusal(quad, {scheme, BoundaryRule::edge_only}), "");
  }
  EXPECT_EQ(natural_scheme(quad), Scheme::catmark);
}

TEST(require_subdividable, takes_non_manifold_meshes_but_for_dual_schemes) {
  ControlMesh book = testing::control_mesh(oracle::meshes::grid(2, 2));
  book.points.push_back({0, 0, 1});
  for (const std::uint32_t v : {8u, 9u}) book.add_face(std::array{VertexId(0), VertexId(1), VertexId(v)});
  EXPECT_EQ(refusal(book), "");
  EXPECT_EQ(refusal(book, {Scheme::catmark}), "");
  EXPECT_NE(refusal(book, {Scheme::doo_sabin}).find("edge (0, 1)"), std::string::npos);
  EXPECT_NE(refusal(book, {Scheme::midedge}).find("an oriented manifold mesh is needed"), std::string::npos);
}

TEST(require_surface, refuses_faces_that_name_a_vertex_twice) {
  ControlMesh mesh = testing::control_mesh(oracle::meshes::octahedron());
  mesh.add_face(std::array{VertexId(0), VertexId(1), VertexId(1)});
  for (const Scheme scheme : {Scheme::loop, Scheme::catmark}) {
    EXPECT_EQ(refusal(mesh, {scheme}), "");
    EXPECT_THROW(require_surface(mesh, {scheme}), InputError);
  }
  EXPECT_NE(refusal(mesh, {Scheme::doo_sabin}), "");
}

// Two triangles with the same corners share two edges, and their children all of what lies between these: no
// edge of three faces, but two edges.
TEST(require_subdividable, refuses_duplicate_faces_of_loop_and_dual_schemes) {
  for (const bool turned : {false, true}) {
    ControlMesh mesh = testing::control_mesh(oracle::meshes::octahedron());
    const auto face = mesh.face(FaceId(0));
    mesh.add_face(std::array{face[0], face[turned ? 2 : 1], face[turned ? 1 : 2]});
    EXPECT_EQ(refusal(mesh, {Scheme::loop}), "face 8 has the same vertices as face 0; mend these elements");
    EXPECT_EQ(refusal(mesh, {Scheme::catmark}), "");
    EXPECT_NE(refusal(mesh, {Scheme::midedge}).find("has the same vertices"), std::string::npos);
  }
}

TEST(require_subdividable, refuses_faces_that_are_too_large) {
  const auto polygon = [](std::size_t size) {
    ControlMesh mesh;
    std::vector<VertexId> face;
    for (std::size_t i = 0; i < size; ++i) {
      mesh.points.push_back({static_cast<double>(i), 0, 0});
      face.emplace_back(i);
    }
    mesh.add_face(face);
    return mesh;
  };
  for (const auto& [scheme, most] : {std::pair{Scheme::catmark, 512u},
                                     {Scheme::doo_sabin, 360u},
                                     {Scheme::midedge, 360u},
                                     {Scheme::bilinear, 1000u}}) {
    EXPECT_EQ(refusal(polygon(most), {scheme}), "");
    EXPECT_EQ(refusal(polygon(most + 1), {scheme}), "face 0 has " + std::to_string(most + 1) +
                                                        " vertices; at most " + std::to_string(most) +
                                                        " are taken: split it");
  }
}

}  // namespace
}  // namespace snug::scheme_test
