#include <snug/mesh.h>

#include <algorithm>
#include <optional>
#include <random>
#include <set>
#include <utility>

#include <gtest/gtest.h>
#include <snug/mesh/topology.h>
#include <snug/mesh/validate.h>
#include <support/error.h>
#include <testing/cad_parts.h>

namespace snug::sharpen_test {
namespace {

using Edge = std::pair<std::uint32_t, std::uint32_t>;

std::set<Edge> creases(const ControlMesh& mesh) {
  std::set<Edge> edges;
  for (const CreaseTag& tag : mesh.tags.creases) {
    if (tag.sharpness >= infinite_sharpness) edges.insert(std::minmax({tag.a.value(), tag.b.value()}));
  }
  return edges;
}

std::set<std::uint32_t> corners(const ControlMesh& mesh) {
  std::set<std::uint32_t> ids;
  for (const CornerTag& tag : mesh.tags.corners) ids.insert(tag.vertex.value());
  return ids;
}

std::size_t edge_count(const ControlMesh& mesh) { return Topology(mesh).edge_count(); }

/// A closed tube: `rows` rows of `sides` quads between two caps of one face each.
ControlMesh tube(std::size_t sides, std::size_t rows) {
  ControlMesh mesh;
  std::vector<testing::Ids> rings;
  for (std::size_t r = 0; r <= rows; ++r) {
    rings.push_back(testing::add_ring(mesh, testing::circle(0, 0, 1, sides), static_cast<double>(r)));
  }
  testing::add_caps(mesh, rings.front(), rings.back(), false, 0);
  for (std::size_t r = 0; r < rows; ++r) testing::add_wall(mesh, rings[r], rings[r + 1], false);
  return mesh;
}

TEST(sharpen, makes_every_edge_of_a_box_sharp) {
  for (const bool triangles : {false, true}) {
    ControlMesh mesh = testing::box({0, 0, 0}, {40, 20, 10}, triangles);
    const SharpenReport done = sharpen(mesh);
    EXPECT_EQ(done.creases, triangles ? 18u : 12u);
    EXPECT_EQ(creases(mesh).size(), edge_count(mesh));
    EXPECT_EQ(done.flat_regions, 6u);
    EXPECT_EQ(done.corners, 0u);  // three sharp edges meet at each vertex
  }
}

TEST(sharpen, keeps_smooth_what_turns_less_than_the_angle) {
  ControlMesh mesh = tube(24, 3);  // 15 degrees an edge
  const SharpenReport done = sharpen(mesh);
  EXPECT_EQ(done.creases, 48u);  // the rims
  EXPECT_EQ(done.corners, 48u);  // of flat caps, which are kept as polygons
  EXPECT_EQ(done.flat_regions, 2u);
  EXPECT_EQ(done.fixed_regions, 0u);
  ControlMesh again = tube(24, 3);
  EXPECT_EQ(sharpen(again, 14).creases, 48u + 24u * 3u + 48u);  // every facet is one of flat quads now
}

TEST(sharpen, keeps_a_wall_without_inner_vertices_facet_by_facet) {
  ControlMesh mesh = tube(24, 1);
  const SharpenReport done = sharpen(mesh);
  EXPECT_EQ(done.fixed_regions, 1u);
  EXPECT_EQ(creases(mesh).size(), edge_count(mesh));
}

TEST(sharpen, compares_the_angle_itself) {
  ControlMesh above = tube(24, 3), below = tube(24, 3);  // 15 degrees
  EXPECT_EQ(sharpen(below, 15 + 1e-9).creases, 48u);
  EXPECT_EQ(sharpen(above, 15 - 1e-9).creases, edge_count(above));
}

TEST(sharpen, makes_corners_where_a_crease_turns_and_leaves_darts_smooth) {
  ControlMesh mesh = tube(40, 4);
  mesh.tags.creases = {
      {VertexId(40), VertexId(41), 10}, {VertexId(41), VertexId(81), 10}, {VertexId(81), VertexId(121), 10}};
  sharpen(mesh);
  EXPECT_TRUE(corners(mesh).contains(41));   // the crease turns by a right angle
  EXPECT_FALSE(corners(mesh).contains(81));  // it goes straight on
  EXPECT_FALSE(corners(mesh).contains(40));  // it ends
  EXPECT_FALSE(corners(mesh).contains(121));
}

TEST(sharpen, splits_flat_faces_that_are_not_convex) {
  ControlMesh mesh = testing::l_prism(false);
  ASSERT_EQ(mesh.face_count(), 8u);
  const SharpenReport done = sharpen(mesh);
  EXPECT_EQ(done.split_faces, 2u);
  EXPECT_EQ(mesh.face_count(), 8u + 6u);
  EXPECT_EQ(done.parts_of,
            (std::vector<FaceId>{FaceId(0), FaceId(0), FaceId(0), FaceId(1), FaceId(1), FaceId(1)}));
  EXPECT_EQ(mesh.face(FaceId(2)).size(), 4u);
  EXPECT_TRUE(defects(mesh).empty());
  EXPECT_EQ(creases(mesh).size(), edge_count(mesh));
}

TEST(sharpen, does_not_split_holes_and_names_faces_that_cross_themselves) {
  ControlMesh mesh = testing::l_prism(false);
  mesh.tags.holes = {FaceId(0)};
  EXPECT_EQ(sharpen(mesh).split_faces, 1u);
  ControlMesh bow;
  bow.points = {{0, 0, 0}, {2, 3, 0}, {2, 0, 0}, {0, 2, 0}};
  testing::add_face(bow, {0, 1, 2, 3});
  const SharpenReport done = sharpen(bow);
  EXPECT_EQ(done.split_faces, 0u);
  EXPECT_EQ(done.crossed_faces, 1u);
}

TEST(sharpen, turns_a_face_with_a_bridge_to_its_hole_into_triangles) {
  ControlMesh mesh;
  mesh.points = {{0, 0, 0}, {6, 0, 0}, {6, 6, 0}, {0, 6, 0}, {2, 2, 0}, {2, 4, 0}, {4, 4, 0}, {4, 2, 0}};
  testing::add_face(mesh, {0, 1, 2, 3, 0, 4, 5, 6, 7, 4});
  EXPECT_EQ(sharpen(mesh).split_faces, 1u);
  EXPECT_EQ(mesh.face_count(), 8u);
  EXPECT_TRUE(defects(mesh).empty());
  EXPECT_EQ(creases(mesh).size(), 8u);  // all but the boundary, which is sharp by rule
}

TEST(sharpen, adds_to_tags_and_overrides_weaker_ones_only) {
  ControlMesh mesh = testing::box({0, 0, 0}, {1, 1, 1}, false);
  mesh.tags.creases = {
      {VertexId(0), VertexId(1), 2}, {VertexId(1), VertexId(2), 10}, {VertexId(4), VertexId(6), 3}};
  mesh.tags.corners = {{VertexId(0), 4}};
  mesh.tags.boundary = BoundaryRule::edge_only;
  EXPECT_EQ(sharpen(mesh).creases, 11u);
  EXPECT_EQ(mesh.tags.creases[0].sharpness, 2);
  EXPECT_EQ(mesh.tags.creases.size(), 14u);
  EXPECT_EQ(mesh.tags.corners[0].sharpness, 4);
  EXPECT_EQ(mesh.tags.boundary, BoundaryRule::edge_only);
  EXPECT_EQ(sharpen(mesh).creases, 0u);
}

TEST(sharpen, sees_flat_regions_through_the_rounding_of_long_thin_triangles) {
  std::mt19937_64 random(5);
  for (int trial = 0; trial < 60; ++trial) {
    const double shift = trial % 3 == 0 ? 0 : trial % 3 == 1 ? 300 : 5000;
    const bool tall = trial % 2 == 0;
    ControlMesh mesh = tall ? testing::perforated_plate(3, 2, 20, 5.2, 8, 96)
                            : testing::pin(5, 0, 60, 400, true);  // fans of 398 triangles, 0.08 across
    mesh = testing::turned(std::move(mesh), random, true, shift);
    const SharpenReport done = sharpen(mesh);
    if (shift < 5000) {  // there, rounding is wider than three neighbours on a rim are high
      EXPECT_EQ(done.flat_regions, tall ? 6u : 2u) << trial;
      EXPECT_EQ(done.fixed_regions, tall ? 6u : 1u) << trial;
    }
    EXPECT_EQ(creases(mesh).size(), edge_count(mesh)) << trial;
  }
}

/// The mesh with a triangle of hardly any width along the edge from a to b of one face, whose other side it
/// takes.
ControlMesh with_narrow_face(const ControlMesh& mesh, std::uint32_t a, std::uint32_t b) {
  ControlMesh result;
  result.points = mesh.points;
  const auto middle = static_cast<std::uint32_t>(mesh.points.size());
  const Point3 p = mesh.points[a], q = mesh.points[b];
  result.points.push_back({(p.x + q.x) / 2 + 1e-8, (p.y + q.y) / 2 + 2e-8, (p.z + q.z) / 2 + 1e-8});
  for (std::size_t f = 0; f < mesh.face_count(); ++f) {
    testing::Ids ids;
    for (const VertexId v : mesh.face(FaceId(f))) ids.push_back(v.value());
    for (std::size_t k = 0; k < ids.size(); ++k) {
      if (ids[k] != a || ids[(k + 1) % ids.size()] != b) continue;
      ids.insert(ids.begin() + static_cast<std::ptrdiff_t>(k) + 1, middle);
      break;
    }
    testing::add_face(result, ids);
  }
  testing::add_face(result, {a, b, middle});
  return result;
}

TEST(sharpen, looks_through_faces_without_a_width) {
  // In a smooth wall nothing becomes sharp for it.
  const ControlMesh wall = tube(48, 4);
  ControlMesh plain = wall, narrow = with_narrow_face(wall, 2 * 48, 2 * 48 + 1);
  ASSERT_EQ(Topology(narrow).is_manifold(), true);
  sharpen(plain);
  sharpen(narrow);
  EXPECT_EQ(creases(narrow), creases(plain));
  // Between two faces of a box it does not join them, whatever its normal.
  ControlMesh box = with_narrow_face(testing::box({0, 0, 0}, {1, 1, 1}, false), 0, 1);
  const SharpenReport done = sharpen(box, 50);
  EXPECT_EQ(done.flat_regions, 7u);
  EXPECT_EQ(creases(box).size(), edge_count(box));
}

TEST(sharpen, takes_what_is_not_manifold_or_not_oriented) {
  std::mt19937_64 random(6);
  for (int trial = 0; trial < 200; ++trial) {
    ControlMesh mesh = testing::l_prism(trial % 2 == 0);
    ControlMesh broken;
    broken.points = mesh.points;
    for (std::size_t f = 0; f < mesh.face_count(); ++f) {
      testing::Ids ids;
      for (const VertexId v : mesh.face(FaceId(f))) ids.push_back(v.value());
      if (random() % 8 == 0) std::reverse(ids.begin(), ids.end());
      if (random() % 10 == 0) testing::add_face(broken, ids);
      if (random() % 12 == 0) ids[1] = ids[0];
      if (random() % 12 == 0) ids[2] = static_cast<std::uint32_t>(random() % broken.points.size());
      testing::add_face(broken, ids);
    }
    EXPECT_NO_THROW(sharpen(broken, std::uniform_real_distribution<double>(0, 90)(random)));
  }
}

TEST(sharpen, leaves_meshes_that_no_question_takes_as_they_are) {
  ControlMesh mesh = testing::box({0, 0, 0}, {1, 1, 1}, false);
  mesh.face_vertices[3] = VertexId(99);
  EXPECT_EQ(sharpen(mesh).creases, 0u);
  mesh = testing::box({0, 0, 0}, {1, 1, 1}, false);
  mesh.points[2].y = NAN;
  EXPECT_EQ(sharpen(mesh).creases, 0u);
  mesh = ControlMesh{};
  EXPECT_EQ(sharpen(mesh).creases, 0u);
  mesh.points.resize(3);
  testing::add_face(mesh, {0, 1, 2});  // all in one point
  EXPECT_NO_THROW(sharpen(mesh));
}

TEST(sharpen, does_not_depend_on_the_size_of_coordinates) {
  for (const int exponent : {-1060, -500, 500, 1010}) {
    ControlMesh mesh = testing::l_prism(true);
    for (Point3& p : mesh.points)
      p = {std::ldexp(p.x, exponent), std::ldexp(p.y, exponent), std::ldexp(p.z, exponent)};
    EXPECT_EQ(sharpen(mesh).flat_regions, 8u) << exponent;
    EXPECT_EQ(creases(mesh).size(), edge_count(mesh)) << exponent;
  }
}

TEST(sharpen, takes_facets_as_a_control_mesh) {
  const auto scheme_after = [](bool triangles, std::optional<Scheme> before, double angle) {
    ControlMesh mesh = testing::box({0, 0, 0}, {40, 20, 10}, triangles);
    mesh.tags.scheme = before;
    sharpen(mesh, angle);
    return mesh.tags.scheme;
  };
  for (const double angle : {30.0, 179.0}) {  // at 179 degrees nothing is sharp
    EXPECT_EQ(scheme_after(true, Scheme::flat, angle), Scheme::loop);
    EXPECT_EQ(scheme_after(true, {}, angle), Scheme::loop);
    EXPECT_EQ(scheme_after(true, Scheme::catmark, angle), Scheme::catmark);
    EXPECT_EQ(scheme_after(false, Scheme::flat, angle), std::nullopt);
    EXPECT_EQ(scheme_after(false, {}, angle), std::nullopt);
  }
}

TEST(sharpen, refuses_angles_that_are_none) {
  ControlMesh mesh = testing::l_prism(true);
  for (const double angle : {-1.0, 180.0, static_cast<double>(NAN), static_cast<double>(INFINITY)}) {
    EXPECT_THROW(sharpen(mesh, angle), InputError) << angle;
  }
}

}  // namespace
}  // namespace snug::sharpen_test
