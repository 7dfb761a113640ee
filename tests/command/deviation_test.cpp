// deviation, as people script it.

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <fstream>
#include <initializer_list>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "run_snug.h"

namespace snug::testing::deviation_test {
namespace {

using nlohmann::json;

enum class Faces { quads, triangles };

std::string cube(double side, double x, double y, double z, Faces faces) {
  std::string obj;
  for (int i = 0; i < 8; ++i) {
    obj += "v " + std::to_string(x + (i & 1 ? side : 0)) + " " + std::to_string(y + (i & 2 ? side : 0)) +
           " " + std::to_string(z + (i & 4 ? side : 0)) + "\n";
  }
  for (const auto& [a, b, c, d] : {std::array{1, 3, 4, 2},
                                   {5, 6, 8, 7},
                                   {1, 2, 6, 5},
                                   {3, 7, 8, 4},
                                   {1, 5, 7, 3},
                                   std::array{2, 4, 8, 6}}) {
    const auto line = [&](std::initializer_list<int> corners) {
      obj += "f";
      for (const int v : corners) obj += " " + std::to_string(v);
      obj += "\n";
    };
    if (faces == Faces::quads) {
      line({a, b, c, d});
    } else {
      line({a, b, c});
      line({a, c, d});
    }
  }
  return obj;
}

class deviation : public ::testing::Test {
 protected:
  std::string write(const std::string& name, const std::string& text) {
    std::ofstream(folder_.file(name)) << text;
    return folder_.file(name);
  }
  static json answer(std::vector<std::string> arguments, int status = 0) {
    arguments.insert(arguments.begin(), "deviation");
    arguments.emplace_back("--json");
    const Outcome outcome = run_snug(arguments);
    EXPECT_EQ(outcome.status, status) << outcome.err;
    return json::parse(outcome.out, nullptr, false);
  }
  static Outcome run(std::vector<std::string> arguments) {
    arguments.insert(arguments.begin(), "deviation");
    return run_snug(arguments);
  }
  static void expect_interval(const json& found, double truth, double width) {
    ASSERT_EQ(found.size(), 2u);
    EXPECT_LE(found[0], truth * (1 + 1e-15));
    EXPECT_GE(found[1], truth * (1 - 1e-15));
    EXPECT_LE(found[1].get<double>() - found[0].get<double>(), width);
  }

