#include <support/read_file.h>
#include <testing/places.h>

#include <gtest/gtest.h>

#include <snug/mesh.h>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "run_snug.h"
#include "scene_testing.h"

namespace snug::testing::units_test {
namespace {

// A box of these sides as a file of this name, in a unit.
std::string box_file(const TemporaryFolder& folder, const std::string& name, double side,
                     std::optional<double> metres) {
  ControlMesh mesh;
  for (std::size_t v = 0; v < 8; ++v)
    mesh.points.push_back({(v & 1u) != 0 ? side : 0, (v & 2u) != 0 ? side : 0, (v & 4u) != 0 ? side : 0});
  for (const auto& f : {std::array{0, 2, 3},
                        {0, 3, 1},
                        {4, 5, 7},
                        {4, 7, 6},
                        {0, 1, 5},
                        {0, 5, 4},
                        {2, 6, 7},
                        {2, 7, 3},
                        {0, 4, 6},
                        {0, 6, 2},
                        {1, 3, 7},
                        {1, 7, 5}}) {
    mesh.add_face(std::array{VertexId(f[0]), VertexId(f[1]), VertexId(f[2])});
  }
  mesh.tags.scheme = Scheme::flat;
  mesh.metres_per_unit = metres;
  write_mesh(mesh, folder.file(name));
  return folder.file(name);
}

double tolerance_of(const std::vector<std::string>& arguments) {
  const Outcome outcome = run_snug(arguments);
  EXPECT_EQ(outcome.status, 0) << outcome.err;
  return Json::parse(outcome.out)["tolerance"];
}
void expect_refused(const std::vector<std::string>& arguments, int status, const std::string& text) {
  const Outcome outcome = run_snug(arguments);
  EXPECT_EQ(outcome.status, status) << outcome.err;
  EXPECT_NE(outcome.err.find(text), std::string::npos) << outcome.err;
  EXPECT_EQ(outcome.out, "");
}

TEST(units, lengths_with_a_unit_are_those_of_the_mesh) {
  const TemporaryFolder folder;
  const std::string inch = box_file(folder, "inch.3mf", 1, 0.0254),
                    plain = box_file(folder, "plain.obj", 1, {});
  const std::vector<std::string> apart{"--move-b", "9 0 0", "--json", "--tolerance", "2.54mm"};
  const auto with = [&](std::vector<std::string> words, const std::vector<std::string>& more = {}) {
    words.insert(words.begin(), "collide");
    words.insert(words.end(), apart.begin(), apart.end());
    words.insert(words.end(), more.begin(), more.end());
    return words;
  };
  EXPECT_NEAR(tolerance_of(with({inch, inch})), 0.1, 1e-15);
  EXPECT_NEAR(tolerance_of(with({plain, plain}, {"--units", "cm"})), 0.254, 1e-15);
  EXPECT_NEAR(tolerance_of(with({inch, inch}, {"--units", "mm"})), 2.54, 1e-15);
  expect_refused(with({inch, plain}), 2, "needs a mesh whose units are known: give --units");
  expect_refused(with({plain, plain}), 2, "needs a mesh whose units are known: give --units");
  // After a scale the file's own units do not hold.
  expect_refused(with({inch, inch}, {"--scale", "25.4"}), 2, "needs a mesh whose units are known");
  EXPECT_NEAR(tolerance_of(with({inch, inch}, {"--scale", "25.4", "--units", "mm"})), 2.54, 1e-15);
}

TEST(units, different_units_are_not_mixed) {
  const TemporaryFolder folder;
  const std::string inch = box_file(folder, "inch.3mf", 1, 0.0254),
                    mm = box_file(folder, "mm.3mf", 25.4, 1e-3);
  expect_refused({"distance", inch, mm}, 4, "inch.3mf is in inch, ");
  expect_refused({"deviation", inch, mm}, 4, "is in inch, ");
  const Outcome same =
      run_snug({"distance", inch, mm, "--scale-a", "25.4", "--units", "mm", "--move-b", "30 0 0", "--json"});
  ASSERT_EQ(same.status, 0) << same.err;
  EXPECT_NEAR(Json::parse(same.out)["distance"][0].get<double>(), 4.6, 1e-9);
}

TEST(units, scaled_meshes_are_larger_and_keep_their_units_when_they_are_written) {
  const TemporaryFolder folder;
  const std::string inch = box_file(folder, "inch.3mf", 1, 0.0254);
  const Outcome measured = run_snug({"measure", inch, "--scale", "2", "--json"});
  ASSERT_EQ(measured.status, 0) << measured.err;
  EXPECT_NEAR(Json::parse(measured.out)["volume"][0].get<double>(), 8, 1e-9);
  const std::string out = folder.file("out.3mf");
  ASSERT_EQ(run_snug({"tessellate", inch, "-o", out, "--error", "0.1mm"}).status, 0);
  EXPECT_EQ(read_mesh(out).metres_per_unit, 0.0254);
  expect_refused({"measure", inch, "--scale", "0"}, 2, "--scale");
  expect_refused({"measure", inch, "--units", "parsec"}, 2, "--units");
}

TEST(units, convert_states_those_of_the_file) {
  const TemporaryFolder folder;
  const std::string file = folder.file("a.step"), box = folder.file("box.usda");
  write_text(box,
             "#usda 1.0\n(\n    metersPerUnit = 0.01\n)\ndef Mesh \"m\"\n{\nint[] faceVertexCounts = [4]\n"
             "int[] faceVertexIndices = [0, 1, 2, 3]\npoint3f[] points = [(0, 0, 0), (1, 0, 0), (1, 1, 0), "
             "(0, 1, 0)]\n}\n");
  ASSERT_EQ(run_snug({"convert", box, "-o", file}).status, 0);
  EXPECT_NE(read_file(file).find("SI_UNIT(.CENTI.,.METRE.)"), std::string::npos);
  ASSERT_EQ(run_snug({"convert", box, "-o", file, "--units", "micron"}).status, 0);
  EXPECT_NE(read_file(file).find("SI_UNIT(.MICRO.,.METRE.)"), std::string::npos);
  ASSERT_EQ(run_snug({"convert", box, "-o", file, "--units", "foot"}).status, 0);
  EXPECT_NE(read_file(file).find("LENGTH_MEASURE(0.3048)"), std::string::npos);
}

// --- scenes

TEST(units, a_file_of_several_meshes_is_a_scene) {
  const TemporaryFolder folder;
  const std::string text =
      R"({"asset":{"version":"2.0"},"scenes":[{"nodes":[0,1,2]}],"nodes":[{"mesh":0,"name":"a"},)"
      R"({"mesh":0,"name":"b","translation":[0.5,0.25,0]},{"mesh":0,"name":"c","translation":[9,0,0]}],)"
      R"("meshes":[{"primitives":[{"attributes":{"POSITION":0}}]}],"accessors":[{"bufferView":0,)"
      R"("componentType":5126,"count":6,"type":"VEC3"}],"bufferViews":[{"buffer":0,"byteLength":72}],)"
      R"("buffers":[{"byteLength":72,"uri":"a.bin"}]})";
  write_text(folder.file("a.gltf"), text);
  std::string buffer;
  for (const float x :
       {0.f, 0.f, 0.f, 1.f, 0.f, 0.f, 0.f, 1.f, 0.f, 0.f, 0.f, 0.f, 0.f, 1.f, 0.f, 0.f, 0.f, 1.f}) {
    buffer.append(reinterpret_cast<const char*>(&x), 4);
  }
  write_text(folder.file("a.bin"), buffer);
  const Outcome outcome =
      run_snug({"collide", "--scene", folder.file("a.gltf"), "--json", "--tolerance", "1mm"});
  EXPECT_EQ(outcome.status, 2);  // a scene has its own tolerance
  const Outcome found =
      run_snug({"distance", "--scene", folder.file("a.gltf"), "--json", "--limit", "900cm"});
  ASSERT_EQ(found.status, 0) << found.err;
  const Json document = Json::parse(found.out);
  EXPECT_EQ(document["parts"], 3);
  EXPECT_EQ(document["mesh"].size(), 1u);
  EXPECT_EQ(document["limit"], 9.0);
  ASSERT_EQ(document["results"].size(), 3u);
  EXPECT_EQ(document["results"][0]["a"], "a");
  EXPECT_EQ(document["results"][0]["b"], "b");
  EXPECT_LT(document["results"][0]["distance"][1], 1e-9);
  // As a part of a scene in JSON it is one mesh.
  write_text(folder.file("s.json"),
             R"({"parts":[{"mesh":"a.gltf","scale":2},{"mesh":"a.gltf","place":{"move":[100,0,0]}}]})");
  const Outcome part = run_snug({"distance", "--scene", folder.file("s.json"), "--json", "--limit", "100"});
  EXPECT_EQ(part.status, 0) << part.err;
  write_text(folder.file("m.json"), R"({"parts":[{"mesh":"a.gltf"},{"mesh":"a.gltf","units":"mm"}]})");
  expect_refused({"distance", "--scene", folder.file("m.json"), "--limit", "100"}, 4,
                 "in mm: bring both to one unit");
}

// Parts and triangles within the error, in their places.
TEST(units, a_scene_is_written_as_one_file) {
  const TemporaryFolder folder;
  const std::string out = folder.file("out.3mf"), stl = folder.file("out.stl");
  const Json scene{{"parts",
                    {{{"name", "a"}, {"mesh", model("pin.obj")}, {"units", "inch"}},
                     {{"name", "b"},
                      {"mesh", model("pin.obj")},
                      {"units", "inch"},
                      {"place", {{"rotate", "z 30"}, {"move", {0.1, 5, 0}}}}}}}};
  const std::string file = write_scene(folder.file("scene.json"), scene);
  const Outcome written = run_snug({"tessellate", "--scene", file, "--error", "0.5mm", "-o", out, "--json"});
  ASSERT_EQ(written.status, 0) << written.err;
  const Json document = Json::parse(written.out);
  EXPECT_EQ(document["parts"], 2);
  ASSERT_EQ(document["shapes"].size(), 1u);
  EXPECT_LE(document["shapes"][0]["error_bound"], 0.5 / 25.4);
  const MeshAssembly read = read_assembly(out);
  ASSERT_EQ(read.parts.size(), 2u);
  EXPECT_EQ(read.parts[1].name, "b");
  EXPECT_EQ(read.parts[1].pose, Motion::rotation_degrees({0, 0, 1}, 30).with_offset({0.1, 5, 0}));
  EXPECT_EQ(read.meshes[0].metres_per_unit, 0.0254);
  EXPECT_EQ(read.meshes[0].face_count(), document["shapes"][0]["triangles"]);
  expect_refused({"tessellate", "--scene", file, "--error", "0.5mm", "-o", stl}, 2, "go to -o FILE.3mf");
}

TEST(units, a_broken_file_leaves_nothing) {
  const TemporaryFolder folder;
  const std::string out = folder.file("out.3mf");
  const Outcome outcome = run_snug({"subdivide", corpus_dir() + "/damaged.3mf", "-o", out});
  EXPECT_EQ(outcome.status, 3);
  EXPECT_FALSE(std::filesystem::exists(out));
}

}  // namespace
}  // namespace snug::testing::units_test
