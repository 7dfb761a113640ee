#include <algorithm>
#include <fstream>
#include <set>
#include <sstream>
#include <string>
#include <vector>

#include <snug/io/formats.h>
#include <snug/mesh.h>
#include <testing/places.h>

#include <testing/files.h>

namespace snug::corpus_test {
namespace {

using testing::expect_same_arrays;
using testing::unreadable;

struct Row {
  std::string file;
  int status;
};

/// The table of INDEX.md: `| file | status | what |`.
std::vector<Row> index_rows() {
  std::ifstream index(testing::corpus_dir() + "/INDEX.md");
  std::vector<Row> rows;
  for (std::string line; std::getline(index, line);) {
    std::istringstream words(line);
    std::string bar, file, status;
    words >> bar >> file >> bar >> status;
    if (status == "0" || status == "3" || status == "4") rows.push_back({file, std::stoi(status)});
  }
  return rows;
}

std::string path_of(const Row& row) { return testing::corpus_dir() + '/' + row.file; }

TEST(corpus, every_file_has_one_row) {
  std::multiset<std::string> listed, present;
  for (const Row& row : index_rows()) listed.insert(row.file);
  for (const auto& entry : std::filesystem::directory_iterator(testing::corpus_dir())) {
    const std::string ending = entry.path().extension().string();
    if (ending == ".obj" || ending == ".off" || ending == ".ply" || ending == ".stl" || ending == ".usda" ||
        ending == ".glb" || ending == ".gltf" || ending == ".3mf") {
      present.insert(entry.path().filename().string());
    }
  }
  EXPECT_GT(listed.size(), 100u);
  EXPECT_EQ(listed, present);
}

TEST(corpus, unreadable_files_are_refused_in_one_line_that_names_them) {
  for (const Row& row : index_rows()) {
    if (row.status != 3) continue;
    SCOPED_TRACE(row.file);
    const std::string message = unreadable([&] { static_cast<void>(read_mesh(path_of(row))); });
    EXPECT_EQ(message.substr(0, path_of(row).size() + 1), path_of(row) + ':');
    EXPECT_TRUE(std::all_of(message.begin(), message.end(), [](char c) { return c >= ' ' && c <= '~'; }))
        << message;
    EXPECT_LT(message.size(), path_of(row).size() + 150);
  }
}

TEST(corpus, other_files_are_read_and_survive_a_round_trip) {
  for (const Row& row : index_rows()) {
    if (row.status == 3) continue;
    SCOPED_TRACE(row.file);
    const ControlMesh mesh = read_mesh(path_of(row));
    const std::string text = format_obj(mesh);
    const ControlMesh again = parse_obj(text, "again");
    expect_same_arrays(mesh, again);
    EXPECT_EQ(format_obj(again), text);
  }
}

TEST(corpus, variants_of_a_file_hold_the_same_mesh) {
  const auto read = [](const std::string& file) { return read_mesh(testing::corpus_dir() + '/' + file); };
  const ControlMesh tetrahedron = read("tetrahedron.obj");
  for (const char* file :
       {"corner_forms", "faces_first", "tags_first", "continued_lines", "comment_backslash", "windows_lines",
        "old_mac_lines", "no_final_newline", "control_z", "utf8_mark", "latin1_comment", "vertex_colours",
        "plus_signs", "smf_header", "unknown_statements"}) {
    SCOPED_TRACE(file);
    const ControlMesh mesh = read(std::string(file) + ".obj");
    EXPECT_EQ(mesh.points, tetrahedron.points);
    EXPECT_EQ(mesh.face_count(), 4u);
  }
  for (const char* file :
       {"windows_lines", "no_final_newline", "utf8_mark", "counts_on_header", "two_counts", "no_header_word",
        "comments", "face_colours", "vertex_colours", "vertex_normals", "texture_normals_colours",
        "unannounced_colours", "words_on_lines", "vertices_share_lines"}) {
    SCOPED_TRACE(file);
    expect_same_arrays(read("tetrahedron.off"), read(std::string(file) + ".off"));
  }
  for (const char* file : {"tetrahedron_ascii", "tetrahedron_little", "tetrahedron_big", "windows_lines",
                           "windows_header", "old_mac_lines", "comments", "blank_lines", "no_final_newline",
                           "final_newline", "vertex_index", "new_type_names", "colours", "unknown_elements",
                           "faces_first", "integer_coordinates", "empty_tristrips"}) {
    SCOPED_TRACE(file);
    expect_same_arrays(read("tetrahedron.off"), read(std::string(file) + ".ply"));
  }
  for (const char* file : {"tetrahedron", "scene"}) {
    SCOPED_TRACE(file);
    expect_same_arrays(read("tetrahedron.off"), read(std::string(file) + ".usda"));
  }
  // Vertices in the order of the facets, as in STL.
  EXPECT_EQ(read("tetrahedron.glb").points, read("tetrahedron_binary.stl").points);
  EXPECT_EQ(read("tetrahedron.glb").face_vertices, read("tetrahedron_binary.stl").face_vertices);
  for (const char* file : {"tetrahedron.gltf", "buffer_beside.gltf"})
    expect_same_arrays(read("tetrahedron.glb"), read(file));
  for (const char* file : {"tetrahedron.3mf", "stored.3mf"})
    expect_same_arrays(read("tetrahedron.off"), read(file));
  const ControlMesh facets = read("tetrahedron_binary.stl");
  EXPECT_EQ(facets.vertex_count(), 4u);
  for (const char* file : {"tetrahedron_ascii", "binary_solid", "binary_title_ply", "two_solids",
                           "upper_case", "windows_lines", "nan_normals", "negative_zeros"}) {
    SCOPED_TRACE(file);
    const ControlMesh mesh = read(std::string(file) + ".stl");
    EXPECT_EQ(mesh.points, facets.points);
    EXPECT_EQ(mesh.face_vertices, facets.face_vertices);
  }
}

}  // namespace
}  // namespace snug::corpus_test
