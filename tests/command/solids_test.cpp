// collide, distance and closest about solids, as people script them.

#include <gtest/gtest.h>

#include <testing/counts.h>
#include <array>
#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>
#include <vector>

#include "run_snug.h"

namespace snug::testing::solids_test {
namespace {

using nlohmann::json;

/// A prism with triangles above and below and quads around: under Catmull-Clark the triangles' first split
/// meets quads.
constexpr const char* prism =
    "v 0 0 -1\nv 2 0 -1\nv 0.7 1.8 -1\nv 0 0 1\nv 2 0 1\nv 0.7 1.8 1\n"
    "f 3 2 1\nf 4 5 6\nf 1 2 5 4\nf 2 3 6 5\nf 3 1 4 6\n";

std::string cube(double x, double y, double z, double half) {
  std::string obj;
  for (int i = 0; i < 8; ++i) {
    obj += "v " + std::to_string(x + (i & 1 ? half : -half)) + " " +
           std::to_string(y + (i & 2 ? half : -half)) + " " + std::to_string(z + (i & 4 ? half : -half)) +
           "\n";
  }
  return obj + "f 1 3 4 2\nf 5 6 8 7\nf 1 2 6 5\nf 3 7 8 4\nf 1 5 7 3\nf 2 4 8 6\n";
}

class solids : public ::testing::Test {
 protected:
  std::string write(const std::string& name, const std::string& text) {
    std::ofstream(folder_.file(name)) << text;
    return folder_.file(name);
  }
  static json answer(std::vector<std::string> arguments, int status = 0) {
    arguments.emplace_back("--json");
    const Outcome outcome = run_snug(arguments);
    EXPECT_EQ(outcome.status, status) << outcome.err;
    return json::parse(outcome.out, nullptr, false);
  }

