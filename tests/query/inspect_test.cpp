#include <snug/inspect.h>

#include <array>
#include <cmath>
#include <optional>
#include <set>

#include <gtest/gtest.h>
#include <oracle/tagged_shapes.h>
#include <testing/six_sheets.h>
#include <testing/tagged.h>
#include <testing/twins.h>

namespace snug::inspect_test {
namespace {

using testing::six_sheets;

TEST(mesh_counts, of_an_icosahedron) {
  const MeshCounts s = count_elements(testing::control_mesh(oracle::meshes::icosahedron()), Scheme::loop);
  EXPECT_EQ(s.edges, 30u);
  EXPECT_TRUE(s.closed);
  EXPECT_EQ(s.components, 1u);
  EXPECT_EQ(s.min_valence, 5u);
  EXPECT_EQ(s.max_valence, 5u);
  EXPECT_EQ(s.extraordinary, 12u);
}

TEST(mesh_counts, of_a_grid_count_its_boundary) {
  const MeshCounts s = count_elements(testing::control_mesh(oracle::meshes::grid(4, 3)), Scheme::loop);
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
      const MeshCounts s = count_elements(mesh, Scheme::loop);
      EXPECT_EQ(s.components, 3u);
      EXPECT_EQ(s.boxes_meet, x <= 1 && y <= 1) << x << ' ' << y;
    }
  }
}

TEST(mesh_counts, of_many_components_with_coordinates_that_are_no_numbers_pass_these_over) {
  ControlMesh mesh;
  for (std::size_t k = 0; k < 40; ++k) {
    const double x = k % 3 == 0 ? std::nan("") : 3.0 * static_cast<double>(40 - k);
    for (const Point3& p : {Point3{x, 0, 0}, Point3{x + 1, 0, 0}, Point3{x, 1, 1}}) mesh.points.push_back(p);
    mesh.add_face(std::array{VertexId(3 * k), VertexId(3 * k + 1), VertexId(3 * k + 2)});
  }
  EXPECT_EQ(count_elements(mesh, Scheme::loop).components, 40u);
  EXPECT_FALSE(count_elements(mesh, Scheme::loop).boxes_meet);
  mesh.points[4].x = -500;
  EXPECT_TRUE(count_elements(mesh, Scheme::loop).boxes_meet);
}

TEST(mesh_counts, of_nothing_are_zero) {
  const MeshCounts s = count_elements(ControlMesh{}, Scheme::loop);
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
  EXPECT_EQ(count_elements(mesh, Scheme::loop).edges, 3u);
  // Nor do such without any.
  mesh.add_face({});
  EXPECT_EQ(count_elements(mesh, Scheme::loop).edges, 3u);
  ControlMesh none;
  for (int k = 0; k < 2; ++k) none.add_face({});
  EXPECT_EQ(count_elements(none, Scheme::loop).needles, 0u);
  EXPECT_EQ(defects(none)[0].kind, DefectKind::too_few_vertices);
  EXPECT_EQ(coincidences(none).vertices, 0u);
}

TEST(mesh_counts, know_edges_of_many_faces_creases_and_what_is_extraordinary_for_the_scheme) {
  ControlMesh mesh = testing::control_mesh(oracle::meshes::cube());
  EXPECT_EQ(count_elements(mesh, Scheme::catmark).extraordinary, 8u);    // vertices of valence 3
  EXPECT_EQ(count_elements(mesh, Scheme::doo_sabin).extraordinary, 0u);  // all faces are quads
  EXPECT_EQ(
      count_elements(testing::control_mesh(oracle::meshes::icosahedron()), Scheme::doo_sabin).extraordinary,
      20u);
  mesh.tags.creases = {{mesh.face(FaceId(0))[0], mesh.face(FaceId(0))[1], 2.0},
                       {mesh.face(FaceId(0))[0], mesh.face(FaceId(0))[2], 2.0}};  // a diagonal is no edge
  EXPECT_EQ(count_elements(mesh, Scheme::catmark).creases, 1u);
  EXPECT_EQ(count_elements(mesh, Scheme::catmark).many_sided_edges, 0u);
  mesh.points.push_back({5, 5, 5});
  mesh.add_face(std::array{mesh.face(FaceId(0))[0], mesh.face(FaceId(0))[1], VertexId(8)});
  EXPECT_EQ(count_elements(mesh, Scheme::catmark).many_sided_edges, 1u);
}

TEST(defects, are_named_and_each_scheme_says_which_it_answers) {
  ControlMesh mesh = testing::control_mesh(oracle::meshes::icosahedron());
  EXPECT_TRUE(defects(mesh).empty());
  mesh.add_face(mesh.face(FaceId(0)));
  const std::vector<Defect> found = defects(mesh);
  ASSERT_FALSE(found.empty());
  EXPECT_STREQ(name_of(found[0].kind), "duplicate-face");
  EXPECT_NE(found[0].text.find("20"), std::string::npos) << found[0].text;
  EXPECT_TRUE(scheme_answers(Scheme::catmark, DefectKind::duplicate_face));
  EXPECT_FALSE(scheme_answers(Scheme::loop, DefectKind::duplicate_face));
  EXPECT_TRUE(scheme_answers(Scheme::midedge, DefectKind::zero_area_face));
  EXPECT_FALSE(scheme_answers(Scheme::midedge, DefectKind::pinched_vertex));
}

