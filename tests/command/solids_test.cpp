// collide, distance and closest about solids, as people script them.

#include <gtest/gtest.h>

#include <fstream>
#include <nlohmann/json.hpp>

#include "run_snug.h"

namespace snug::testing {
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
    EXPECT_EQ(found["inner"], inside != 0 ? json("b") : json(nullptr));
    const json gap = answer({"distance", small, part, "--scheme", "catmark", "--solid"});
    EXPECT_EQ(gap["distance"][0] == 0, inside != 0);
    EXPECT_EQ(gap["inner"], inside != 0 ? json("a") : json(nullptr));
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
}  // namespace snug::testing
