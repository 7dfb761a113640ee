#include <snug/mesh/validate.h>

#include <gtest/gtest.h>
#include <snug/mesh/topology.h>
#include <testing/counts.h>
#include <testing/twins.h>

#include <initializer_list>
#include <random>
#include <string>

namespace snug::validate_test {
namespace {

ControlMesh mesh_of(std::size_t points, std::initializer_list<std::initializer_list<std::size_t>> faces) {
  ControlMesh mesh;
  for (std::size_t i = 0; i < points; ++i) {
    const double t = static_cast<double>(i);
    mesh.points.push_back({t, t * t, t * t * t});
  }
  for (const auto& face : faces) {
    std::vector<VertexId> corners;
    for (const std::size_t v : face) corners.emplace_back(v);
    mesh.add_face(corners);
  }
  return mesh;
}

bool has(const ControlMesh& mesh, DefectKind kind) {
  for (const Defect& defect : defects(mesh)) {
    if (defect.kind == kind) return true;
  }
  return false;
}

TEST(defects, are_none_on_sound_meshes) {
  for (const oracle::TwinMesh& twin : testing::assorted_meshes(5)) {
    EXPECT_TRUE(defects(testing::control_mesh(twin)).empty())
        << summary(defects(testing::control_mesh(twin)));
  }
}

TEST(defects, name_each_fault_by_its_elements) {
  EXPECT_TRUE(has(mesh_of(3, {{0, 1, 5}}), DefectKind::index_out_of_range));
  EXPECT_TRUE(has(mesh_of(3, {{0, 1}}), DefectKind::too_few_vertices));
  EXPECT_TRUE(has(mesh_of(4, {{0, 1, 1}}), DefectKind::repeated_vertex));
  EXPECT_TRUE(has(mesh_of(3, {{0, 1, 2}, {1, 2, 0}}), DefectKind::duplicate_face));
  EXPECT_TRUE(has(mesh_of(5, {{0, 1, 2}, {1, 0, 3}, {0, 1, 4}}), DefectKind::edge_of_many_faces));
  EXPECT_TRUE(has(mesh_of(4, {{0, 1, 2}, {0, 1, 3}}), DefectKind::inconsistent_orientation));
  EXPECT_TRUE(has(mesh_of(5, {{0, 1, 2}, {0, 3, 4}}), DefectKind::pinched_vertex));
  EXPECT_TRUE(has(mesh_of(4, {{0, 1, 2}}), DefectKind::isolated_vertex));
  const auto list = defects(mesh_of(5, {{0, 1, 2}, {1, 0, 3}, {0, 1, 4}}));
  ASSERT_FALSE(list.empty());
  EXPECT_EQ(list[0].text, "edge (0, 1) has 3 faces: 0, 1, 2");
}

TEST(defects, see_faces_without_area_and_coordinates_that_are_not_finite) {
  ControlMesh flat = mesh_of(3, {{0, 1, 2}});
  flat.points[2] = flat.points[1];
  EXPECT_TRUE(has(flat, DefectKind::zero_area_face));
  flat.points[2].y = NAN;
  EXPECT_TRUE(has(flat, DefectKind::coordinate_not_finite));
  ControlMesh tiny = mesh_of(3, {{0, 1, 2}});
  for (Point3& p : tiny.points) p = {p.x * 1e-300, p.y * 1e-300, p.z * 1e-300};
  EXPECT_FALSE(has(tiny, DefectKind::zero_area_face));
}

TEST(defects, see_bad_tags) {
  ControlMesh mesh = mesh_of(3, {{0, 1, 2}});
  mesh.tags.creases.push_back({VertexId(0), VertexId(7), 1.0});
  EXPECT_TRUE(has(mesh, DefectKind::bad_tag));
  mesh.tags.creases = {{VertexId(0), VertexId(1), NAN}};
  EXPECT_TRUE(has(mesh, DefectKind::bad_tag));
  mesh.tags = {};
  mesh.tags.holes.push_back(FaceId(3));
  EXPECT_TRUE(has(mesh, DefectKind::bad_tag));
}

// Reports of neighbours are left out only where the topology has none: random soups of few vertices, many of them
// manifold by accident, folded, with faces twice.
TEST(defects_of_elements, are_all_but_legal_ones_of_a_manifold_mesh) {
  std::mt19937_64 random(41);
  const auto serious = [](const std::vector<Defect>& all) {
    std::vector<std::string> texts;
    for (const Defect& defect : all) {
      if (!is_legal(defect.kind)) texts.push_back(defect.text);
    }
    return texts;
  };
  std::uint64_t manifold = 0, faulty = 0, twice = 0;
  for (int trial = 0; trial < static_cast<int>(testing::fewer(40'000)); ++trial) {
    const std::size_t points = 3 + random() % 6;
    ControlMesh mesh = mesh_of(points, {});
    for (std::size_t faces = 1 + random() % 6; faces > 0; --faces) {
      std::vector<VertexId> corners;
      for (std::size_t n = trial % 2 == 0 ? 3 : 3 + random() % 3; n > 0; --n)
        corners.emplace_back(random() % points);
      mesh.add_face(corners);
    }
    const std::vector<std::string> all = serious(defects(mesh));
    faulty += !all.empty();
    const Topology topology(mesh);
    if (!topology.is_manifold()) continue;
    ++manifold;
    ASSERT_EQ(all, serious(defects_of_elements(mesh, topology))) << trial;
    twice += topology.uniform_size() == 3 && !all.empty();
  }
  EXPECT_GT(manifold, testing::fewer(1000));
  EXPECT_GT(faulty, testing::fewer(1000));
  EXPECT_GT(twice, testing::fewer(30));
}

TEST(summary, lists_ten_and_counts_the_rest) {
  const std::string text = summary(defects(mesh_of(30, {{0, 1, 2}})));
  EXPECT_NE(text.find("and 17 more"), std::string::npos) << text;
}

}  // namespace
}  // namespace snug::validate_test