  TemporaryFolder folder_;
};

// Two cubes in one file; the second one turned inside out on request.
std::string two_cubes(double x, double half, bool turned) {
  std::string obj = cube(0, 0, 0, 1);
  const std::string second = cube(x, 0, 0, half);
  obj += second.substr(0, second.find("f "));
  const std::array<std::array<int, 4>, 6> faces{
      {{1, 3, 4, 2}, {5, 6, 8, 7}, {1, 2, 6, 5}, {3, 7, 8, 4}, {1, 5, 7, 3}, {2, 4, 8, 6}}};
  for (const auto& face : faces) {
    obj += "f";
    for (std::size_t k = 0; k < 4; ++k) obj += " " + std::to_string(8 + face[turned ? 3 - k : k]);
    obj += "\n";
  }
  return obj;
}

TEST_F(solids, info_names_a_shell_within_another_one_that_is_turned_the_same_way) {
  std::uint64_t number = 0;
  struct Case {
    const char* name;
    std::string obj;
    bool twice;
  };
  for (const auto& [name, obj, twice] : {Case{"shell", two_cubes(0, 0.5, false), true},
                                         {"cavity", two_cubes(0, 0.5, true), false},
                                         {"overlapping", two_cubes(0.5, 0.8, false), true},
                                         {"overlapping by a corner", two_cubes(1.2, 0.8, false), true},
                                         {"small", two_cubes(0, 0.002, false), true},
                                         {"the same", two_cubes(0, 1, false), true},
                                         {"apart", two_cubes(3, 1, false), false},
                                         {"apart and turned", two_cubes(3, 1, true), false}}) {
    const std::string mesh = write("two.obj", obj);
    for (const char* scheme : {"bilinear", "catmark", "doo-sabin"}) {
      if (!testing::has_turn(number++)) continue;
      const json found = answer({"info", mesh, "--scheme", scheme});
      EXPECT_EQ(found.value("overlapping_shell", json()).is_number(), twice) << name << ", " << scheme;
      const bool said =
          run_snug({"info", mesh, "--scheme", scheme}).out.find("turned the same way") != std::string::npos;
      EXPECT_EQ(said, twice) << name << ", " << scheme;
    }
  }
}

TEST_F(solids, info_says_which_edge_keeps_a_surface_from_being_closed) {
  std::string turned = cube(0, 0, 0, 1);
  turned.replace(turned.find("f 1 3 4 2"), 9, "f 2 4 3 1");
  const Outcome outcome = run_snug({"info", write("turned.obj", turned), "--scheme", "bilinear"});
  EXPECT_NE(outcome.out.find("not closed: edge (1, 3) of face 0 does not cancel: 2 faces run from 1 to 3"),
            std::string::npos)
      << outcome.out;
}

TEST_F(solids, polygons_beside_quads_are_told_from_inside_and_outside) {
  const std::string part = write("prism.obj", prism);
  // Beside the edges along which the triangles' first splits meet quads, and in the middle.
  for (const auto& [x, y, z, inside] : {std::array<double, 4>{0.9, 0.6, 0, 1},
                                        {0.9, 0.6, 0.55, 1},
                                        {1, 0.35, 0.3, 1},
                                        {0.9, 0.6, 0.95, 0},
                                        {1, 0.02, 0.9, 0},
                                        {0.1, 0.1, -0.9, 0}}) {
    const std::string small = write("small.obj", cube(x, y, z, 0.01));
    const json found = answer({"collide", part, small, "--scheme", "catmark", "--solid", "--tolerance", "0"});
    EXPECT_EQ(found["verdict"], inside != 0 ? "intersecting" : "separated") << x << ' ' << y << ' ' << z;
    EXPECT_EQ(found["contained"], inside != 0 ? json("b") : json(nullptr));
    const json gap = answer({"distance", small, part, "--scheme", "catmark", "--solid"});
    EXPECT_EQ(gap["distance"][0] == 0, inside != 0);
    EXPECT_EQ(gap["contained"], inside != 0 ? json("a") : json(nullptr));
    if (inside != 0) {
      EXPECT_EQ(found["distance"], json({0, 0}));
      EXPECT_EQ(found["witness"][0], found["witness"][1]);
    }
  }
}

TEST_F(solids, a_part_inside_of_another_is_named_in_a_note) {
  const std::string outer = write("outer.obj", cube(0, 0, 0, 1)),
                    inner = write("inner.obj", cube(0, 0, 0, 0.1));
  for (const char* command : {"collide", "distance"}) {
    const Outcome outcome = run_snug({command, inner, outer});
    EXPECT_EQ(outcome.status, 0);
    EXPECT_NE(outcome.err.find("A or a part of it lies inside B"), std::string::npos) << outcome.err;
    EXPECT_NE(outcome.err.find("--solid"), std::string::npos);
    EXPECT_EQ(run_snug({command, inner, outer, "--quiet"}).err, "");
    EXPECT_EQ(run_snug({command, inner, outer, "--solid"}).err, "");
  }
}

TEST_F(solids, open_surfaces_are_refused_wherever_they_are) {
  const std::string closed = write("closed.obj", cube(0, 0, 0, 1)),
                    open = write("open.obj", "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1 2 3 4\n"),
                    points = write("points.txt", "0 0 0\n");
  for (const char* place : {"1 0 0 0  0 1 0 0  0 0 1 0", "1 0 0 1e6  0 1 0 0  0 0 1 0"}) {
    for (const char* command : {"collide", "distance"}) {
      const Outcome outcome = run_snug({command, closed, open, "--solid", "--place-b", place});
      EXPECT_EQ(outcome.status, 4);
      EXPECT_NE(
          outcome.err.find("open.obj: solids are bounded by closed surfaces, and edge (0, 1) of face 0"),
          std::string::npos)
          << outcome.err;
      EXPECT_TRUE(outcome.out.empty());
    }
  }
  EXPECT_EQ(run_snug({"closest", open, "--points", points, "--signed"}).status, 4);
  EXPECT_EQ(run_snug({"collide", closed, closed, "--penetration"}).status, 2);
}

// Boxes [x, x + 1] x [y, y + 1] x [0, 1] of triangles.
std::string box_of_triangles(double x, double y, int first) {
  std::string obj;
  for (int i = 0; i < 8; ++i) {
    obj += "v " + std::to_string(x + (i & 1)) + " " + std::to_string(y + (i >> 1 & 1)) + " " +
           std::to_string(i >> 2) + "\n";
  }
  for (const auto& f : std::vector<std::array<int, 3>>{{1, 3, 4},
                                                       {1, 4, 2},
                                                       {5, 6, 8},
                                                       {5, 8, 7},
                                                       {1, 2, 6},
                                                       {1, 6, 5},
                                                       {3, 7, 8},
                                                       {3, 8, 4},
                                                       {1, 5, 7},
                                                       {1, 7, 3},
                                                       {2, 4, 8},
                                                       {2, 8, 6}}) {
    obj += "f " + std::to_string(first + f[0]) + " " + std::to_string(first + f[1]) + " " +
           std::to_string(first + f[2]) + "\n";
  }
  return obj;
}

TEST_F(solids, need_not_be_manifold_where_edges_cancel) {
  // Two boxes that share the edge x = y = 1 once welded; and one with a membrane z = 0, its bottom, turned both ways.
  const std::string two = write("two.obj", box_of_triangles(0, 0, 0) + box_of_triangles(1, 1, 8)),
                    one = write("one.obj", box_of_triangles(0, 0, 0) + "f 1 4 6\nf 6 4 1\n"),
                    points = write("points.txt", "0.5 0.5 0.5\n1.5 1.5 0.5\n1.5 0.5 0.5\n");
  const json measured = answer({"measure", two, "--scheme", "flat", "--weld", "0"});
  ASSERT_EQ(measured["closed"], true);
  EXPECT_LE(measured["volume"][0], 2);
  EXPECT_GE(measured["volume"][1], 2);
  const json found =
      answer({"closest", two, "--scheme", "flat", "--weld", "0", "--signed", "--points", points});
  EXPECT_EQ(found["results"][0]["inside"], true);
  EXPECT_EQ(found["results"][1]["inside"], true);
  EXPECT_EQ(found["results"][2]["inside"], false);
  for (const char* scheme : {"flat", "bilinear"}) {
    const json membrane = answer({"measure", one, "--scheme", scheme});
    ASSERT_EQ(membrane["closed"], true) << scheme;
    EXPECT_LE(membrane["volume"][0], 1);
    EXPECT_GE(membrane["volume"][1], 1);
  }
}

TEST_F(solids, what_does_not_cancel_is_named_with_a_vertex_on_it) {
  // The top edge y = 0 is split in one of its two faces alone; or a face of a box is there twice.
  std::string split = box_of_triangles(0, 0, 0);
  split.replace(split.find("f 1 6 5"), 7, "v 0.5 0 1\nf 1 6 9\nf 1 9 5");
  const Outcome junction = run_snug({"measure", write("split.obj", split), "--scheme", "flat"});
  EXPECT_NE(junction.out.find(
                "volume    none: edge (4, 5) of face 2 does not cancel: 1 face runs from 4 to 5 and 0 "
                "back; vertex 8 lies on it"),
            std::string::npos)
      << junction.out;
  const std::string twice = write("twice.obj", box_of_triangles(0, 0, 0) + "f 1 3 4\n"),
                    turned = write("turned.obj", box_of_triangles(0, 0, 0) + "f 4 3 1\n");
  for (const std::string& mesh : {twice, turned}) {
    EXPECT_NE(run_snug({"measure", mesh, "--scheme", "flat"}).out.find("volume    none: edge (0, 2)"),
              std::string::npos);
  }
}

TEST_F(solids, signed_distances_have_a_proved_sign) {
  const std::string ball = write("ball.obj", cube(0, 0, 0, 1)),
                    points = write("points.txt", "0 0 0\n3 0 0\n0.1 0.2 -0.3\n");
  const json found = answer({"closest", ball, "--points", points, "--signed"});
  EXPECT_EQ(found["results"][0]["inside"], true);
  EXPECT_EQ(found["results"][1]["inside"], false);
  EXPECT_EQ(found["results"][2]["inside"], true);
  for (const json& result : found["results"]) {
    const bool inside = result["inside"];
    EXPECT_EQ(result["signed_distance"][0],
              inside ? json(-result["distance"][1].get<double>()) : result["distance"][0]);
    EXPECT_EQ(result["signed_distance"][1],
              inside ? json(-result["distance"][0].get<double>()) : result["distance"][1]);
  }
}

TEST_F(solids, penetration_says_where_its_precision_was_missed_and_proves_contact) {
  const std::string box = write("box.obj", box_of_triangles(0, 0, 0));
  // The same solid twice: its surfaces are as near as can be, and its depth shows that it meets itself.
  const json same = answer({"collide", box, box, "--scheme", "flat", "--solid", "--penetration"});
  EXPECT_EQ(same["verdict"], "intersecting");
  EXPECT_EQ(same["distance"], json({0, 0}));
  EXPECT_GT(same["penetration"]["depth"][0], 0.9);
  // Tetrahedra that cross edge over edge: with or without the precision, words and status agree.
  const std::string tetra =
      write("tetra.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n");
  for (const char* move : {"0.1 0.2 0.3", "0.3 0.3 -0.2", "-0.4 0.2 0.1", "0.2 -0.3 0.35"}) {
    std::vector<std::string> asked{"collide", tetra,           tetra,      "--scheme", "flat",
                                   "--solid", "--penetration", "--move-b", move};
    const Outcome text = run_snug(asked);
    asked.emplace_back("--json");
    const Outcome outcome = run_snug(asked);
    const json found = json::parse(outcome.out);
    const bool reached = found["penetration"]["outcome"] == "complete";
    EXPECT_EQ(outcome.status, reached ? 0 : 5) << move;
    EXPECT_EQ(text.status, outcome.status) << move;
    EXPECT_EQ(text.out.find("differ by more than 5 %") == std::string::npos, reached) << text.out;
    double square = 0;
    for (const double x : found["penetration"]["translation"]) square += x * x;
    EXPECT_LE(std::sqrt(square), found["penetration"]["depth"][1]) << move;
  }
}

TEST_F(solids, penetration_is_bounded_by_a_translation_that_separates) {
  const std::string a = write("a.obj", cube(0, 0, 0, 1)), b = write("b.obj", cube(0.9, 0.1, 0, 1));
  const json found = answer({"collide", a, b, "--solid", "--penetration"});
  ASSERT_EQ(found["verdict"], "intersecting");
  const json& depth = found["penetration"]["depth"];
  EXPECT_GT(depth[0], 0);
  EXPECT_LE(depth[0], depth[1]);
  std::string place = "1 0 0 ";
  const json& d = found["penetration"]["translation"];
  place += d[0].dump() + " 0 1 0 " + d[1].dump() + " 0 0 1 " + d[2].dump();
  EXPECT_EQ(answer({"collide", a, b, "--solid", "--tolerance", "0", "--place-b", place})["verdict"],
            "separated");
  // Apart, nothing has to be done.
  const json none =
      answer({"collide", a, b, "--solid", "--penetration", "--place-b", "1 0 0 9 0 1 0 0 0 0 1 0"});
  EXPECT_EQ(none["penetration"]["depth"], json({0, 0}));
}

}  // namespace
}  // namespace snug::testing::solids_test