TEST(topologies, are_shared_by_patches_that_are_alike_and_none_of_polynomials) {
  const Surface ball(testing::control_mesh(oracle::meshes::icosahedron()), {.scheme = Scheme::loop});
  std::set<std::optional<std::uint32_t>> found;
  for (std::uint32_t f = 0; f < 20; ++f) found.insert(topology_of(ball, {f, 0}));
  EXPECT_EQ(found.size(), 1u);
  EXPECT_TRUE(found.begin()->has_value());
  const Surface flat(testing::control_mesh(oracle::meshes::icosahedron()), {.scheme = Scheme::flat});
  EXPECT_EQ(topology_of(flat, {3, 0}), std::nullopt);
  EXPECT_THROW(static_cast<void>(topology_of(ball, {20, 0})), InputError);
  EXPECT_THROW(static_cast<void>(topology_of(ball, {0, 1})), InputError);
  const Surface cube(testing::control_mesh(oracle::meshes::cube()), {.scheme = Scheme::catmark});
  for (std::uint32_t part = 0; part < 2; ++part) EXPECT_TRUE(topology_of(cube, {5, part}));
  EXPECT_THROW(static_cast<void>(topology_of(cube, {5, 2})), InputError);
  const Surface dual(testing::control_mesh(oracle::meshes::grid(4, 4)), {.scheme = Scheme::doo_sabin});
  EXPECT_THROW(static_cast<void>(topology_of(dual, {0, 0})), InputError);  // a vertex of the boundary
  ControlMesh mesh = testing::control_mesh(oracle::meshes::icosahedron());
  mesh.tags.holes.emplace_back(std::size_t{7});
  EXPECT_THROW(static_cast<void>(topology_of(Surface(mesh, {.scheme = Scheme::loop}), {7, 0})), InputError);
}

TEST(smoothing_notes, are_of_loop_surfaces_without_tags) {
  const ControlMesh mesh = testing::control_mesh(oracle::meshes::icosahedron());
  EXPECT_NE(smoothing_note(Surface(mesh, {.scheme = Scheme::loop}), "--way").find("--way flat"),
            std::string::npos);
  EXPECT_EQ(smoothing_note(Surface(mesh, {.scheme = Scheme::loop}), "--way", 0.0), "");
  for (const Scheme scheme : {Scheme::catmark, Scheme::flat, Scheme::midedge})
    EXPECT_EQ(smoothing_note(Surface(mesh, {.scheme = scheme}), "--way"), "") << name_of(scheme);
}

TEST(overlapping_shells, are_those_in_another_one_that_is_turned_alike) {
  ControlMesh mesh = testing::control_mesh(oracle::meshes::icosahedron());
  const ControlMesh outer = mesh;
  for (const Point3& p : outer.points) mesh.points.push_back(Point3{} + 0.25 * (p - Point3{}));
  ControlMesh cavity = mesh;
  for (std::size_t f = 0; f < outer.face_count(); ++f) {
    const auto corner = [&](std::size_t k) {
      return VertexId(outer.face(FaceId(f))[k].index() + outer.points.size());
    };
    mesh.add_face(std::array{corner(0), corner(1), corner(2)});
    cavity.add_face(std::array{corner(0), corner(2), corner(1)});
  }
  EXPECT_TRUE(overlapping_shell(Surface(mesh, {.scheme = Scheme::loop})));
  EXPECT_FALSE(overlapping_shell(Surface(cavity, {.scheme = Scheme::loop})));
  EXPECT_FALSE(overlapping_shell(Surface(outer, {.scheme = Scheme::loop})));
  EXPECT_THROW(static_cast<void>(overlapping_shell(
                   Surface(testing::control_mesh(oracle::meshes::grid(4, 3)), {.scheme = Scheme::loop}))),
               InputError);
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

// Two squares in a row beside one as long as both: the vertex between the two stands on its edge.
TEST(coincidences, of_vertices_on_edges) {
  const auto sheets = [](double off) {
    ControlMesh mesh;
    mesh.points = {{0, 0, 0},   {2, 0, 0},   {2, 1, 0},  {0, 1, 0},  {0, off, 0},
                   {1, off, 0}, {2, off, 0}, {0, -1, 0}, {1, -1, 0}, {2, -1, 0}};
    for (const auto& face : {std::array{0, 1, 2, 3}, std::array{7, 8, 5, 4}, std::array{8, 9, 6, 5}}) {
      std::array<VertexId, 4> vertices;
      for (std::size_t k = 0; k < 4; ++k) vertices[k] = VertexId(static_cast<std::size_t>(face[k]));
      mesh.add_face(vertices);
    }
    return mesh;
  };
  EXPECT_EQ(coincidences(sheets(0)).on_edges, 1u);
  EXPECT_EQ(coincidences(sheets(-1e-6)).on_edges, 1u);
  EXPECT_EQ(coincidences(sheets(-1e-3)).on_edges, 0u);
  // Hardly beside an end of the edge it is near that vertex, and not on the edge.
  ControlMesh beside_end = sheets(0);
  beside_end.points[5] = {1e-7, 0, 0};
  EXPECT_EQ(coincidences(beside_end).on_edges, 0u);
  const MeshCounts counts = count_elements(sheets(0), Scheme::catmark);
  EXPECT_EQ(counts.borders, 2u);
  EXPECT_EQ(counts.boundary_edges, 10u);
}

TEST(count_elements, tells_needles_from_faces_of_no_area) {
  const auto count = [](double height) {
    ControlMesh mesh;
    mesh.points = {{0, 0, 0}, {1, 0, 0}, {0.3, height, 0}};
    mesh.add_face(std::array{VertexId(0), VertexId(1), VertexId(2)});
    return count_elements(mesh, Scheme::loop).needles;
  };
  EXPECT_EQ(count(0.02), 0u);
  EXPECT_EQ(count(0.009), 1u);
  EXPECT_EQ(count(1e-100), 1u);
  EXPECT_EQ(count(0), 0u);
}

}  // namespace
}  // namespace snug::inspect_test
