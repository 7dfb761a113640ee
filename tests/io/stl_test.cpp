#include <snug/io/formats.h>

#include <bit>
#include <cmath>
#include <random>
#include <string>
#include <vector>

#include <support/binary.h>
#include <testing/written_forms.h>

#include <testing/files.h>

namespace snug::stl_test {
namespace {

using testing::corners;
using testing::expect_same_arrays;
using testing::unreadable;
using Ids = std::vector<std::uint32_t>;

ControlMesh parse(const std::string& bytes) { return parse_stl(bytes, "mesh.stl"); }
std::string message(const std::string& bytes) {
  return unreadable([&] { static_cast<void>(parse(bytes)); });
}
std::string refusal(const std::function<void()>& action) {
  try {
    action();
  } catch (const InputError& error) {
    EXPECT_EQ(error.problem(), InputProblem::refused);
    return error.what();
  }
  ADD_FAILURE() << "nothing was thrown";
  return {};
}

std::string facet(const std::string& a, const std::string& b, const std::string& c) {
  return "facet normal 0 0 1\nouter loop\nvertex " + a + "\nvertex " + b + "\nvertex " + c +
         "\nendloop\nendfacet\n";
}
const std::string two_facets = facet("0 0 0", "1 0 0", "0 1 0") + facet("0 1 0", "1 0 0", "-0 -0 5");

ControlMesh mesh_of(std::vector<Point3> points, const std::vector<Ids>& faces) {
  ControlMesh mesh;
  mesh.points = std::move(points);
  for (const Ids& face : faces) mesh.add_face(std::vector<VertexId>(face.begin(), face.end()));
  return mesh;
}

/// The twelve floats of a facet of a binary file.
std::vector<float> facet_floats(const std::string& file, std::size_t number) {
  std::vector<float> floats;
  for (std::size_t i = 0; i < 12; ++i) {
    floats.push_back(load<float>(file.data() + 84 + 50 * number + 4 * i, std::endian::little));
  }
  return floats;
}

TEST(stl, equal_corners_become_one_vertex) {
  const ControlMesh mesh = parse("solid a\n" + two_facets + "endsolid a\n");
  EXPECT_EQ(mesh.points, (std::vector<Point3>{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 5}}));
  ASSERT_EQ(mesh.face_count(), 2u);
  EXPECT_EQ(corners(mesh, 0), (Ids{0, 1, 2}));
  EXPECT_EQ(corners(mesh, 1), (Ids{2, 1, 3}));
}

TEST(stl, zeros_of_both_signs_are_equal_and_the_first_one_stays) {
  const ControlMesh mesh = parse("solid\n" + facet("-0 0 0", "1 0 0", "0 1 0") +
                                 facet("0 1 -0", "1 -0 0", "0 -0 0") + "endsolid\n");
  EXPECT_EQ(mesh.vertex_count(), 3u);
  EXPECT_TRUE(std::signbit(mesh.points[0].x));
}

TEST(stl, facets_with_equal_corners_are_kept) {
  const ControlMesh mesh = parse("solid\n" + two_facets + facet("0 0 0", "0 0 0", "0 1 0") + "endsolid\n");
  ASSERT_EQ(mesh.face_count(), 3u);
  EXPECT_EQ(corners(mesh, 2), (Ids{0, 0, 2}));
}

TEST(stl, solids_of_one_file_are_joined) {
  const ControlMesh mesh = parse("solid a b c\n" + facet("0 0 0", "1 0 0", "0 1 0") +
                                 "endsolid a b c\n\nSOLID\n" + facet("0 1 0", "1 0 0", "0 0 5") + "EndSolid");
  EXPECT_EQ(mesh.face_count(), 2u);
  EXPECT_EQ(mesh.vertex_count(), 4u);
}

TEST(stl, a_binary_file_may_begin_with_solid) {
  const ControlMesh mesh = mesh_of({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 2}});
  std::string file = format_stl(mesh, "out.stl");
  ASSERT_EQ(file.size(), 84u + 50u);
  EXPECT_FALSE(file.starts_with("solid"));
  file.replace(0, 6, "solid\n");
  expect_same_arrays(mesh, parse(file));
}

TEST(stl, binary_files_hold_the_nearest_floats_and_normals) {
  const ControlMesh mesh = mesh_of({{0, 0, 0}, {0.1, 0, 0}, {0, 0, 0.1}}, {{0, 1, 2}});
  std::vector<std::string> lines;
  const std::string file =
      format_stl(mesh, "out.stl", [&](const std::string& line) { lines.push_back(line); });
  EXPECT_EQ(lines, (std::vector<std::string>{"out.stl: coordinates are rounded to single precision"}));
  EXPECT_EQ(facet_floats(file, 0), (std::vector<float>{0, -1, 0, 0, 0, 0, 0.1f, 0, 0, 0, 0, 0.1f}));
  lines.clear();
  const ControlMesh again = parse(file);
  EXPECT_EQ(format_stl(again, "out.stl", [&](const std::string& line) { lines.push_back(line); }), file);
  EXPECT_TRUE(lines.empty());
}