  TemporaryFolder folder_;
  std::string quads_ = write("quads.obj", cube(1, 0, 0, 0, Faces::quads));
  std::string moved_ = write("moved.obj", cube(1, 0.25, 0, 0, Faces::triangles));
};

TEST_F(deviation, has_an_interval_and_points_both_ways) {
  const std::string large = write("large.obj", cube(3, -1, -1, -1, Faces::triangles));
  const json found = answer({quads_, large, "--scheme", "bilinear", "--absolute", "1e-5"});
  EXPECT_EQ(found["command"], "deviation");
  EXPECT_EQ(found["mesh"], json({quads_, large}));
  EXPECT_EQ(found["scheme"], json({"bilinear", "flat"}));
  EXPECT_EQ(found["absolute"], 1e-5);
  EXPECT_EQ(found["threshold"], json(nullptr));
  EXPECT_EQ(found["verdict"], json(nullptr));
  EXPECT_EQ(found["outcome"], "complete");
  expect_interval(found["from_surface"], 1, 1e-5);
  expect_interval(found["from_candidate"], std::sqrt(3.0), 1e-5);
  for (std::size_t way = 0; way < 2; ++way) {
    double square = 0;
    for (std::size_t x = 0; x < 3; ++x)
      square +=
          std::pow(found["points"][way][0][x].get<double>() - found["points"][way][1][x].get<double>(), 2);
    EXPECT_NEAR(std::sqrt(square), way == 0 ? 1 : std::sqrt(3.0), 1e-5);
    EXPECT_LE(found["points_error"][way], 1e-11);
  }
  EXPECT_TRUE(found["points_at"][0].contains("face"));
  EXPECT_TRUE(found["points_at"][0].contains("u"));
  EXPECT_EQ(found["points_at"][1], json(nullptr));
  EXPECT_FALSE(found.contains("inside"));
  // A percentage is one of the mesh.
  EXPECT_EQ(answer({quads_, large, "--absolute", "1%"})["absolute"], 0.01);
  EXPECT_EQ(answer({quads_, large})["absolute"], 1e-4);
}

TEST_F(deviation, is_told_in_words_too) {
  const Outcome outcome = run({quads_, moved_, "--scheme", "bilinear", "--threshold", "0.5"});
  EXPECT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_NE(outcome.out.find("within: proved, no point of either is farther than 0.5"), std::string::npos)
      << outcome.out;
  EXPECT_NE(outcome.out.find("from the surface to the candidate"), std::string::npos);
  EXPECT_NE(outcome.out.find("from the candidate to the surface"), std::string::npos);
  EXPECT_EQ(outcome.err, "");
  EXPECT_NE(run({quads_, moved_, "--scheme", "bilinear", "--threshold", "0.1"}).out.find("exceeds: proved"),
            std::string::npos);
  EXPECT_NE(run({quads_, moved_, "--max-splits", "1"}).out.find("the precision was not reached"),
            std::string::npos);
}

TEST_F(deviation, answers_a_tolerance_with_a_verdict) {
  const std::vector<std::string> asked{quads_, moved_, "--scheme", "bilinear", "--threshold"};
  const auto with = [&](const std::string& tolerance, std::vector<std::string> more = {}) {
    std::vector<std::string> all = asked;
    all.push_back(tolerance);
    all.insert(all.end(), more.begin(), more.end());
    return all;
  };
  EXPECT_EQ(answer(with("0.3"))["verdict"], "within");
  EXPECT_EQ(answer(with("30%"))["threshold"], 0.3);
  EXPECT_EQ(answer(with("0.2"))["verdict"], "exceeds");
  EXPECT_EQ(answer(with("0"))["verdict"], "exceeds");
  EXPECT_EQ(run(with("0.3", {"--exit-code"})).status, 0);
  EXPECT_EQ(run(with("0.2", {"--exit-code"})).status, 13);
  // Coarse as it may be, the distance is the tolerance.
  EXPECT_EQ(answer(with("0.25", {"--absolute", "0.01"}), 5)["verdict"], "undecided");
  const Outcome undecided = run(with("0.25", {"--absolute", "0.01", "--exit-code"}));
  EXPECT_EQ(undecided.status, 12);
  EXPECT_NE(undecided.out.find("give a smaller --absolute"), std::string::npos) << undecided.out;
  EXPECT_EQ(run({quads_, moved_, "--exit-code"}).status, 2);
  EXPECT_EQ(run(with("-1")).status, 2);
  EXPECT_EQ(run({quads_, moved_, "--absolute", "0"}).status, 2);
}

TEST_F(deviation, on_each_side_of_a_solid) {
  const std::string inner = write("inner.obj", cube(0.5, 0.25, 0.25, 0.25, Faces::triangles)),
                    outer = write("outer.obj", cube(3, -1, -1, -1, Faces::triangles));
  const json in = answer({quads_, inner, "--scheme", "bilinear", "--solid"});
  expect_interval(in["inside"], 0.25, 1e-4);
  EXPECT_EQ(in["outside"], json({0, 0}));
  EXPECT_EQ(in["outside_points"], json(nullptr));
  EXPECT_EQ(in["inside_points"].size(), 2u);
  const json out = answer({quads_, outer, "--scheme", "bilinear", "--solid"});
  expect_interval(out["outside"], std::sqrt(3.0), 1e-4);
  EXPECT_EQ(out["inside"], json({0, 0}));
  const Outcome words = run({quads_, inner, "--scheme", "bilinear", "--solid"});
  EXPECT_NE(words.out.find("outside the solid: 0, proved"), std::string::npos) << words.out;
  const std::string open = write("open.obj", "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1 2 3 4\n");
  const Outcome refused = run({open, inner, "--solid"});
  EXPECT_EQ(refused.status, 4);
  EXPECT_NE(refused.err.find("open.obj: solids are bounded by closed surfaces"), std::string::npos)
      << refused.err;
}

TEST_F(deviation, of_two_control_meshes_is_that_of_their_surfaces) {
  const json same = answer({quads_, quads_, "--surface"});
  EXPECT_EQ(same["scheme"], json({"catmark", "catmark"}));
  EXPECT_LE(same["from_surface"][1], 1e-4);
  EXPECT_TRUE(same["points_at"][1].contains("face"));
  const json other = answer({quads_, moved_, "--surface", "--scheme-b", "loop"});
  EXPECT_EQ(other["scheme"], json({"catmark", "loop"}));
  EXPECT_GT(other["from_surface"][0], 0);
  EXPECT_EQ(run({quads_, moved_, "--scheme-b", "loop"}).status, 2);
  EXPECT_EQ(run({quads_, moved_, "--bounds", "table"}).status, 2);
}

// Any triangles are good: no mesh has to be made of them.
TEST_F(deviation, takes_triangles_however_they_are) {
  const std::string soup = write("soup.obj",
                                 "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 2 2 2\nv 9 9 9\n"
                                 "f 1 2 3\nf 1 2 3\nf 3 2 1\nf 1 2 4\nf 1 1 1\nf 1 2 2\n");
  EXPECT_EQ(answer({quads_, soup, "--scheme", "bilinear"})["outcome"], "complete");
  for (const char* name : {"unit.off", "unit.ply", "unit.stl"}) {
    const std::string file = folder_.file(name);
    ASSERT_EQ(
        run_snug({"subdivide", moved_, "--level", "0", "--scheme", "flat", "--quiet", "-o", file}).status, 0);
    expect_interval(answer({quads_, file, "--scheme", "bilinear"})["from_surface"], 0.25, 1e-4);
  }
}

TEST_F(deviation, of_what_is_no_triangle_is_refused) {
  const Outcome quad = run({quads_, quads_});
  EXPECT_EQ(quad.status, 4);
  EXPECT_NE(quad.err.find("quads.obj: face 0 has 4 corners"), std::string::npos) << quad.err;
  EXPECT_NE(quad.err.find("--surface"), std::string::npos) << quad.err;
  const Outcome late =
      run({quads_, write("late.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 1 1 0\nf 1 2 3\nf 1 2 4 3\n")});
  EXPECT_NE(late.err.find("late.obj: face 1 has 4 corners"), std::string::npos) << late.err;
  const Outcome none = run({quads_, write("none.obj", "v 0 0 0\nv 1 0 0\nl 1 2\n")});
  EXPECT_EQ(none.status, 4);
  EXPECT_NE(none.err.find("none.obj: there are no triangles"), std::string::npos) << none.err;
  EXPECT_EQ(run({quads_, write("nan.obj", "v 0 0 nan\nv 1 0 0\nv 0 1 0\nf 1 2 3\n")}).status, 3);
  EXPECT_EQ(run({quads_, folder_.file("missing.obj")}).status, 3);
  const Outcome fine = run({quads_, moved_, "--precision", "1e-13"});
  EXPECT_EQ(fine.status, 4);
  EXPECT_NE(fine.err.find("precision"), std::string::npos) << fine.err;
}

TEST_F(deviation, that_was_not_reached_is_status_5) {
  const json found = answer({quads_, moved_, "--max-splits", "1"}, 5);
  EXPECT_EQ(found["outcome"], "budget-spent");
  EXPECT_LE(found["from_surface"][0], found["from_surface"][1]);
}

}  // namespace
}  // namespace snug::testing::deviation_test
