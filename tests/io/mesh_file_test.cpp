#include <snug/mesh.h>

#include <filesystem>

#include <string>
#include <vector>

#include <fcntl.h>
#include <unistd.h>

#include <snug/io/formats.h>
#include <testing/written_forms.h>

#include <support/binary.h>
#include <support/read_file.h>
#include <testing/counts.h>
#include <testing/files.h>

namespace snug::mesh_file_test {
namespace {

using testing::expect_same_arrays;
using testing::put;
using testing::TemporaryFolder;
using testing::unreadable;

const std::string obj_text = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";

ControlMesh creased_triangle() { return parse_obj(obj_text + "t crease 2/1/0 0 1 2\n", "triangle"); }

std::string message(const std::string& path) {
  return unreadable([&] { static_cast<void>(read_mesh(path)); });
}

/// Standard input comes from a file as long as this lives.
class InputFrom {
 public:
  explicit InputFrom(const std::string& path) : saved_(::dup(STDIN_FILENO)) {
    const int file = ::open(path.c_str(), O_RDONLY);
    EXPECT_EQ(::dup2(file, STDIN_FILENO), STDIN_FILENO) << path;
    ::close(file);
  }
  ~InputFrom() {
    ::dup2(saved_, STDIN_FILENO);
    ::close(saved_);
  }
  InputFrom(const InputFrom&) = delete;
  InputFrom& operator=(const InputFrom&) = delete;

