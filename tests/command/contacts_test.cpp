// collide --all: what is printed, the document, and the file of curves.

#include <gtest/gtest.h>

#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>
#include <string>

#include "run_snug.h"

namespace snug::testing::contacts_test {
namespace {

using nlohmann::json;

TEST(contacts_command, lists_regions_and_curves) {
  const TemporaryFolder folder;
  const std::string curves = folder.file("curves.obj");
  const std::vector<std::string> arguments{
      "collide", model("bust.obj"), model("pawn.obj"), "--all", "--error", "0.2%", "--curves", curves};
  const Outcome text = run_snug(arguments);
  EXPECT_EQ(text.status, 0) << text.err;
  EXPECT_NE(text.out.find("region 0: intersecting"), std::string::npos) << text.out;
  EXPECT_NE(text.out.find("curve 0: closed"), std::string::npos) << text.out;
  std::vector<std::string> with_json = arguments;
  with_json.emplace_back("--json");
  const json answer = json::parse(run_snug(with_json).out);
  EXPECT_TRUE(answer["exhaustive"].get<bool>());
  ASSERT_EQ(answer["regions"].size(), 1u);
  EXPECT_EQ(answer["regions"][0]["verdict"], "intersecting");
  EXPECT_EQ(answer["regions"][0]["witness_at"].size(), 2u);
  EXPECT_FALSE(answer["regions"][0]["contacts"].empty());
  ASSERT_EQ(answer["curves"].size(), 1u);
  EXPECT_EQ(answer["curves"][0]["points"].size(), answer["curves"][0]["boxes"].size());
  std::ifstream file(curves);
  std::size_t vertices = 0, names = 0;
  for (std::string line; std::getline(file, line);) {
    if (line.starts_with("v ")) ++vertices;
    if (!line.starts_with("l ")) continue;
    std::istringstream words(line.substr(2));
    for (std::size_t name = 0; words >> name; ++names) EXPECT_LE(name, vertices);
  }
  EXPECT_EQ(vertices, answer["curves"][0]["points"].size());
  EXPECT_EQ(names, vertices + 1);  // closed
}

TEST(contacts_command, lists_areas_of_plane_faces) {
  const TemporaryFolder folder;
  const std::string cube = folder.file("cube.obj");
  std::ofstream(cube) << "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 0 0 1\nv 1 0 1\nv 1 1 1\nv 0 1 1\n"
                         "f 4 3 2 1\nf 5 6 7 8\nf 1 2 6 5\nf 2 3 7 6\nf 3 4 8 7\nf 4 1 5 8\n";
  const std::vector<std::string> arguments{"collide",  cube,       cube,        "--scheme",
                                           "bilinear", "--move-b", "0.3 0.2 1", "--all"};
  const Outcome text = run_snug(arguments);
  EXPECT_EQ(text.status, 0) << text.err;
  EXPECT_NE(text.out.find("area 0: a polygon of 4 corners, face 1 of A and face 0 of B"), std::string::npos)
      << text.out;
  std::vector<std::string> with_json = arguments;
  with_json.emplace_back("--json");
  const json answer = json::parse(run_snug(with_json).out);
  EXPECT_EQ(answer["outcome"], "complete");
  ASSERT_EQ(answer["areas"].size(), 1u);
  EXPECT_EQ(answer["areas"][0]["points"].size(), 4u);
  EXPECT_EQ(answer["areas"][0]["error"], 0);
  EXPECT_EQ(answer["areas"][0]["region"], 0);
  EXPECT_TRUE(answer["open"].empty());
}

TEST(contacts_command, is_coarser_with_a_small_budget_and_says_so) {
  const Outcome outcome =
      run_snug({"collide", model("bust.obj"), model("pawn.obj"), "--all", "--max-splits", "2000"});
  EXPECT_EQ(outcome.status, 5) << outcome.out;
  EXPECT_NE(outcome.out.find("budget"), std::string::npos) << outcome.out;
}

TEST(contacts_command, refuses_what_does_not_go_together) {
  const std::string a = model("star.obj");
  for (const std::vector<std::string>& more :
       std::vector<std::vector<std::string>>{{"--error", "1%"},
                                             {"--curves", "c.obj"},
                                             {"--all", "--solid"},
                                             {"--all", "--curves", "c.ply"},
                                             {"--all", "--error", "0"}}) {
    std::vector<std::string> arguments{"collide", a, a};
    arguments.insert(arguments.end(), more.begin(), more.end());
    EXPECT_EQ(run_snug(arguments).status, 2) << more.back();
  }
}

}  // namespace
}  // namespace snug::testing::contacts_test
