#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "run_snug.h"

namespace snug::testing::curve_test {
namespace {

using nlohmann::json;

const std::string points = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0.5\n";
const std::string open_line = points + "l 1 2 3 4\n";
const std::string closed_line = points + "l 1 2 3 4 1\n";

json answer(std::vector<std::string> arguments, const std::string& input, int status = 0) {
  arguments.emplace_back("--json");
  const Outcome outcome = run_snug(arguments, input);
  EXPECT_EQ(outcome.status, status) << arguments[0] << ": " << outcome.err;
  EXPECT_EQ(outcome.err, "");
  return json::parse(outcome.out);
}

void expect_refused(const std::vector<std::string>& arguments, const std::string& input, int status,
                    const std::string& about) {
  const Outcome outcome = run_snug(arguments, input);
  EXPECT_EQ(outcome.status, status) << arguments[0] << outcome.out;
  EXPECT_EQ(std::count(outcome.err.begin(), outcome.err.end(), '\n'), 1) << outcome.err;
  EXPECT_NE(outcome.err.find(about), std::string::npos) << outcome.err;
}

TEST(curve, bound_has_the_fields_of_the_contract) {
  for (const char* degree : {"2", "3"}) {
    const json document = answer({"bound", "-", "--degree", degree, "--error", "1%"}, open_line);
    EXPECT_EQ(document["command"], "bound");
    EXPECT_EQ(document["scheme"], "curve");
    EXPECT_EQ(document["degree"], std::stoi(degree));
    EXPECT_EQ(document["count"], document["enclosures"].size());
    EXPECT_EQ(document["outcome"], "complete");
    double largest = 0, covered = 0;
    for (const json& e : document["enclosures"]) {
      const auto piece = e["piece"].get<std::string>();
      EXPECT_EQ(piece.size(), e["level"].get<std::size_t>());
      EXPECT_EQ(piece.find_first_not_of("01"), std::string::npos);
      EXPECT_LT(e["edge"].get<int>(), 3);
      for (const char* key : {"lower", "upper", "base", "corners"}) {
        ASSERT_EQ(e[key].size(), 2u) << key;
        for (const json& p : e[key]) EXPECT_EQ(p.size(), 3u);
      }
      EXPECT_FALSE(e.contains("growth"));
      EXPECT_FALSE(e.contains("face"));
      largest = std::max(largest, e["radius"].get<double>());
      covered += 1.0 / static_cast<double>(1u << piece.size());
    }
    EXPECT_EQ(document["max_radius"], largest);
    EXPECT_LE(largest, 0.005);
    EXPECT_EQ(covered, 3);
  }
}

TEST(curve, bound_by_levels) { EXPECT_EQ(answer({"bound", "-", "--level", "3"}, closed_line)["count"], 32); }

TEST(curve, options_of_surfaces_are_refused) {
  const TemporaryFolder folder;
  const std::string out = folder.file("out.obj");
  for (const std::vector<std::string>& command :
       {std::vector<std::string>{"bound", "-"}, {"eval", "-"}, {"subdivide", "-", "-o", out}}) {
    auto bounded = command, of_degree = command;
    bounded.insert(bounded.end(), {"--boundary", "none"});
    expect_refused(bounded, open_line, 2, "--boundary is for surfaces; - is answered as curves");
    of_degree.insert(of_degree.end(), {"--degree", "2"});
    expect_refused(of_degree, "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n", 2,
                   "--degree is for curves; - is answered as a surface");
  }
}

TEST(curve, bound_that_runs_out_of_budget_ends_with_5) {
  const json document = answer({"bound", "-", "--error", "0.001%", "--max-splits", "4"}, open_line, 5);
  EXPECT_EQ(document["outcome"], "budget-spent");
  EXPECT_EQ(document["splits"], 4);
}

TEST(curve, eval_starts_and_ends_at_the_ends_of_an_open_polyline) {
  for (const char* degree : {"2", "3"}) {
    const json document = answer({"eval", "-", "--degree", degree, "--samples", "2"}, open_line);
    ASSERT_EQ(document["count"], 9);
    const json& list = document["points"];
    for (const json& p : list) {
      EXPECT_LT(p["error"].get<double>(), 1e-13);
      EXPECT_EQ(p["tangent"].size(), 3u);
    }
    EXPECT_EQ(list[0]["edge"], 0);
    EXPECT_EQ(list[0]["t"], 0.0);
    for (std::size_t a = 0; a < 3; ++a) {
      EXPECT_NEAR(list[0]["point"][a].get<double>(), 0, 1e-14);
      EXPECT_NEAR(list[8]["point"][a].get<double>(), (std::array{0.0, 1.0, 0.5}[a]), 1e-14);
    }
  }
}

TEST(curve, eval_answers_lines_of_a_file) {
  const TemporaryFolder folder;
  const std::string mesh = folder.file("curve.obj"), at = folder.file("at.txt");
  std::ofstream(mesh) << closed_line;
  std::ofstream(at) << "# edge t\n\n1 0.5\r\n3 1\n";
  const json document = answer({"eval", mesh, "--at", at}, "");
  ASSERT_EQ(document["points"].size(), 2u);
  EXPECT_EQ(document["points"][1]["edge"], 3);
  EXPECT_EQ(document["points"][1]["t"], 1.0);
  for (const char* bad : {"4 0", "0 1.5", "0", "0 0.5 1", "0 x", "-1 0", "0 nan"}) {
    std::ofstream(at) << bad << '\n';
    expect_refused({"eval", mesh, "--at", at}, "", 3, at + ":1: ");
  }
}

TEST(curve, subdivide_writes_polylines) {
  const TemporaryFolder folder;
  const std::string out = folder.file("out.obj");
  const auto lines_of = [&](const std::string& degree, const std::string& level, const std::string& input) {
    const json document = answer({"subdivide", "-", "--degree", degree, "--level", level, "-o", out}, input);
    EXPECT_EQ(document["polylines"], 1);
    EXPECT_EQ(document["faces"], 0);
    std::ifstream file(out);
    std::vector<std::string> lines;
    for (std::string line; std::getline(file, line);) lines.push_back(line);
    EXPECT_EQ(document["vertices"], lines.size() - 1);
    return lines;
  };
  const auto cubic = lines_of("3", "1", open_line);
  ASSERT_EQ(cubic.size(), 8u);
  EXPECT_EQ(cubic[0], "v 0 0 0");
  EXPECT_EQ(cubic[1], "v 0.5 0 0");
  EXPECT_EQ(cubic[2], "v 0.875 0.125 0");
  EXPECT_EQ(cubic[7], "l 1 2 3 4 5 6 7");
  const auto cut = lines_of("2", "1", closed_line);
  ASSERT_EQ(cut.size(), 9u);
  EXPECT_EQ(cut[0], "v 0.25 0 0");
  EXPECT_EQ(cut[1], "v 0.75 0 0");
  EXPECT_EQ(cut[8], "l 1 2 3 4 5 6 7 8 1");
  EXPECT_EQ(lines_of("3", "0", closed_line)[4], "l 1 2 3 4 1");
  EXPECT_EQ(run_snug({"bound", out}).status, 0);
  EXPECT_EQ(run_snug({"subdivide", "-", "--limit", "-o", "-"}, open_line).status, 0);
  expect_refused({"subdivide", "-", "-o", folder.file("out.ply")}, open_line, 2, ".obj files only");
}

TEST(curve, other_commands_refuse_in_one_sentence) {
  const TemporaryFolder folder;
  const std::string mesh = folder.file("curve.obj");
  std::ofstream(mesh) << open_line;
  const std::string about = mesh + ": it has polylines and no faces";
  expect_refused({"info", mesh}, "", 4, about);
  expect_refused({"collide", mesh, model("star.obj"), "--tolerance", "1%"}, "", 4, about);
  expect_refused({"render", mesh, "--scheme", "loop", "-o", folder.file("a.png")}, "", 4, about);
  expect_refused({"bound", mesh, "--scheme", "loop"}, "", 4, about);
  expect_refused({"bound", mesh, "--bounds", "table"}, "", 2, "--bounds table is for surfaces");
  expect_refused({"bound", mesh, "--normals"}, "", 2, "--normals is for surfaces");
  expect_refused({"bound", mesh, "--polyhedra", folder.file("a.obj")}, "", 2, "--polyhedra is for surfaces");
  expect_refused({"bound", mesh, "--degree", "4"}, "", 2, "--degree");
  expect_refused({"collide", model("star.obj"), model("star.obj"), "--tolerance", "1%", "--scheme", "curve"},
                 "", 4, "--scheme curve");
}

// The picture of a file by options, and its bytes.
std::string drawn(const std::string& mesh, const std::vector<std::string>& more, json* said = nullptr,
                  const char* size = "80") {
  const TemporaryFolder folder;
  const std::string file = folder.file("picture.png");
  std::vector<std::string> arguments{"render", mesh, "--size", size, "--samples", "1", "-o", file};
  arguments.insert(arguments.end(), more.begin(), more.end());
  const json document = answer(arguments, "");
  if (said) *said = document;
  std::ifstream stream(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(stream), {}};
}

TEST(curve, render_draws_curves_cages_and_enclosures) {
  const TemporaryFolder folder;
  const std::string mesh = folder.file("curve.obj");
  std::ofstream(mesh) << closed_line;
  json said;
  const std::string bare = drawn(mesh, {}, &said);
  EXPECT_EQ(said["scheme"], "curve");
  EXPECT_EQ(said["degree"], 3);
  EXPECT_EQ(said["enclosures"], 0);
  EXPECT_GT(said["hits"].get<int>(), 50);
  EXPECT_LT(said["hits"].get<int>(), 1000);  // of 6400: a line
  EXPECT_NE(drawn(mesh, {"--degree", "2"}, &said), bare);
  EXPECT_EQ(said["degree"], 2);
  EXPECT_NE(drawn(mesh, {"--cage"}), bare);
  EXPECT_NE(drawn(mesh, {"--enclosures", "--level", "2"}, &said), bare);
  EXPECT_EQ(said["enclosures"], 16);
  drawn(mesh, {"--enclosures", "--error", "1%"}, &said);
  EXPECT_EQ(said["enclosures"], answer({"bound", mesh, "--error", "1%"}, "")["count"]);
  // More pixels: more chords and sides.
  json coarse, fine;
  drawn(mesh, {}, &coarse, "40");
  drawn(mesh, {}, &fine, "800");
  EXPECT_GT(fine["triangles"].get<int>(), 2 * coarse["triangles"].get<int>());
  EXPECT_GT(fine["triangles"].get<int>(), 3000);  // 1296 with a chord an edge
  drawn(mesh, {"--enclosures", "--level", "12"}, &said, "20");
  EXPECT_EQ(said["enclosures"], 4 << 12);
}

TEST(curve, render_draws_curves_beside_surfaces) {
  const TemporaryFolder folder;
  const std::string mesh = folder.file("curve.obj"), far = "1 0 0 0  0 1 0 3  0 0 1 0",
                    here = "1 0 0 0  0 1 0 0  0 0 1 0";
  std::ofstream(mesh) << open_line;
  json said;
  const std::string both = drawn(mesh, {model("star.obj")}, &said);
  EXPECT_EQ(said["scheme"], json({"curve", "loop"}));
  EXPECT_NE(drawn(model("star.obj"), {mesh}), both);  // in other colours
  EXPECT_NE(drawn(mesh, {model("star.obj"), "--place", far}), both);
  EXPECT_EQ(drawn(mesh, {model("star.obj"), "--place", here}), both);
  drawn(mesh, {model("star.obj"), "--enclosures", "--level", "1", "--boundary", "none", "--degree", "2"},
        &said);
  EXPECT_EQ(said["enclosures"], 24 * 4 + 3 * 2);
}

TEST(curve, render_does_not_care_for_size_or_place) {
  const TemporaryFolder folder;
  const std::string mesh = folder.file("curve.obj");
  const auto scaled = [&](const std::string& unit) {
    std::ofstream(mesh) << "v 0 0 0\nv " << unit << " 0 0\nv " << unit << ' ' << unit << " 0\nl 1 2 3 1\n";
    return drawn(mesh, {"--cage"});
  };
  const std::string bare = scaled("1");
  for (const char* power : {"0.0009765625", "1024", "1099511627776"}) EXPECT_EQ(scaled(power), bare) << power;
  for (const char* unit : {"1e300", "1e-300", "1e-320"}) {
    std::ofstream(mesh) << "v 0 0 0\nv " << unit << " 0 0\nv " << unit << ' ' << unit << " 0\nl 1 2 3 1\n";
    json said;
    drawn(mesh, {"--cage"}, &said);
    EXPECT_GT(said["hits"].get<int>(), 50) << unit;
  }
  std::ofstream(mesh) << "v 1e9 1e9 0\nv 1000000001 1e9 0\nv 1e9 1000000001 0\nl 1 2 3 1\n";
  EXPECT_GT(drawn(mesh, {}).size(), 100u);
}

TEST(curve, render_draws_what_is_degenerate) {
  const TemporaryFolder folder;
  const std::string mesh = folder.file("curve.obj");
  for (const char* line : {"l 1 1\n", "l 1 1 1 1\n", "l 1 2 1\n", "l 1 2 2 2 2 1\n", "l 1 2 2 2 3 3 3 4 1\n",
                           "l 1 2 1 2\nl 3 3\n"}) {
    std::ofstream(mesh) << points << line;
    for (const std::vector<std::string>& more :
         {std::vector<std::string>{}, {"--cage"}, {"--degree", "2"}, {"--enclosures", "--level", "1"}}) {
      json said;
      drawn(mesh, more, &said);
      EXPECT_GT(said["hits"].get<int>(), 0) << line;
    }
  }
}

TEST(curve, render_refuses_in_one_sentence) {
  const TemporaryFolder folder;
  const std::string picture = folder.file("a.png"), mesh = folder.file("curve.obj");
  const auto refused = [&](std::vector<std::string> more, const std::string& input, int status,
                           const std::string& about) {
    std::ofstream(mesh) << input;
    more.insert(more.begin(), {"render", mesh, "-o", picture, "--quiet"});
    expect_refused(more, "", status, about);
  };
  refused({"--boundary", "none"}, open_line, 2, "--boundary is for surfaces; " + mesh);
  refused({"--bounds", "table", "--enclosures"}, open_line, 2, "--bounds table is for surfaces");
  refused({mesh, "--boundary", "none"}, open_line, 2, "all meshes are answered as curves");
  refused({"--degree", "2"}, points + "f 1 2 3\n", 2, "--degree is for curves; " + mesh);
  refused({"--scheme", "curve"}, points + "f 1 2 3\n", 4, "the mesh has no polylines");
  refused({}, "v 0 nan 0\nv 1 0 0\nl 1 2\n", 3, "vertex 0");
  refused({}, "v -1.7e308 0 0\nv 1.7e308 0 0\nl 1 2\n", 4, "no longer fits a double");
  std::string many = points + "l";
  for (int i = 0; i < 50'002; ++i) many += i % 2 == 0 ? " 1" : " 2";
  refused({}, many + "\n", 4, "50001 edges");
  refused({"--enclosures", "--level", "12"}, points + many.substr(points.size(), 201) + "\n", 4,
          "too many to draw");
  EXPECT_FALSE(std::ifstream(picture).good());
}

TEST(curve, polylines_beside_faces_are_answered_on_request) {
  const std::string both = points + "f 1 2 3\nl 1 2 3 4\n";
  EXPECT_EQ(answer({"bound", "-"}, both)["scheme"], "loop");
  EXPECT_EQ(answer({"bound", "-", "--scheme", "curve"}, both)["count"], 3);
  expect_refused({"bound", model("star.obj"), "--scheme", "curve"}, "", 4,
                 "star.obj: the mesh has no polylines");
}

TEST(curve, broken_polylines_are_named) {
  expect_refused({"bound", "-"}, points + "l 2\n", 4, "polyline 0 has 1 vertices");
  expect_refused({"bound", "-"}, points + "l 1 7\n", 3, "polyline 0: index 7 is beyond the 4 vertices");
  expect_refused({"eval", "-"}, points + "l 1 0\n", 3, "polyline 0: index 0");
  expect_refused({"eval", "-"}, "v 0 nan 0\nv 1 0 0\nl 1 2\n", 3, "vertex 0");
  expect_refused({"bound", "-"}, points + "l 1 2\nt corner 1/1/0 1 10\n", 4, "tagged as a corner");
  expect_refused({"eval", "-"}, "v -1.7e308 0 0\nv 1.7e308 0 0\nl 1 2\n", 4, "no longer fits a double");
}

}  // namespace
}  // namespace snug::testing::curve_test
