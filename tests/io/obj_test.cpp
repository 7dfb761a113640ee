#include <snug/io/formats.h>

#include <bit>
#include <cmath>
#include <numbers>
#include <random>
#include <string>
#include <vector>

#include <testing/files.h>

namespace snug::obj_test {
namespace {

using testing::corners;
using testing::expect_same_arrays;
using testing::unreadable;
using Ids = std::vector<std::uint32_t>;

const std::string triangle = "v 0 0 0\nv 1 0 0\nv 0 1 0\n";

ControlMesh parse(const std::string& text) { return parse_obj(text, "mesh.obj"); }
std::string message(const std::string& text) {
  return unreadable([&] { static_cast<void>(parse(text)); });
}

TEST(obj, reads_vertices_and_faces_in_order) {
  const ControlMesh mesh = parse("v 0 0 0\nv 1 0.5 -2e3\nv 0 1 0\nv 1 1 0\nf 1 2 3\nf 4 3 2 1\n");
  ASSERT_EQ(mesh.vertex_count(), 4u);
  EXPECT_EQ(mesh.points[1], (Point3{1, 0.5, -2000}));
  ASSERT_EQ(mesh.face_count(), 2u);
  EXPECT_EQ(corners(mesh, 0), (Ids{0, 1, 2}));
  EXPECT_EQ(corners(mesh, 1), (Ids{3, 2, 1, 0}));
}

TEST(obj, resolves_negative_indices) {
  const ControlMesh mesh = parse(triangle + "f -3 -2 -1\nv 5 5 5\nf -1 -3 -2\n");
  EXPECT_EQ(corners(mesh, 0), (Ids{0, 1, 2}));
  EXPECT_EQ(corners(mesh, 1), (Ids{3, 1, 2}));
}

TEST(obj, resolves_forward_references) {
  EXPECT_EQ(corners(parse("f 3 2 1\n" + triangle), 0), (Ids{2, 1, 0}));
}

TEST(obj, takes_the_vertex_of_every_form_of_corner) {
  EXPECT_EQ(corners(parse(triangle + "f 1/7 2//8 3/7/8\nf 3/ 2// +1/-1/-1\n"), 1), (Ids{2, 1, 0}));
}

TEST(obj, ignores_weights_colours_and_what_is_no_surface) {
  const ControlMesh mesh =
      parse("o a\nv 1 2 3 0.5\nv 4 5 6 1 0 nan\nv 7 8 9 # c\nvn 0 0 1\nl 1 2\ng f v\nf 1 2 3\n");
  EXPECT_EQ(mesh.points[0], (Point3{1, 2, 3}));
  EXPECT_EQ(mesh.points[2], (Point3{7, 8, 9}));
  EXPECT_EQ(mesh.face_count(), 1u);
}

TEST(obj, reads_polylines_beside_faces_and_alone) {
  const ControlMesh mesh = parse("l 1 2/7\n" + triangle + "f 1 2 3\nl 1 2 -1 1\nl 3\n" + "v 9 9 9\n");
  ASSERT_EQ(mesh.polyline_count(), 3u);
  EXPECT_EQ(mesh.polyline(PolylineId(1)).size(), 4u);
  EXPECT_EQ(mesh.polyline(PolylineId(1))[2], VertexId(2));
  EXPECT_EQ(mesh.polyline(PolylineId(2)).size(), 1u);
  EXPECT_EQ(mesh.face_count(), 1u);
  expect_same_arrays(mesh, parse(format_obj(mesh)));
  const ControlMesh curve = parse(triangle + "l 1 2 3\n");
  EXPECT_EQ(curve.face_count(), 0u);
  EXPECT_EQ(curve.polyline_count(), 1u);
  expect_same_arrays(curve, parse(format_obj(curve)));
}

TEST(obj, bad_polylines_are_named) {
  EXPECT_EQ(message(triangle + "l 1 2\nl 1 2 0\n"),
            "mesh.obj:5: polyline 1: index 0 is not a vertex: OBJ counts from 1");
  EXPECT_EQ(message(triangle + "l 1 9\n"),
            "mesh.obj:4: polyline 0: index 9 is beyond the 3 vertices of the file");
  EXPECT_EQ(message(triangle + "l -4 1\n"),
            "mesh.obj:4: polyline 0: index -4 goes back beyond the first of the 3 vertices above this line");
  EXPECT_EQ(message(triangle + "l\n"), "mesh.obj:4: polyline 0 has no vertices");
  EXPECT_NE(message(triangle + "l 1 2.5\n").find("polyline 0: '2.5' is not a corner"), std::string::npos);
}

TEST(obj, reads_the_old_name_of_faces) { EXPECT_EQ(parse(triangle + "fo 1 2 3\n").face_count(), 1u); }

TEST(obj, continues_faces_but_not_comments) {
  const ControlMesh mesh = parse("# c:\\\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 \\\r\n2 \\\n3");
  EXPECT_EQ(mesh.vertex_count(), 3u);
  EXPECT_EQ(corners(mesh, 0), (Ids{0, 1, 2}));
}

TEST(obj, keeps_defective_faces_as_they_stand) {
  const ControlMesh mesh = parse(triangle + "f 1 1 2\nf 1 2\nf 3\nf 1 2 3\nf 1 2 3\n");
  EXPECT_EQ(corners(mesh, 0), (Ids{0, 0, 1}));
  EXPECT_EQ(corners(mesh, 1), (Ids{0, 1}));
  EXPECT_EQ(corners(mesh, 2), (Ids{2}));
  EXPECT_EQ(mesh.face_count(), 5u);
}

TEST(obj, reads_a_vertex_of_valence_1000) {
  const std::size_t valence = 1000;
  std::string text = "v 0 0 1\n";
  for (std::size_t i = 0; i < valence; ++i) {
    const double angle = 2 * std::numbers::pi * static_cast<double>(i) / static_cast<double>(valence);
    text += "v " + std::to_string(std::cos(angle)) + ' ' + std::to_string(std::sin(angle)) + " 0\n";
  }
  std::string rim = "f";
  for (std::size_t i = 0; i < valence; ++i) {
    text += "f 1 " + std::to_string(i + 2) + ' ' + std::to_string((i + 1) % valence + 2) + '\n';
    rim += ' ' + std::to_string(valence + 1 - i);
  }
  const ControlMesh mesh = parse(text + rim);
  ASSERT_EQ(mesh.face_count(), valence + 1);
  EXPECT_EQ(corners(mesh, valence - 1), (Ids{0, 1000, 1}));
  EXPECT_EQ(mesh.face(FaceId(valence)).size(), valence);
  expect_same_arrays(mesh, parse(format_obj(mesh)));
}

TEST(obj, written_doubles_are_read_bit_by_bit) {
  std::mt19937_64 random(3);
  ControlMesh mesh;
  while (mesh.vertex_count() < 20'000) {
    const Point3 point{std::bit_cast<double>(random()), std::bit_cast<double>(random() >> 12),
                       std::bit_cast<double>(random() | 0x7fe0000000000000u) * 0x1p-1000};
    if (is_finite(point)) mesh.points.push_back(point);
  }
  mesh.points.push_back({-0.0, 5e-324, -1.7976931348623157e308});
  for (std::size_t face = 0; face < 1000; ++face) {
    std::vector<VertexId> cycle;
    for (std::size_t k = 0; k <= face % 7; ++k) cycle.emplace_back(random() % mesh.vertex_count());
    mesh.add_face(cycle);
  }
  expect_same_arrays(mesh, parse(format_obj(mesh)));
}

TEST(obj, bad_coordinates_are_named) {
  EXPECT_EQ(message("v 0 0 0\nv 1 nan 0\nf 1 2 2\n"), "mesh.obj:2: vertex 1: 'nan' is not a finite number");
  EXPECT_EQ(message("v 0 0 0\nv 1 \\\n1e400 0\n"), "mesh.obj:3: vertex 1: '1e400' is too large for a double");
  EXPECT_EQ(message("v 0 0\nv 1 0 0\n"), "mesh.obj:1: vertex 0 has fewer than three coordinates");
}

TEST(obj, bad_indices_are_named) {
  EXPECT_EQ(message(triangle + "f 1 2 3\nf 1 2 0\n"),
            "mesh.obj:5: face 1: index 0 is not a vertex: OBJ counts from 1");
  EXPECT_EQ(message(triangle + "f 1 4 3\n\nf 1 9 3\nf 1 2 3\n"),
            "mesh.obj:6: face 1: index 9 is beyond the 3 vertices of the file");
  EXPECT_EQ(message(triangle + "f -4 1 2\n"),
            "mesh.obj:4: face 0: index -4 goes back beyond the first of the 3 vertices above this line");
}

TEST(obj, a_corner_that_only_begins_well_is_refused) {
  for (const char* corner : {"1.0", "1/a", "1/2/3/4", "1//2/", "/1", "a", "1\\2", "0x1", "1,", "-"}) {
    EXPECT_NE(message(triangle + "f 1 2 " + corner + '\n').find("is not a corner"), std::string::npos)
        << corner;
  }
}

TEST(obj, smf_blocks_that_move_vertices_are_refused) {
  EXPECT_EQ(parse("#$SMF 1.0\nbegin\n" + triangle + "f 1 2 3\nend\n").face_count(), 1u);
  EXPECT_NE(message("begin\nscale 2 2 2\n" + triangle + "f 1 2 3\n").find("SMF"), std::string::npos);
  EXPECT_NE(message(triangle + "f 1 2 3\nbegin\n").find("SMF"), std::string::npos);
}

TEST(obj, every_truncation_is_read_or_refused) {
  const std::string text = triangle + "f 1//1 -2/1 3\nt crease 2/1/0 0 1 2.5\nt creasemethod 0/0/1 chaikin\n";
  for (std::size_t size = 0; size < text.size(); ++size) {
    try {
      EXPECT_EQ(parse(text.substr(0, size)).face_count(), 1u);
    } catch (const InputError& error) {
      EXPECT_EQ(error.problem(), InputProblem::unreadable);
    }
  }
}

TEST(obj, flipped_bytes_are_read_or_refused) {
  const std::string text = triangle + "f 1//1 -2/1 3\nt crease 2/1/0 0 1 2.5\nt hole 1/0/0 0\n";
  std::mt19937_64 random(5);
  for (int i = 0; i < 20'000; ++i) {
    std::string bent = text;
    for (std::size_t k = 0; k <= random() % 3; ++k)
      bent[random() % bent.size()] = static_cast<char>(random());
    try {
      for (const VertexId vertex : parse(bent).face_vertices) ASSERT_LT(vertex.index(), 4u);
    } catch (const InputError& error) {
      ASSERT_EQ(std::string(error.what()).find('\n'), std::string::npos);
    }
  }
}

}  // namespace
}  // namespace snug::obj_test
