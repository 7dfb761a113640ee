#include <snug/mesh/weld.h>

#include <cmath>
#include <numeric>
#include <random>
#include <vector>

#include <gtest/gtest.h>
#include <snug/mesh/topology.h>
#include <snug/mesh/validate.h>
#include <support/error.h>
#include <testing/six_sheets.h>

namespace snug::weld_test {
namespace {

using testing::six_sheets;
using Numbers = std::vector<std::uint32_t>;

/// The rule as it is written, in quadratic time.
Numbers slow_first_of_welded(const std::vector<Point3>& points, double distance) {
  Numbers first(points.size());
  std::iota(first.begin(), first.end(), 0);
  for (bool changed = true; changed;) {
    changed = false;
    for (std::size_t i = 0; i < points.size(); ++i) {
      for (std::size_t j = 0; j < points.size(); ++j) {
        const Vector3 between = points[i] - points[j];
        const bool near = points[i] == points[j] || std::hypot(between.x, between.y, between.z) <= distance;
        if (near && first[i] < first[j]) {
          first[j] = first[i];
          changed = true;
        }
      }
    }
  }
  return first;
}

TEST(weld, equal_points_become_the_first_of_them) {
  EXPECT_EQ(first_of_welded(
                std::vector<Point3>{{1, 2, 3}, {1, 2, 4}, {1, 2, 3}, {0, 0, 0}, {-0.0, 0, -0.0}, {1, 2, 3}}),
            (Numbers{0, 1, 0, 3, 3, 0}));
  EXPECT_EQ(first_of_welded({}), Numbers{});
}

TEST(weld, no_distance_welds_nothing_that_differs) {
  EXPECT_EQ(first_of_welded(
                std::vector<Point3>{{0, 0, 0}, {5e-324, 0, 0}, {1, 0, 0}, {std::nextafter(1, 2), 0, 0}}),
            (Numbers{0, 1, 2, 3}));
}

TEST(weld, chains_of_near_points_become_one) {
  EXPECT_EQ(first_of_welded(std::vector<Point3>{{9, 0, 0}, {0, 0, 0}, {2, 0, 0}, {1, 0, 0}, {3.5, 0, 0}}, 1),
            (Numbers{0, 1, 1, 1, 4}));
}

TEST(weld, the_distance_itself_still_welds) {
  EXPECT_EQ(first_of_welded(std::vector<Point3>{{0, 0, 0}, {3, 4, 0}}, 5), (Numbers{0, 0}));
  EXPECT_EQ(first_of_welded(std::vector<Point3>{{0, 0, 0}, {3, 4, 0}}, std::nextafter(5, 0)),
            (Numbers{0, 1}));
}

TEST(weld, cells_are_neither_too_large_nor_too_small) {
  // The far corners of a cube whose diagonal is longer than the distance; then pairs that lie just within it.
  EXPECT_EQ(first_of_welded(std::vector<Point3>{{0, 0, 0}, {0.59, 0.59, 0.59}}, 1), (Numbers{0, 1}));
  for (int i = 0; i < 1000; ++i) {
    const double x = 1e-3 * i;
    EXPECT_EQ(first_of_welded(std::vector<Point3>{{x, 0, 0}, {x + 0.999, 0, 0}}, 1), (Numbers{0, 0})) << x;
  }
}

TEST(weld, agrees_with_the_rule_on_random_and_on_aligned_points) {
  std::mt19937 random(3);
  for (int trial = 0; trial < 400; ++trial) {
    std::vector<Point3> points(60);
    const bool aligned = trial % 2 == 0;
    const int cells = 2 + trial % 11;
    for (Point3& point : points) {
      for (std::size_t axis = 0; axis < 3; ++axis) {
        const double x = std::uniform_real_distribution<double>(-cells, cells)(random);
        point[axis] = aligned ? std::round(x) : x;
      }
    }
    for (const double distance : {0.5, 1.0, 1.5}) {
      ASSERT_EQ(first_of_welded(points, distance), slow_first_of_welded(points, distance)) << trial;
    }
  }
}

TEST(weld, distances_beneath_the_grid_of_coordinates_are_refused) {
  for (const double distance : {1e-9, 5e-324}) {
    try {
      static_cast<void>(first_of_welded(std::vector<Point3>{{1e6, 0, 0}, {0, 0, 0}}, distance));
      ADD_FAILURE();
    } catch (const InputError& error) {
      EXPECT_EQ(error.problem(), InputProblem::refused);
    }
  }
  EXPECT_EQ(first_of_welded(std::vector<Point3>{{1e308, 0, 0}, {-1e308, 0, 0}}, 1e308), (Numbers{0, 1}));
}

ControlMesh mesh_of(std::vector<Point3> points, const std::vector<std::vector<std::uint32_t>>& faces) {
  ControlMesh mesh;
  mesh.points = std::move(points);
  for (const auto& face : faces) {
    std::vector<VertexId> ids;
    for (const std::uint32_t v : face) ids.emplace_back(v);
    mesh.add_face(ids);
  }
  return mesh;
}

Numbers corners(const ControlMesh& mesh, std::size_t face) {
  Numbers ids;
  for (const VertexId v : mesh.face(FaceId(face))) ids.push_back(v.value());
  return ids;
}

TEST(welded_mesh, six_sheets_become_a_cube) {
  for (const double gap : {0.0, 1e-7}) {
    ControlMesh mesh = six_sheets(gap);
    const WeldReport welded = weld(mesh, 3 * gap);
    EXPECT_EQ(welded.vertices, 16u);
    EXPECT_NEAR(welded.farthest, gap * std::sqrt(2.0), 1e-9);
    EXPECT_EQ(welded.dropped + welded.shortened, 0u);
    EXPECT_EQ(mesh.vertex_count(), 8u);
    EXPECT_EQ(mesh.face_count(), 6u);
    const Topology topology(mesh);
    EXPECT_EQ(topology.edge_count(), 12u);
    for (std::size_t e = 0; e < 12; ++e) EXPECT_FALSE(topology.on_boundary(EdgeId(e))) << e;
    EXPECT_TRUE(defects(mesh).empty());
  }
}

TEST(welded_mesh, without_a_distance_keeps_near_vertices_apart) {
  ControlMesh mesh = six_sheets(1e-15);
  EXPECT_EQ(weld(mesh).vertices, 0u);
  EXPECT_EQ(mesh.vertex_count(), 24u);
}

TEST(welded_mesh, faces_lose_corners_and_those_with_fewer_than_three_go) {
  //            2 and 3 are one; 4 and 0 are one
  ControlMesh mesh = mesh_of({{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {1, 1, 0}, {0, 0, 0}, {0, 1, 0}},
                             {{0, 1, 2, 3}, {2, 3, 5}, {0, 1, 4, 5}, {5, 0, 1}, {0, 2, 4, 3}, {3, 1, 2}});
  mesh.tags.holes = {FaceId(0), FaceId(1), FaceId(3)};
  const WeldReport welded = weld(mesh);
  EXPECT_EQ(welded.vertices, 2u);
  EXPECT_EQ(welded.shortened, 1u);
  EXPECT_EQ(welded.dropped, 3u);  // (2, 3, 5), (0, 2, 4, 3) and (3, 1, 2)
  ASSERT_EQ(mesh.face_count(), 3u);
  EXPECT_EQ(corners(mesh, 0), (Numbers{0, 1, 2}));
  EXPECT_EQ(corners(mesh, 1), (Numbers{0, 1, 0, 3}));  // names vertex 0 twice, not in a row
  EXPECT_EQ(corners(mesh, 2), (Numbers{3, 0, 1}));
  EXPECT_EQ(mesh.tags.holes, (std::vector<FaceId>{FaceId(0), FaceId(2)}));
}

TEST(welded_mesh, creases_and_corners_stay_and_the_sharpest_counts) {
  ControlMesh mesh = six_sheets(0);
  const auto at = [&](const Point3& p) {
    std::vector<VertexId> found;
    for (std::size_t v = 0; v < mesh.vertex_count(); ++v) {
      if (mesh.points[v] == p) found.emplace_back(v);
    }
    return found;
  };
  const auto origin = at({0, 0, 0});
  ASSERT_EQ(origin.size(), 3u);
  mesh.tags.corners = {{origin[2], 1}, {origin[2], 7}, {origin[1], 2}, {at({1, 1, 1})[1], 3}};
  // The edge from (0, 0, 0) to (1, 0, 0) lies in two sheets; the later tag of one of them counts there.
  std::vector<CreaseTag> edges;
  for (std::size_t f = 0; f < mesh.face_count(); ++f) {
    const auto face = mesh.face(FaceId(f));
    for (std::size_t k = 0; k < 4; ++k) {
      const VertexId a = face[k], b = face[(k + 1) % 4];
      const Point3 p = mesh.points[a.index()], q = mesh.points[b.index()];
      if (p.y == 0 && p.z == 0 && q.y == 0 && q.z == 0) edges.push_back({a, b, 0});
    }
  }
  ASSERT_EQ(edges.size(), 2u);
  mesh.tags.creases = {{edges[0].a, edges[0].b, 9}, {edges[1].b, edges[1].a, 4}, {edges[0].b, edges[0].a, 1}};
  mesh.tags.boundary = BoundaryRule::edge_only;
  weld(mesh);
  ASSERT_EQ(mesh.tags.creases.size(), 1u);
  EXPECT_EQ(mesh.tags.creases[0].sharpness, 4);
  ASSERT_EQ(mesh.tags.corners.size(), 2u);
  EXPECT_EQ(mesh.tags.corners[0].sharpness, 7);
  EXPECT_EQ(mesh.points[mesh.tags.corners[0].vertex.index()], Point3{});
  EXPECT_EQ(mesh.points[mesh.tags.corners[1].vertex.index()], (Point3{1, 1, 1}));
  EXPECT_EQ(mesh.tags.boundary, BoundaryRule::edge_only);
}

TEST(welded_mesh, creases_and_polylines_that_collapse) {
  ControlMesh mesh = mesh_of({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 0}}, {{0, 1, 2}});
  mesh.tags.creases = {{VertexId(0), VertexId(3), 5}, {VertexId(3), VertexId(1), 6}};
  mesh.add_polyline(std::vector<VertexId>{VertexId(0), VertexId(1), VertexId(2), VertexId(3)});
  weld(mesh);
  ASSERT_EQ(mesh.tags.creases.size(), 1u);
  EXPECT_EQ(mesh.tags.creases[0].sharpness, 6);
  EXPECT_EQ(mesh.polyline(PolylineId(0)).front(), mesh.polyline(PolylineId(0)).back());
  EXPECT_EQ(mesh.polyline(PolylineId(0)).size(), 4u);
}

TEST(welded_mesh, a_bad_distance_is_an_error_and_changes_nothing) {
  ControlMesh mesh = six_sheets(0);
  for (const double distance : {-1.0, static_cast<double>(NAN), static_cast<double>(INFINITY), 1e-300}) {
    EXPECT_THROW(weld(mesh, distance), InputError) << distance;
  }
  EXPECT_EQ(mesh.vertex_count(), 24u);
  mesh.points[3].x = NAN;
  EXPECT_THROW(weld(mesh), InputError);
}

}  // namespace
}  // namespace snug::weld_test
