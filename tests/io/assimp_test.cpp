// Files that Assimp reads: what becomes of them where the library has it (SNUG_ASSIMP), and the sentence where it has not.

#include <snug/io/formats.h>
#include <snug/mesh.h>

#include <gtest/gtest.h>
#include <testing/files.h>

namespace snug::assimp_test {
namespace {

// Two nodes with one mesh: a quad, or two triangles with corners of their own; the second one is mirrored. In centimetres.
std::string collada(bool triangles) {
  const std::string points = triangles ? "0 0 0 1 0 0 1 1 0 0 0 0 1 1 0 0 1 0" : "0 0 0 1 0 0 1 1 0 0 1 0",
                    count = triangles ? "6" : "4", coordinates = triangles ? "18" : "12",
                    counts = triangles ? "3 3" : "4", indices = triangles ? "0 1 2 3 4 5" : "0 1 2 3";
  return R"(<?xml version="1.0"?>
<COLLADA xmlns="http://www.collada.org/2005/11/COLLADASchema" version="1.4.1">
<asset><unit name="centimeter" meter="0.01"/><up_axis>Z_UP</up_axis></asset>
<library_geometries><geometry id="g"><mesh><source id="p"><float_array id="a" count=")" +
         coordinates + "\">" + points + R"(</float_array><technique_common>
<accessor source="#a" count=")" +
         count +
         R"(" stride="3"><param name="X" type="float"/><param name="Y" type="float"/><param name="Z" type="float"/></accessor>
</technique_common></source><vertices id="v"><input semantic="POSITION" source="#p"/></vertices>
<polylist count=")" +
         (triangles ? "2" : "1") + R"("><input semantic="VERTEX" source="#v" offset="0"/><vcount>)" + counts +
         "</vcount><p>" + indices + R"(</p></polylist></mesh></geometry></library_geometries>
<library_visual_scenes><visual_scene id="s"><node id="n" name="part"><translate>5 0 0</translate><instance_geometry url="#g"/></node>
<node id="m" name="other"><translate>9 0 2</translate><scale>-1 1 1</scale><instance_geometry url="#g"/></node>
</visual_scene></library_visual_scenes><scene><instance_visual_scene url="#s"/></scene></COLLADA>)";
}

std::string refusal(const std::string& bytes, const std::string& name) {
  return testing::unreadable([&] { static_cast<void>(parse_mesh(bytes, name)); });
}

TEST(assimp, is_named_where_the_library_has_none) {
  if (has_assimp()) return;
  for (const char* name : {"a.dae", "A.FBX", "a.3ds", "a.blend", "a.lwo", "a.x"}) {
    EXPECT_EQ(refusal("", name),
              std::string(name) +
                  ": this snug was built without Assimp, which reads such files: convert the "
                  "mesh to OBJ, STL or glTF, or build snug with -DSNUG_ASSIMP=ON");
  }
}

TEST(assimp, nodes_are_parts_of_joined_corners) {
  if (!has_assimp()) return;
  for (const bool triangles : {false, true}) {
    std::vector<std::string> notes;
    const auto note = [&](const std::string& line) { notes.push_back(line); };
    const MeshAssembly parts = parse_assembly(collada(triangles), "a.dae", {.notes = note});
    ASSERT_EQ(parts.parts.size(), 2u);
    EXPECT_EQ(parts.parts[0].name, "part");
    EXPECT_EQ(parts.parts[1].name, "other");
    ASSERT_FALSE(notes.empty());
    EXPECT_EQ(notes[0], "a.dae: read by Assimp: coordinates are rounded to floats");
    const ControlMesh mesh = parse_mesh(collada(triangles), "a.dae");
    EXPECT_EQ(mesh.vertex_count(), 8u);
    EXPECT_EQ(mesh.face_count(), triangles ? 4u : 2u);
    EXPECT_EQ(mesh.tags.scheme, triangles ? std::optional(Scheme::flat) : std::nullopt);
    EXPECT_EQ(mesh.metres_per_unit, 1);
    // In metres, z up; the mirrored faces are turned, so all normals point up.
    for (std::size_t f = 0; f < mesh.face_count(); ++f) {
      const auto face = mesh.face(FaceId(f));
      const Point3 a = mesh.points[face[0].index()], b = mesh.points[face[1].index()],
                   c = mesh.points[face[2].index()];
      EXPECT_GT(cross(b - a, c - a).z, 0);
      EXPECT_NEAR(a.z, 2 * f >= mesh.face_count() ? 0.02 : 0, 1e-8);
      EXPECT_TRUE(a.x > 0.0499 && a.x < 0.0901) << a.x;
    }
  }
}

TEST(assimp, broken_files_are_one_line) {
  if (!has_assimp()) return;
  const std::string whole = collada(false);
  EXPECT_EQ(refusal("", "a.dae"), "a.dae: the file is empty");
  for (std::size_t size = 1; size + 12 < whole.size(); size += 23) {
    const std::string line = refusal(whole.substr(0, size), "a.dae");
    EXPECT_TRUE(line.starts_with("a.dae: ")) << line;
    EXPECT_EQ(line.find('\n'), std::string::npos) << line;
  }
  const auto with = [&](const std::string& from, const std::string& to) {
    std::string text = whole;
    return text.replace(text.find(from), from.size(), to);
  };
  EXPECT_NE(refusal(with("0 1 2 3<", "0 1 2 9<"), "a.dae").find("Assimp cannot read it"), std::string::npos);
  EXPECT_NE(refusal(with(">0 0 0", ">nan 0 0"), "a.dae").find("not a finite number"), std::string::npos);
  EXPECT_NE(refusal(with("<instance_visual_scene url=\"#s\"/>", ""), "a.dae").find("a.dae: "),
            std::string::npos);
}

}  // namespace
}  // namespace snug::assimp_test
