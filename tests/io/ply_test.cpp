#include <snug/io/formats.h>

#include <bit>
#include <random>
#include <string>
#include <vector>

#include <support/binary.h>
#include <testing/written_forms.h>

#include <testing/files.h>

namespace snug::ply_test {
namespace {

using testing::corners;
using testing::expect_same_arrays;
using testing::ply_of;
using testing::PlyForm;
using testing::unreadable;
using Ids = std::vector<std::uint32_t>;

constexpr std::array formats{PlyForm::ascii, PlyForm::little_endian, PlyForm::big_endian};

ControlMesh parse(const std::string& bytes) { return parse_ply(bytes, "mesh.ply"); }
std::string message(const std::string& bytes) {
  return unreadable([&] { static_cast<void>(parse(bytes)); });
}

const std::string head =
    "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\nproperty float z\n"
    "element face 2\nproperty list uchar int vertex_indices\nend_header\n";
const std::string vertices = "0 0 0\n1 0 0\n0 1 0\n0 0 1\n";
const std::string faces = "3 0 2 1\n4 0 1 3 2\n";

ControlMesh random_mesh(std::size_t vertex_count, std::size_t max_corners) {
  std::mt19937_64 random(9);
  ControlMesh mesh;
  while (mesh.vertex_count() < vertex_count) {
    const Point3 point{std::bit_cast<double>(random()), std::bit_cast<double>(random() >> 13), -0.0};
    if (is_finite(point)) mesh.points.push_back(point);
  }
  for (std::size_t face = 0; face < 500; ++face) {
    std::vector<VertexId> cycle;
    for (std::size_t k = 0; k <= face % max_corners; ++k) cycle.emplace_back(random() % mesh.vertex_count());
    mesh.add_face(cycle);
  }
  return mesh;
}

TEST(ply, reads_vertices_and_faces_in_order) {
  const ControlMesh mesh = parse(head + vertices + faces);
  EXPECT_EQ(mesh.points, (std::vector<Point3>{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}}));
  ASSERT_EQ(mesh.face_count(), 2u);
  EXPECT_EQ(corners(mesh, 0), (Ids{0, 2, 1}));
  EXPECT_EQ(corners(mesh, 1), (Ids{0, 1, 3, 2}));
}

TEST(ply, decimals_are_read_as_doubles_whatever_their_type) {
  const ControlMesh mesh = parse(head + "0.1 0 0\n1 0 0\n0 1 0\n0 0 1e300\n" + faces);
  EXPECT_EQ(mesh.points[0].x, 0.1);
  EXPECT_EQ(mesh.points[3].z, 1e300);
}

TEST(ply, every_scalar_type_is_read_in_both_orders) {
  for (const std::endian order : {std::endian::little, std::endian::big}) {
    for (const bool old_names : {true, false}) {
      std::string file = "ply\nformat binary_";
      file += order == std::endian::little ? "little" : "big";
      file += "_endian 1.0\nelement vertex 3\nproperty ";
      file += old_names ? "char a\nproperty uchar b\nproperty short c\nproperty ushort x\nproperty int y\n"
                          "property uint d\nproperty float e\nproperty double z\n"
                        : "int8 a\nproperty uint8 b\nproperty int16 c\nproperty uint16 x\nproperty int32 y\n"
                          "property uint32 d\nproperty float32 e\nproperty float64 z\n";
      file += "element face 1\nproperty list uint16 uint32 vertex_indices\nend_header\n";
      for (const double z : {0.1, -0.0, 5e-324}) {
        append_binary(file, std::int8_t{-1}, order);
        append_binary(file, std::uint8_t{2}, order);
        append_binary(file, std::int16_t{-3}, order);
        append_binary(file, std::uint16_t{60'000}, order);
        append_binary(file, std::int32_t{-2'000'000'000}, order);
        append_binary(file, std::uint32_t{4'000'000'000}, order);
        append_binary(file, 0.5f, order);
        append_binary(file, z, order);
      }
      append_binary(file, std::uint16_t{3}, order);
      for (const std::uint32_t index : {2u, 1u, 0u}) append_binary(file, index, order);
      const ControlMesh mesh = parse(file);
      EXPECT_EQ(mesh.points,
                (std::vector<Point3>{{60'000, -2e9, 0.1}, {60'000, -2e9, 0}, {60'000, -2e9, 5e-324}}));
      EXPECT_TRUE(std::signbit(mesh.points[1].z));
      EXPECT_EQ(corners(mesh, 0), (Ids{2, 1, 0}));
    }
  }
}

TEST(ply, each_type_of_coordinate_gives_its_number) {
  const auto read_x = [](const std::string& type, const std::string& bytes) {
    std::string file = "ply\nformat binary_big_endian 1.0\nelement vertex 1\nproperty " + type +
                       " x\nproperty uchar y\nproperty uchar z\nelement face 1\n"
                       "property list uchar uchar vertex_index\nend_header\n" +
                       bytes;
    file.append("\0\0\1\0", 4);
    return parse(file).points[0].x;
  };
  EXPECT_EQ(read_x("char", "\xFE"), -2);
  EXPECT_EQ(read_x("uchar", "\xFE"), 254);
  EXPECT_EQ(read_x("short", "\xFF\xFE"), -2);
  EXPECT_EQ(read_x("ushort", "\xFF\xFE"), 65534);
  EXPECT_EQ(read_x("int", "\xFF\xFF\xFF\xFE"), -2);
  EXPECT_EQ(read_x("uint", "\xFF\xFF\xFF\xFE"), 4294967294.0);
  EXPECT_EQ(read_x("float", std::string("\xC0\0\0\0", 4)), -2);
  EXPECT_EQ(read_x("double", std::string("\xC0\0\0\0\0\0\0\0", 8)), -2);
}

TEST(ply, written_doubles_are_read_bit_by_bit) {
  for (const std::size_t max_corners : {7, 300}) {  // counted by bytes, and not
    const ControlMesh mesh = random_mesh(5000, max_corners);
    for (const PlyForm format : formats) expect_same_arrays(mesh, parse(ply_of(mesh, format)));
  }
}

TEST(ply, binary_bytes_that_look_like_line_ends_are_kept) {
  ControlMesh mesh;
  const double newlines = std::bit_cast<double>(0x0A0D0A0D0A0D0A0D);
  mesh.points = {{newlines, newlines, newlines}, {1, 0, 0}, {0, 1, 0}};
  mesh.add_face(std::vector{VertexId(0), VertexId(1), VertexId(2)});
  for (const PlyForm format : formats) {
    std::string file = ply_of(mesh, format);
    expect_same_arrays(mesh, parse(file));
    const std::size_t end = file.find("end_header\n") + 11;
    for (const std::string line_end : {"\r\n", "\r"}) {
      std::string bent;
      for (const char c : file.substr(0, end)) bent += c == '\n' ? line_end : std::string(1, c);
      expect_same_arrays(mesh, parse(bent + file.substr(end)));
    }
  }
}

TEST(ply, faults_name_line_or_element) {
  EXPECT_EQ(message(head + "0 0 0\n1 0 nan\n0 1 0\n0 0 1\n" + faces),
            "mesh.ply:11: vertex 1: 'nan' is not a finite number");
  EXPECT_EQ(message(head + vertices + "3 0 2 1\n3 0 4 1\n"),
            "mesh.ply:15: face 1: index 4 is outside 0 to 3");
  EXPECT_EQ(message(head + vertices + "3 0 2\n3 0 2 1\n"),
            "mesh.ply:14: face 0: the line ends before its last value");
  EXPECT_EQ(message(head + vertices + faces + "3 0 2 1\n"),
            "mesh.ply:16: '3' follows the last element: correct the counts of the header");
  EXPECT_EQ(message("ply\nformat ascii 1.0\nelement vertex 4\nproperty quad x\n"),
            "mesh.ply:4: 'quad' is not a PLY type: char to double, or int8 to float64");
}

TEST(ply, false_promises_cost_nothing) {
  for (const std::string count : {"4000000000", "18446744073709551615", "4000000000000000000"}) {
    for (const char* element : {"vertex 4", "face 2"}) {
      std::string bent = head;
      bent.replace(bent.find(element) + std::string(element).size() - 1, 1, count);
      EXPECT_NE(message(bent + vertices + faces).find("more than the file can hold"), std::string::npos);
    }
  }
  std::string listed = head;
  listed.replace(listed.find("uchar"), 5, "uint");
  EXPECT_NE(message(listed + vertices + "3 0 2 1\n4000000000 0 1 3 2\n").find("face 1"), std::string::npos);
}

TEST(ply, ascii_numbers_must_fit_the_types_of_the_header) {
  const auto with_marks = [](const std::string& type, const std::string& count, int values) {
    std::string file = head;
    file.insert(file.find("property list"), "property list " + type + " int marks\n");
    std::string marked = count;
    for (int i = 0; i < values; ++i) marked += " 7";
    return file + vertices + marked + " 3 0 2 1\n0 4 0 1 3 2\n";
  };
  EXPECT_EQ(parse(with_marks("uchar", "255", 255)).face_count(), 2u);
  EXPECT_EQ(parse(with_marks("char", "127", 127)).face_count(), 2u);
  EXPECT_EQ(parse(with_marks("short", "256", 256)).face_count(), 2u);
  for (const auto& [type, count, values] :
       {std::tuple("uchar", "256", 256), {"char", "128", 128}, {"uint", "-1", 0}}) {
    EXPECT_NE(message(with_marks(type, count, values)).find("does not fit the type " + std::string(type)),
              std::string::npos);
  }
  EXPECT_NE(message(with_marks("char", "-1", 0)).find("-1 is not a number of values"), std::string::npos);
}

TEST(ply, a_header_of_mixed_line_ends_is_refused_unless_a_cr_stands_before_lf) {
  std::string bent = head;
  const std::size_t at = bent.find("4\n") + 1;
  bent.insert(at, "\r");
  EXPECT_EQ(parse(bent + vertices + faces).vertex_count(), 4u);
  bent.erase(at + 1, 1);
  EXPECT_EQ(message(bent + vertices + faces),
            "mesh.ply:3: some lines of the header end with CR and some with LF");
}

TEST(ply, two_lists_of_corners_are_refused) {
  std::string bent = head;
  bent.insert(bent.find("end_header"), "property list uchar int vertex_index\n");
  EXPECT_EQ(message(bent + vertices + "3 0 2 1 3 0 1 2\n3 0 1 3 3 0 3 1\n"),
            "mesh.ply:7: the faces have two lists of corners");
}

TEST(ply, triangle_strips_are_refused_unless_there_are_none) {
  const std::string strips = "property list int int vertex_indices\nend_header\n";
  std::string bent = head;
  bent.replace(bent.find("end_header\n"), 11, "element tristrips 1\n" + strips);
  EXPECT_EQ(message(bent + vertices + faces + "3 0 1 2\n"),
            "mesh.ply:9: the file contains triangle strips: convert them to faces");
  bent.replace(bent.find("tristrips 1"), 11, "tristrips 0");
  EXPECT_EQ(parse(bent + vertices + faces).face_count(), 2u);
}

TEST(ply, headers_that_announce_without_end_are_refused) {
  std::string names = "ply\nformat ascii 1.0\n", properties = names + "element vertex 3\n";
  for (int i = 0; i < 2000; ++i) {
    names += "element e" + std::to_string(i) + " 0\n";
    properties += "property int p" + std::to_string(i) + '\n';
  }
  EXPECT_NE(message(names + "end_header\n").find("more than 1000 kinds"), std::string::npos);
  EXPECT_NE(message(properties + "end_header\n").find("more than 1000 properties"), std::string::npos);
}

TEST(ply, every_truncation_is_refused) {
  const ControlMesh mesh = parse(head + vertices + faces);
  for (const PlyForm format : formats) {
    const std::string file = ply_of(mesh, format);
    const std::size_t end = format == PlyForm::ascii ? file.size() - 2 : file.size();
    for (std::size_t size = 0; size < end; ++size) {
      EXPECT_FALSE(message(file.substr(0, size)).empty()) << size;
    }
  }
}

TEST(ply, flipped_bytes_are_read_or_refused) {
  const ControlMesh plain = parse(head + vertices + faces);
  std::mt19937_64 random(5);
  for (int i = 0; i < 20'000; ++i) {
    std::string bent = ply_of(plain, formats[random() % 3]);
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
}  // namespace snug::ply_test