 private:
  int saved_;
};

TEST(mesh_file, round_trips_by_ending_in_any_case) {
  const TemporaryFolder folder;
  const ControlMesh mesh = creased_triangle();
  for (const char* name : {"a.obj", "a.OBJ", "a.off", "a.Off", "b.c.obj", "a.ply", "a.PLY", "a.stl", "a.Stl",
                           "a.glb", "a.usda", "a.USDA"}) {
    write_mesh(mesh, folder.file(name));
    expect_same_arrays(mesh, read_mesh(folder.file(name)));
  }
  EXPECT_EQ(read_mesh(folder.file("a.obj")).tags.creases.size(), 1u);
  EXPECT_EQ(read_mesh(folder.file("a.usda")).tags.creases.size(), 1u);
}

TEST(mesh_file, says_that_only_obj_and_usd_have_tags) {
  const TemporaryFolder folder;
  std::vector<std::string> lines;
  const Notes notes = [&](const std::string& line) { lines.push_back(line); };
  ControlMesh mesh = creased_triangle();
  for (const char* name : {"a.off", "a.ply", "a.stl", "a.glb"})
    write_mesh(mesh, folder.file(name), {.notes = notes});
  EXPECT_EQ(lines.size(), 4u);
  mesh.tags = {};
  for (const char* name : {"a.off", "a.ply", "a.stl", "a.glb"})
    write_mesh(mesh, folder.file(name), {.notes = notes});
  write_mesh(creased_triangle(), folder.file("a.obj"), {.notes = notes});
  write_mesh(creased_triangle(), folder.file("a.usda"), {.notes = notes});
  EXPECT_EQ(lines.size(), 4u);
  // A scheme is a tag, but for that which the faces name themselves.
  mesh.tags.scheme = Scheme::loop;
  write_mesh(mesh, folder.file("a.off"), {.notes = notes});
  EXPECT_EQ(lines.size(), 4u);
  mesh.tags.scheme = Scheme::flat;
  write_mesh(mesh, folder.file("a.off"), {.notes = notes});
  EXPECT_EQ(lines.size(), 5u);
  write_mesh(mesh, folder.file("a.obj"), {.notes = notes});
  EXPECT_EQ(read_mesh(folder.file("a.obj")).tags.scheme, Scheme::flat);
}

TEST(mesh_file, tells_the_formats_of_standard_input_apart) {
  const TemporaryFolder folder;
  put(folder.file("obj"), obj_text);
  put(folder.file("off"), format_off(creased_triangle()));
  put(folder.file("ply"), format_ply(creased_triangle()));
  put(folder.file("usda"), format_usda(creased_triangle(), "usda"));
  put(folder.file("glb"), format_glb(creased_triangle(), "glb"));
  put(folder.file("gltf"), format_gltf(creased_triangle(), "gltf"));
  put(folder.file("3mf"), format_3mf(creased_triangle(), "3mf"));
  put(folder.file("bad"), "OFF\n3 1 0\n0 0 0\n");
  for (const char* name : {"obj", "off", "ply", "usda", "glb", "gltf", "3mf"}) {
    const InputFrom input(folder.file(name));
    expect_same_arrays(creased_triangle(), read_mesh("-"));
  }
  const InputFrom input(folder.file("bad"));
  EXPECT_EQ(message("-").substr(0, 16), "standard input:3");
}

TEST(mesh_file, files_beside_one_are_read_and_the_caller_may_have_them) {
  const TemporaryFolder folder;
  const std::string gltf =
      R"({"asset":{"version":"2.0"},"nodes":[{"mesh":0}],"meshes":[{"primitives":[{"attributes":{"POSITION":0}}]}],"accessors":)"
      R"([{"bufferView":0,"componentType":5126,"count":3,"type":"VEC3"}],"bufferViews":[{"buffer":0,"byteLength":36}],"buffers":)"
      R"([{"byteLength":36,"uri":"data/a.bin"}]})";
  put(folder.file("a.gltf"), gltf);
  std::filesystem::create_directory(folder.file("data"));
  std::string buffer;
  for (const float x : {0.f, 0.f, 0.f, 1.f, 0.f, 0.f, 0.f, 1.f, 0.f}) append_binary(buffer, x);
  put(folder.file("data/a.bin"), buffer);
  EXPECT_EQ(read_mesh(folder.file("a.gltf")).points[1], (Point3{1, 0, 0}));
  std::filesystem::remove(folder.file("data/a.bin"));
  EXPECT_NE(message(folder.file("a.gltf")).find("buffer 0: "), std::string::npos);
  std::string asked;
  ReadOptions options;
  options.other_file = [&](const std::string& path) {
    asked = path;
    return buffer;
  };
  EXPECT_EQ(read_mesh(folder.file("a.gltf"), options).vertex_count(), 3u);
  EXPECT_EQ(asked, "data/a.bin");
}

TEST(mesh_file, units_are_kept_where_the_format_has_them) {
  const TemporaryFolder folder;
  ControlMesh mesh = creased_triangle();
  mesh.metres_per_unit = 0.0254;
  write_mesh(mesh, folder.file("a.3mf"));
  EXPECT_EQ(read_mesh(folder.file("a.3mf")).metres_per_unit, 0.0254);
  write_mesh(mesh, folder.file("a.glb"));
  EXPECT_EQ(read_mesh(folder.file("a.glb")).metres_per_unit, 1.0);
  write_mesh(mesh, folder.file("a.ply"));
  EXPECT_EQ(read_mesh(folder.file("a.ply")).metres_per_unit, std::nullopt);
}

TEST(mesh_file, tells_the_formats_of_files_without_ending_apart) {
  const TemporaryFolder folder;
  put(folder.file("plain"), format_off(creased_triangle()));
  expect_same_arrays(creased_triangle(), read_mesh(folder.file("plain")));
  put(folder.file("binary"), testing::big_endian_ply(creased_triangle()));
  expect_same_arrays(creased_triangle(), read_mesh(folder.file("binary")));
}

TEST(mesh_file, welds_every_format_and_says_what) {
  const TemporaryFolder folder;
  const ControlMesh mesh = parse_obj(
      "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 1 1e-7\nv 1 1e-7 0\nv 1 1 0\nf 1 2 3\nf 4 5 6\n", "split.obj", {});
  for (const char* name : {"a.obj", "a.off", "a.ply", "a.stl"}) {
    write_mesh(mesh, folder.file(name));
    EXPECT_EQ(read_mesh(folder.file(name)).vertex_count(), 6u) << name;
    double seen = 0;
    std::vector<std::string> notes;
    const ControlMesh welded =
        read_mesh(folder.file(name), {.weld =
                                          [&](double size) {
                                            seen = size;
                                            return 1e-6 * size;
                                          },
                                      .notes = [&](const std::string& line) { notes.push_back(line); }});
    EXPECT_EQ(seen, 1) << name;
    EXPECT_EQ(welded.vertex_count(), 4u) << name;
    EXPECT_EQ(testing::corners(welded, 1), (std::vector<std::uint32_t>{2, 1, 3})) << name;
    ASSERT_EQ(notes.size(), 1u) << name;
    EXPECT_NE(notes[0].find("2 vertices were welded"), std::string::npos) << notes[0];
  }
}

TEST(mesh_file, says_which_file_cannot_be_welded) {
  const TemporaryFolder folder;
  write_mesh(creased_triangle(), folder.file("a.obj"));
  try {
    static_cast<void>(read_mesh(folder.file("a.obj"), {.weld = [](double) { return 1e-300; }, .notes = {}}));
    ADD_FAILURE();
  } catch (const InputError& error) {
    EXPECT_EQ(error.problem(), InputProblem::refused);
    EXPECT_NE(std::string(error.what()).find("a.obj"), std::string::npos);
  }
}

TEST(mesh_file, knows_which_formats_hold_polygons) {
  for (const char* name : {"-", "a.obj", "a.OFF", "a.ply", "a.usda"})
    EXPECT_TRUE(format_of(name).polygons) << name;
  for (const char* name : {"a.stl", "a.STL", "a.glb"}) EXPECT_FALSE(format_of(name).polygons) << name;
}

TEST(mesh_file, bytes_are_those_of_the_file) {
  const TemporaryFolder folder;
  for (const char* name : {"a.obj", "a.off", "a.ply", "a.stl", "a.glb", "a.usda"}) {
    const std::string path = folder.file(name);
    write_mesh(creased_triangle(), path);
    EXPECT_EQ(format_mesh(creased_triangle(), path), read_file(path)) << name;
    expect_same_arrays(parse_mesh(read_file(path), path), read_mesh(path));
  }
  EXPECT_TRUE(format_of("a.glb").normals);
  const std::vector<Vector3> one(1);
  EXPECT_THROW(static_cast<void>(format_mesh(creased_triangle(), "a.glb", {.normals = one})), InputError);
  EXPECT_TRUE(format_of("a.usda").scheme && !format_of("a.usda").floats);
}

TEST(mesh_file, a_mesh_that_the_format_cannot_hold_leaves_no_file) {
  const TemporaryFolder folder;
  ControlMesh quad = creased_triangle();
  quad.points.push_back({1, 1, 0});
  quad.add_face(std::vector{VertexId(0), VertexId(1), VertexId(3), VertexId(2)});
  EXPECT_THROW(write_mesh(quad, folder.file("a.stl")), InputError);
  EXPECT_EQ(folder.entries(), 0u);
}

TEST(mesh_file, bad_names_are_clear_errors) {
  const TemporaryFolder folder;
  EXPECT_EQ(message(""), "the name of the file to read is empty");
  EXPECT_EQ(message(folder.file("none.obj")),
            folder.file("none.obj") + ": cannot be read: No such file or directory");
  for (const char* name : {"a.xyz", "a.wrl"}) {
    EXPECT_EQ(message(folder.file(name)),
              folder.file(name) +
                  ": meshes are read from .obj, .off, .ply, .stl, .usda, .glb, .gltf and .3mf files only");
  }
  std::filesystem::create_directory(folder.file("folder.obj"));
  EXPECT_EQ(message(folder.file("folder.obj")),
            folder.file("folder.obj") + ": is a directory: name a file in it");
  for (const char* name : {"a.xyz", "a"}) {
    const std::string expected =
        folder.file(name) +
        ": meshes are written to .obj, .off, .ply, .stl, .glb, .gltf, .3mf and .usda files only";
    EXPECT_EQ(unreadable([&] { write_mesh(creased_triangle(), folder.file(name)); }), expected);
    EXPECT_EQ(unreadable([&] { static_cast<void>(format_of(folder.file(name))); }), expected);
  }
  EXPECT_EQ(folder.entries(), 1u);
}

TEST(mesh_file, a_million_triangles_round_trip) {
  const TemporaryFolder folder;
  ControlMesh mesh;
  const std::size_t side = 708 / (5 - testing::fewer(4));  // 60,000 under sanitizers
  for (std::size_t i = 0; i < side * side; ++i) {
    mesh.points.push_back({static_cast<double>(i % side) / 7, static_cast<double>(i / side) / 3, 0.1});
  }
  for (std::size_t i = 0; i + side + 1 < side * side; ++i) {
    if (i % side == side - 1) continue;
    mesh.add_face(std::vector{VertexId(i), VertexId(i + 1), VertexId(i + side)});
    mesh.add_face(std::vector{VertexId(i + 1), VertexId(i + side + 1), VertexId(i + side)});
  }
  for (const char* name : {"large.obj", "large.off", "large.ply"}) {
    write_mesh(mesh, folder.file(name));
    expect_same_arrays(mesh, read_mesh(folder.file(name)));
  }
}

// Vertices 0 1 2 3 are a quad; (0, 2) is its diagonal, and vertex 4 is used by no face.
TEST(read_mesh, notes_creases_that_name_no_edge) {
  const auto notes_of = [](const std::string& tags) {
    std::vector<std::string> lines;
    static_cast<void>(parse_mesh("v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 5 5 5\nf 1 2 3 4\n" + tags, "a.obj",
                                 {.notes = [&](const std::string& line) { lines.push_back(line); }}));
    return lines;
  };
  EXPECT_EQ(notes_of("t crease 2/1/0 1 0 2\nt crease 2/1/0 3 0 2\n"), std::vector<std::string>{});
  EXPECT_EQ(notes_of("t crease 2/1/0 2 0 2\n"),
            std::vector<std::string>{"a.obj: 1 crease names no edge of a face: (2, 0)"});
  EXPECT_EQ(notes_of("t crease 2/1/0 0 1 2\nt crease 2/1/0 1 3 2\nt crease 2/1/0 4 0 2\n"),
            std::vector<std::string>{"a.obj: 2 creases name no edge of a face: the first is (1, 3)"});
}

}  // namespace
}  // namespace snug::mesh_file_test
