#include <snug/io/obj_tags.h>

#include <string>
#include <vector>

#include <snug/io/formats.h>

#include <testing/files.h>

namespace snug::obj_tags_test {
namespace {

using testing::unreadable;

const std::string cube =
    "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 1 1 0\nv 0 0 1\nv 1 0 1\nv 0 1 1\nv 1 1 1\n"
    "f 1 3 4 2\nf 5 6 8 7\nf 1 2 6 5\nf 3 7 8 4\nf 1 5 7 3\nf 2 4 8 6\n";

MeshTags parse(const std::string& tags, const Notes& notes = {}) {
  return parse_obj(cube + tags, "mesh.obj", notes).tags;
}
std::string message(const std::string& tags) {
  return unreadable([&] { static_cast<void>(parse(tags)); });
}

struct Crease {
  std::uint32_t a, b;
  double sharpness;
  friend bool operator==(const Crease&, const Crease&) = default;
};

std::vector<Crease> creases(const MeshTags& tags) {
  std::vector<Crease> list;
  for (const CreaseTag& tag : tags.creases) list.push_back({tag.a.value(), tag.b.value(), tag.sharpness});
  return list;
}

TEST(obj_tags, a_crease_is_a_chain_that_counts_from_zero) {
  const MeshTags tags =
      parse("t crease 2/1/0 0 1 2.5\nt crease 4/1/0 1 3 2 0 3\nt crease 3/2/0 4 5 7 10 0.25\n");
  EXPECT_EQ(creases(tags),
            (std::vector<Crease>{{0, 1, 2.5}, {1, 3, 3}, {3, 2, 3}, {2, 0, 3}, {4, 5, 10}, {5, 7, 0.25}}));
}

TEST(obj_tags, corners_have_one_sharpness_or_one_each) {
  const MeshTags tags = parse("t corner 2/1/0 6 7 3\nt corner 2/2/0 0 1 1 2\n");
  ASSERT_EQ(tags.corners.size(), 4u);
  EXPECT_EQ(tags.corners[1].vertex, VertexId(7));
  EXPECT_EQ(tags.corners[1].sharpness, 3.0);
  EXPECT_EQ(tags.corners[3].sharpness, 2.0);
}

TEST(obj_tags, holes_count_faces_from_zero) {
  EXPECT_EQ(parse("t hole 2/0/0 0 5\n").holes, (std::vector{FaceId(0), FaceId(5)}));
}

TEST(obj_tags, rules_are_those_of_the_file_format) {
  EXPECT_FALSE(parse("").boundary.has_value());
  EXPECT_EQ(parse("t interpolateboundary 1/0/0 0\n").boundary, BoundaryRule::none);
  EXPECT_EQ(parse("t interpolateboundary 1/0/0 1\n").boundary, BoundaryRule::edge_and_corner);
  EXPECT_EQ(parse("t interpolateboundary 1/0/0 2\n").boundary, BoundaryRule::edge_only);
  EXPECT_EQ(parse("t creasemethod 0/0/1 chaikin\n").crease_method, CreaseMethod::chaikin);
  EXPECT_EQ(parse("t creasemethod 0/0/1 chaikin\nt creasemethod 0/0/1 normal\n").crease_method,
            CreaseMethod::uniform);
  EXPECT_EQ(parse("t smoothtriangles 0/0/1 smooth\n").smooth_triangles, SmoothTriangles::smooth);
  EXPECT_EQ(parse("t smoothtriangles 0/0/1 catmark\n").smooth_triangles, SmoothTriangles::catmark);
  EXPECT_FALSE(parse("").scheme.has_value());
  EXPECT_EQ(parse("t scheme 0/0/1 bilinear\n").scheme, Scheme::bilinear);
}

TEST(obj_tags, what_changes_the_surface_is_not_ignored_in_silence) {
  std::vector<std::string> lines;
  const MeshTags tags = parse(
      "t facevaryinginterpolateboundary 1/0/0 1\nt vertexedit 1/1/1 0 0.5 add\nt vertexedit 1/1/1 1 0.5 add\n"
      "t faceedit 1/0/1 0 hole\n",
      [&](const std::string& line) { lines.push_back(line); });
  EXPECT_TRUE(tags.creases.empty());
  EXPECT_EQ(lines, (std::vector<std::string>{
                       "mesh.obj:16: tag 'vertexedit' is ignored: the surface is the one without it",
                       "mesh.obj:18: tag 'faceedit' is ignored: the surface is the one without it"}));
}

TEST(obj_tags, written_tags_are_read_again) {
  ControlMesh mesh = parse_obj(cube, "mesh.obj");
  mesh.tags.creases = {
      {VertexId(0), VertexId(1), 0.1}, {VertexId(3), VertexId(2), 1e300}, {VertexId(1), VertexId(3), 0}};
  mesh.tags.corners = {{VertexId(7), 10}, {VertexId(0), 5e-324}};
  mesh.tags.holes = {FaceId(3), FaceId(0)};
  mesh.tags.crease_method = CreaseMethod::chaikin;
  mesh.tags.smooth_triangles = SmoothTriangles::smooth;
  for (const BoundaryRule rule :
       {BoundaryRule::none, BoundaryRule::edge_only, BoundaryRule::edge_and_corner}) {
    mesh.tags.boundary = rule;
    const MeshTags again = parse_obj(format_obj(mesh), "again").tags;
    EXPECT_EQ(again.boundary, rule);
    EXPECT_EQ(creases(again), creases(mesh.tags));
    ASSERT_EQ(again.corners.size(), 2u);
    EXPECT_EQ(again.corners[1].vertex, VertexId(0));
    EXPECT_EQ(again.corners[1].sharpness, 5e-324);
    EXPECT_EQ(again.holes, mesh.tags.holes);
    EXPECT_EQ(again.crease_method, CreaseMethod::chaikin);
    EXPECT_EQ(again.smooth_triangles, SmoothTriangles::smooth);
  }
}

TEST(obj_tags, a_crease_is_written_with_one_sharpness) {
  std::string text;
  MeshTags tags;
  tags.creases = {{VertexId(4), VertexId(9), 2.5}};
  append_obj_tags(text, tags);
  EXPECT_EQ(text, "t crease 2/1/0 4 9 2.5\n");
}

TEST(obj_tags, bad_values_are_named) {
  EXPECT_EQ(message("\nt crease 2/1/0 0 8 1\nt crease 2/1/0 0 7 1\n"),
            "mesh.obj:16: tag: vertex 8 does not exist: tags count from 0 to 7 here");
  EXPECT_EQ(message("t hole 1/0/0 6\n"),
            "mesh.obj:15: tag: face 6 does not exist: tags count from 0 to 5 here");
  EXPECT_EQ(message("t corner 1/1/0 0 NaN\n"), "mesh.obj:15: tag: sharpness 'NaN' is not a finite number");
  EXPECT_EQ(message("t corner 1/1/0 0 -1\n"), "mesh.obj:15: tag: sharpness '-1' is negative");
  EXPECT_EQ(message("t corner 1/1/0 -1 1\n"), "mesh.obj:15: tag: index -1 is negative: tags count from 0");
}

TEST(obj_tags, wrong_numbers_of_values_are_refused) {
  for (const char* tag :
       {"crease", "crease 2/1", "crease -2/1/0 0 1 1", "crease 2/1/0 0 1", "crease 2/1/0 0 1 1 1",
        "crease 1/1/0 0 1", "crease 3/3/0 0 1 3 1 1 1", "corner 0/1/0 1", "corner 1/0/0 0",
        "interpolateboundary 0/0/0", "creasemethod 0/0/0", "smoothtriangles 1/0/0 2"}) {
    EXPECT_NE(message(std::string("t ") + tag + '\n').find("mesh.obj:15: tag"), std::string::npos) << tag;
  }
}

}  // namespace
}  // namespace snug::obj_tags_test
