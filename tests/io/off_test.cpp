#include <snug/io/formats.h>

#include <bit>
#include <random>
#include <string>
#include <vector>

#include <testing/files.h>

namespace snug::off_test {
namespace {

using testing::corners;
using testing::expect_same_arrays;
using testing::unreadable;
using Ids = std::vector<std::uint32_t>;

ControlMesh parse(const std::string& text) { return parse_off(text, "mesh.off"); }
std::string message(const std::string& text) {
  return unreadable([&] { static_cast<void>(parse(text)); });
}

const std::string vertices = "0 0 0\n1 0 0\n0 1 0\n0 0 1\n";
const std::string faces = "3 0 2 1\n4 0 1 3 2\n";
const ControlMesh plain = parse("OFF\n4 2 0\n" + vertices + faces);

TEST(off, reads_vertices_and_faces_in_order) {
  EXPECT_EQ(plain.points, (std::vector<Point3>{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}}));
  ASSERT_EQ(plain.face_count(), 2u);
  EXPECT_EQ(corners(plain, 0), (Ids{0, 2, 1}));
  EXPECT_EQ(corners(plain, 1), (Ids{0, 1, 3, 2}));
}

TEST(off, every_layout_gives_the_same_mesh) {
  for (const std::string& text : {
           "OFF 4 2 0\n" + vertices + faces,
           "OFF\n4 2\n" + vertices + faces,
           "4 2 0\n" + vertices + faces,
           "# c\n\nOFF # c\n# c\n4 2 0 # c\n\n" + vertices + "\n# c\n" + faces + "\n# c",
           std::string("OFF\n4\n2\n0\n0\n0\n0\n1\n0\n0\n0\n1\n0\n0\n0\n1\n3\n0\n2\n1\n4\n0\n1\n3\n2\n"),
           "OFF\n4 2 0\n0 0 0 1 0 0\n0 1 0 0 0 1\n" + faces,
           "OFF\n4 2 0\n0 0 0 1 0\n0 0 1 0 0 0 1\n" + faces,
           "OFF\n4 2 0\n0 0 0 1 0 0 0 1 0 0 0 1 " + faces,
           std::string("OFF\r\n4 2 0\r\n0 0 0\r\n1 0 0\r\n0 1 0\r\n0 0 1\r\n3 0 2 1\r\n4 0 1 3 2"),
           std::string("OFF\r4 2 0\r0 0 0\r1 0 0\r0 1 0\r0 0 1\r3 0 2 1\r4 0 1 3 2\r"),
       }) {
    expect_same_arrays(plain, parse(text));
  }
}

TEST(off, extra_columns_are_ignored) {
  for (const std::string& text : {
           std::string("COFF\n4 2 0\n0 0 0 1 2 3 4\n1 0 0 1 2 3 4\n0 1 0 1 2 3 4\n0 0 1 1 2 3 4\n") + faces,
           std::string("NOFF\n4 2 0\n0 0 0 0 0 1\n1 0 0 0 0 1\n0 1 0 0 0 1\n0 0 1 0 0 1\n") + faces,
           std::string("OFF\n4 2 0\n0 0 0 9 9 9\n1 0 0 9 9 9\n0 1 0 9 9 9\n0 0 1 9 9 9\n") + faces,
           "OFF\n4 2 0\n" + vertices + "3 0 2 1 255 0 0\n4 0 1 3 2 0.1 0.2 0.3 0.4\n",
       }) {
    expect_same_arrays(plain, parse(text));
  }
}

TEST(off, header_words_are_recognised) {
  for (const char* word : {"OFF", "COFF", "NOFF", "CNOFF", "STOFF", "STCN4nOFF", "4OFF", "nOFF"}) {
    EXPECT_TRUE(begins_like_off(std::string("# c\n ") + word + " 1 1 1")) << word;
  }
  for (const char* word : {"", "v", "off", "NCOFF", "OFFER", "XOFF"})
    EXPECT_FALSE(begins_like_off(word)) << word;
}

TEST(off, written_doubles_are_read_bit_by_bit) {
  std::mt19937_64 random(9);
  ControlMesh mesh;
  while (mesh.vertex_count() < 20'000) {
    const Point3 point{std::bit_cast<double>(random()), std::bit_cast<double>(random() >> 13), -0.0};
    if (is_finite(point)) mesh.points.push_back(point);
  }
  for (std::size_t face = 0; face < 1000; ++face) {
    std::vector<VertexId> cycle;
    for (std::size_t k = 0; k <= face % 7; ++k) cycle.emplace_back(random() % mesh.vertex_count());
    mesh.add_face(cycle);
  }
  expect_same_arrays(mesh, parse(format_off(mesh)));
}

TEST(off, faults_name_line_and_element) {
  EXPECT_EQ(message("OFF\n4 2 0\n0 0 0\n1 0 nan\n0 1 0\n0 0 1\n" + faces),
            "mesh.off:4: vertex 1: 'nan' is not a finite number");
  EXPECT_EQ(message("OFF\n4 2 0\n" + vertices + "3 0 2 1\n3 0 4 1\n"),
            "mesh.off:8: face 1: index 4 is outside 0 to 3");
  EXPECT_EQ(message("OFF\n4 2 0\n" + vertices + "3 0 2\n3 0 2 1\n"),
            "mesh.off:7: face 0: only 2 of its 3 vertices are given");
  EXPECT_EQ(message("OFF\n4 1 0\n" + vertices + faces),
            "mesh.off:8: '4' follows the 1 faces that the header declares: correct the counts");
}

TEST(off, false_promises_cost_nothing) {
  EXPECT_NE(message("OFF\n4000000000 4000000000 0\n" + vertices + faces).find("4000000000 vertices"),
            std::string::npos);
  EXPECT_NE(message("OFF\n4 4000000000 0\n" + vertices + faces).find("2 of 4000000000 faces"),
            std::string::npos);
  EXPECT_NE(message("OFF\n4 2 0\n" + vertices + "3 0 2 1\n4000000000 0 1 3 2\n").find("face 1"),
            std::string::npos);
}

TEST(off, every_truncation_is_refused) {
  const std::string text = "OFF\n4 2 0\n" + vertices + faces;
  for (std::size_t size = 0; size < text.size() - 2; ++size) {
    EXPECT_FALSE(message(text.substr(0, size)).empty()) << size;
  }
}

TEST(off, a_missing_or_doubled_line_is_refused) {
  const std::vector<std::string> lines{"0 0 0\n", "1 0 0\n",   "0 1 0\n",
                                       "0 0 1\n", "3 0 2 1\n", "4 0 1 3 2\n"};
  for (std::size_t bent = 0; bent < lines.size(); ++bent) {
    std::string missing = "OFF\n4 2 0\n", doubled = missing;
    for (std::size_t i = 0; i < lines.size(); ++i) {
      if (i != bent) missing += lines[i];
      doubled += i == bent ? lines[i] + lines[i] : lines[i];
    }
    EXPECT_FALSE(message(missing).empty()) << bent;
    EXPECT_FALSE(message(doubled).empty()) << bent;
  }
}

TEST(off, flipped_bytes_are_read_or_refused) {
  const std::string text = "OFF\n4 2 0\n" + vertices + faces;
  std::mt19937_64 random(5);
  for (int i = 0; i < 20'000; ++i) {
    std::string bent = text;
    for (std::size_t k = 0; k <= random() % 3; ++k)
      bent[random() % bent.size()] = static_cast<char>(random());
    try {
      const ControlMesh mesh = parse(bent);
      for (const VertexId vertex : mesh.face_vertices) ASSERT_LT(vertex.index(), mesh.vertex_count());
    } catch (const InputError& error) {
      ASSERT_EQ(std::string(error.what()).find('\n'), std::string::npos);
    }
  }
}

}  // namespace
}  // namespace snug::off_test