TEST(stl, normals_have_length_one_at_any_scale) {
  for (const double scale : {1e-30, 1.0, 1e30}) {
    const ControlMesh mesh = mesh_of({{0, 0, 0}, {scale, 0, 0}, {0, scale, scale}}, {{0, 1, 2}});
    const auto floats = facet_floats(format_stl(mesh, "out.stl"), 0);
    EXPECT_EQ(floats[0], 0);
    EXPECT_FLOAT_EQ(floats[1], -std::sqrt(0.5f)) << scale;
    EXPECT_FLOAT_EQ(floats[2], std::sqrt(0.5f)) << scale;
  }
  const auto flat =
      facet_floats(format_stl(mesh_of({{0, 0, 0}, {1, 1, 1}, {2, 2, 2}}, {{0, 1, 2}}), "out.stl"), 0);
  EXPECT_EQ(std::vector<float>(flat.begin(), flat.begin() + 3), (std::vector<float>{0, 0, 0}));
}

TEST(stl, ascii_files_keep_doubles_bit_by_bit) {
  std::mt19937_64 random(9);
  ControlMesh mesh;
  while (mesh.vertex_count() < 3000) {
    const Point3 point{std::bit_cast<double>(random()), std::bit_cast<double>(random() >> 13), -0.0};
    if (is_finite(point)) mesh.points.push_back(point);
  }
  for (std::size_t v = 0; v < mesh.vertex_count(); v += 3) {
    mesh.add_face(std::vector{VertexId(v), VertexId(v + 1), VertexId(v + 2)});
  }
  expect_same_arrays(mesh, parse(testing::ascii_stl(mesh)));
}

TEST(stl, writing_refuses_what_stl_cannot_hold) {
  const auto write = [](const ControlMesh& mesh) { static_cast<void>(format_stl(mesh, "out.stl")); };
  EXPECT_EQ(refusal([&] {
              write(mesh_of({{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}}, {{0, 1, 2}, {0, 1, 2, 3}}));
            }),
            "out.stl: face 1 has 4 corners: STL holds triangles only; write PLY, OBJ or OFF");
  EXPECT_EQ(refusal([&] {
              write(mesh_of({{0, 0, 0}, {1e39, 0, 0}, {1, 1, 0}}, {{0, 1, 2}}));
            }),
            "out.stl: vertex 1 is too far out for single precision: write PLY, OBJ or OFF");
}

TEST(stl, faults_name_line_or_facet) {
  EXPECT_EQ(message("solid\n" + facet("0 0 0", "1 nan 0", "0 1 0") + "endsolid\n"),
            "mesh.stl:5: vertex 1: 'nan' is not a finite number");
  EXPECT_EQ(message("solid\n" + two_facets + "facet normal 0 0 1\nvertex 0 0 0\n"),
            "mesh.stl:17: facet 2: 'vertex' found where outer is expected");
  const ControlMesh mesh = mesh_of({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 2}, {2, 1, 0}});
  std::string file = format_stl(mesh, "out.stl");
  EXPECT_EQ(message(file.substr(0, file.size() - 1)),
            "mesh.stl: the file declares 2 facets, which take 184 bytes, but has 183");
  file.replace(84 + 50 + 12, 4, std::string("\0\0\x80\x7f", 4));
  EXPECT_EQ(message(file), "mesh.stl: facet 1: a coordinate is not a finite number");
}

TEST(stl, every_truncation_is_refused) {
  const ControlMesh mesh = mesh_of({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 2}, {2, 1, 0}});
  const std::string binary = format_stl(mesh, "out.stl"), text = testing::ascii_stl(mesh);
  for (std::size_t size = 0; size < binary.size(); ++size) {
    EXPECT_FALSE(message(binary.substr(0, size)).empty()) << size;
  }
  const std::size_t end = text.find("endsolid") + 8;  // the name may be missing
  for (std::size_t size = 0; size < end; ++size) EXPECT_FALSE(message(text.substr(0, size)).empty()) << size;
}

TEST(stl, flipped_bytes_are_read_or_refused) {
  const ControlMesh plain = parse("solid\n" + two_facets + "endsolid\n");
  std::mt19937_64 random(5);
  for (int i = 0; i < 20'000; ++i) {
    std::string bent = random() % 2 == 0 ? testing::ascii_stl(plain) : format_stl(plain, "out.stl");
    for (std::size_t k = 0; k <= random() % 3; ++k)
      bent[random() % bent.size()] = static_cast<char>(random());
    try {
      const ControlMesh mesh = parse(bent);
      for (const VertexId vertex : mesh.face_vertices) ASSERT_LT(vertex.index(), mesh.vertex_count());
      for (const Point3& point : mesh.points) ASSERT_TRUE(is_finite(point));
    } catch (const InputError& error) {
      ASSERT_EQ(std::string(error.what()).find('\n'), std::string::npos);
    }
  }
}

}  // namespace
}  // namespace snug::stl_test
