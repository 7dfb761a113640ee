#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include <snug/mesh.h>

#include "run_snug.h"

namespace snug::testing::polyhedra_test {
namespace {

// A side that is no double any more: the bounds are, the hull and the longest side are not.
TEST(polyhedra, of_boxes_as_wide_as_doubles_go_are_refused) {
  const std::string mesh = "v -1.7e308 0 0\nv 1.7e308 0 0\nv 0 1.7e308 0\nf 1 2 3\n";
  TemporaryFolder folder;
  const Outcome bounds = run_snug({"bound", "-", "--json"}, mesh);
  EXPECT_EQ(bounds.status, 0) << bounds.err;
  const Outcome solids = run_snug({"bound", "-", "--polyhedra", folder.file("solids.obj")}, mesh);
  EXPECT_EQ(solids.status, 4) << solids.err;
}

// The part of a mesh that belongs to one polyhedron: faces follow one another, and so do their vertices.
struct Part {
  std::vector<FaceId> faces;
};

std::vector<Part> parts(const ControlMesh& mesh) {
  std::vector<Part> result;
  std::uint32_t seen = 0;  // vertices below this belong to parts met so far
  for (std::size_t f = 0; f < mesh.face_count(); ++f) {
    std::uint32_t least = UINT32_MAX, most = 0;
    for (const VertexId v : mesh.face(FaceId(f))) {
      least = std::min(least, v.value());
      most = std::max(most, v.value());
    }
    if (least >= seen) result.emplace_back();
    // Gift wrapping numbers corners in the order of the facets, so a later facet of a part reaches back into
    // it.
    result.back().faces.emplace_back(f);
    seen = std::max(seen, most + 1);
  }
  return result;
}

Vector3 normal(const ControlMesh& mesh, FaceId face) {
  const auto ids = mesh.face(face);
  Vector3 sum;
  for (std::size_t i = 2; i < ids.size(); ++i) {
    sum = sum + cross(mesh.points[ids[i - 1].index()] - mesh.points[ids[0].index()],
                      mesh.points[ids[i].index()] - mesh.points[ids[0].index()]);
  }
  return (1 / length(sum)) * sum;
}

// How far a point lies above the plane of a face.
double height(const ControlMesh& mesh, FaceId face, const Point3& p) {
  return dot(normal(mesh, face), p - mesh.points[mesh.face(face)[0].index()]);
}

std::vector<Point3> box_corners(const nlohmann::json& enclosure) {
  std::vector<Point3> corners;
  for (std::size_t k = 0; k < enclosure["lower"].size(); ++k) {
    for (unsigned i = 0; i < 8; ++i) {
      Point3 p;
      for (std::size_t axis = 0; axis < 3; ++axis)
        p[axis] = enclosure[(i >> axis) & 1 ? "upper" : "lower"][k][axis];
      corners.push_back(p);
    }
  }
  return corners;
}

TEST(polyhedra, contain_the_corners_of_their_boxes) {
  for (const std::string& bounds : {std::string("rows"), std::string("table")}) {
    const TemporaryFolder folder;
    const Outcome outcome = run_snug({"bound", model("head.obj"), "--quiet", "--json", "--bounds", bounds,
                                      "--polyhedra", folder.file("hulls.ply")});
    ASSERT_EQ(outcome.status, 0) << outcome.err;
    const auto enclosures = nlohmann::json::parse(outcome.out)["enclosures"];
    const ControlMesh mesh = read_mesh(folder.file("hulls.ply"));
    const std::vector<Part> solids = parts(mesh);
    ASSERT_EQ(solids.size(), enclosures.size());
    for (std::size_t i = 0; i < solids.size(); ++i) {
      EXPECT_GE(solids[i].faces.size(), 4u);
      for (const Point3& corner : box_corners(enclosures[i])) {
        for (const FaceId face : solids[i].faces) ASSERT_LE(height(mesh, face, corner), 1e-11) << i;
      }
    }
  }
}

TEST(polyhedra, are_the_same_solids_in_every_format) {
  const TemporaryFolder folder;
  std::vector<Box3> boxes;
  std::vector<std::size_t> faces;
  for (const char* name : {"a.obj", "a.off", "a.ply", "a.stl"}) {
    ASSERT_EQ(run_snug({"bound", model("star.obj"), "--quiet", "--polyhedra", folder.file(name)}).status, 0);
    const ControlMesh mesh = read_mesh(folder.file(name));
    boxes.push_back(used_box(mesh));
    faces.push_back(mesh.face_count());
  }
  EXPECT_EQ(boxes[0], boxes[1]);
  EXPECT_EQ(boxes[0], boxes[2]);
  EXPECT_NEAR(boxes[0].upper.x, boxes[3].upper.x, 1e-6);
  EXPECT_EQ(faces[0], faces[2]);
  EXPECT_GT(faces[3], faces[0]);  // triangles
  EXPECT_EQ(run_snug({"bound", model("star.obj"), "--quiet", "--polyhedra", folder.file("a.glb")}).status, 0);
}

TEST(polyhedra, need_a_name_that_can_be_written) {
  EXPECT_EQ(run_snug({"bound", model("star.obj"), "--polyhedra", "-"}).status, 2);
  const Outcome outcome = run_snug({"bound", model("star.obj"), "--polyhedra", "a.xyz"});
  EXPECT_EQ(outcome.status, 3);
  EXPECT_NE(outcome.err.find("a.xyz"), std::string::npos);
}

// A tetrahedron whose last facet is off by a little.
const std::string split_solid =
    "solid\n"
    "facet normal 0 0 0\nouter loop\nvertex 0 0 0\nvertex 0 1 0\nvertex 1 0 0\nendloop\nendfacet\n"
    "facet normal 0 0 0\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 0 1\nendloop\nendfacet\n"
    "facet normal 0 0 0\nouter loop\nvertex 1 0 0\nvertex 0 1 0\nvertex 0 0 1\nendloop\nendfacet\n"
    "facet normal 0 0 0\nouter loop\nvertex 0 1e-6 0\nvertex 1e-6 0 1\nvertex 0 1 1e-6\nendloop\nendfacet\n"
    "endsolid\n";

TEST(stl_files, are_welded_by_the_length_that_is_asked_for) {
  const TemporaryFolder folder;
  const std::string path = folder.file("split.stl");
  std::ofstream(path) << split_solid;
  const auto closed = [&](const std::vector<std::string>& options) {
    std::vector<std::string> arguments{"info", path, "--json", "--quiet"};
    arguments.insert(arguments.end(), options.begin(), options.end());
    return nlohmann::json::parse(run_snug(arguments).out)["closed"].get<bool>();
  };
  EXPECT_FALSE(closed({}));
  EXPECT_FALSE(closed({"--weld", "1e-7"}));
  EXPECT_TRUE(closed({"--weld", "1e-5"}));
  EXPECT_TRUE(closed({"--weld", "0.001%"}));
  EXPECT_EQ(run_snug({"bound", path, "--weld", "near"}).status, 2);
  EXPECT_EQ(run_snug({"bound", path, "--weld", "-1"}).status, 2);
  EXPECT_EQ(run_snug({"bound", path, "--weld", "0"}).status, 0);
  const Outcome tiny = run_snug({"bound", path, "--weld", "1e-20"});
  EXPECT_EQ(tiny.status, 4);
  EXPECT_NE(tiny.err.find("split.stl"), std::string::npos);
  EXPECT_EQ(run_snug({"bound", path, "--weld", "1e-5"}).status, 0);
}

TEST(mesh_formats, are_read_and_written_by_subdivide) {
  const TemporaryFolder folder;
  for (const char* ending : {"obj", "off", "ply", "stl"}) {
    const std::string once = folder.file(std::string("once.") + ending);
    ASSERT_EQ(run_snug({"subdivide", model("star.obj"), "--quiet", "-o", once}).status, 0) << ending;
    const auto facts = nlohmann::json::parse(run_snug({"info", once, "--json"}).out);
    EXPECT_EQ(facts["vertices"], 14 + 36) << ending;
    EXPECT_EQ(facts["faces"], 4 * 24) << ending;
    EXPECT_EQ(facts["closed"], true) << ending;
  }
  const Outcome glb = run_snug({"subdivide", model("star.obj"), "-o", folder.file("once.glb")});
  EXPECT_EQ(glb.status, 0);
  EXPECT_NE(glb.err.find("single precision"), std::string::npos) << glb.err;
}

}  // namespace
}  // namespace snug::testing::polyhedra_test
