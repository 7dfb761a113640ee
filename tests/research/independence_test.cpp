// independence, as people script it.

#include <gtest/gtest.h>

#include <fstream>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include <command/run_snug.h>

namespace snug::testing::independence_test {
namespace {

using nlohmann::json;

class independence_command : public ::testing::Test {
 protected:
  static json answer(std::vector<std::string> arguments) {
    arguments.insert(arguments.begin(), "independence");
    arguments.emplace_back("--json");
    const Outcome outcome = run_research(arguments);
    EXPECT_EQ(outcome.status, 0) << outcome.err;
    return json::parse(outcome.out, nullptr, false);
  }
  static void expect_refused(std::vector<std::string> arguments, const std::string& why) {
    arguments.insert(arguments.begin(), "independence");
    const Outcome outcome = run_research(arguments);
    EXPECT_EQ(outcome.status, 2) << outcome.err;
    EXPECT_NE(outcome.err.find(why), std::string::npos) << outcome.err;
  }
  std::string write(const std::string& name, const std::string& text) {
    std::ofstream(folder_.file(name)) << text;
    return folder_.file(name);
  }

  TemporaryFolder folder_;
};

TEST_F(independence_command, gives_ranks_with_certificates) {
  const json found =
      answer({"--scheme", "loop", "--valence", "7..9", "--domain", "rings:1", "--domain", "omega"});
  EXPECT_EQ(found["scheme"], "loop");
  ASSERT_EQ(found["cases"].size(), 6);
  const json& eight = found["cases"][2];
  EXPECT_EQ(eight["valence"], 8);
  EXPECT_EQ(eight["domain"], "rings:1");
  EXPECT_EQ(eight["dimension"], 14);
  EXPECT_EQ(eight["rank"], 13);
  EXPECT_EQ(eight["independent"], false);
  EXPECT_EQ(eight["text"], "dependent");
  EXPECT_EQ(eight["certificate"]["bound"], "kernel");
  // The two neighbours of the corner that a ring does not see, against each other.
  ASSERT_EQ(eight["certificate"]["kernel"].size(), 1);
  EXPECT_EQ(eight["certificate"]["kernel"][0], json::parse(R"({"5": "-1", "6": "1"})"));
  EXPECT_EQ(found["cases"][3]["certificate"]["bound"], "full");
  EXPECT_EQ(found["cases"][3]["certificate"]["rings"], 2);
}

TEST_F(independence_command, does_not_depend_on_threads) {
  json one = answer({"--scheme", "catmark", "--valence", "3..12", "--threads", "1"});
  json four = answer({"--scheme", "catmark", "--valence", "3..12", "--threads", "4"});
  one.erase("seconds");
  four.erase("seconds");
  EXPECT_EQ(one, four);
}

TEST_F(independence_command, prints_the_matrices_of_a_step) {
  const json found = answer({"--scheme", "loop", "--valence", "5", "--domain", "omega", "--matrices"});
  ASSERT_EQ(found["matrices"].size(), 1);
  const json& step = found["matrices"][0];
  EXPECT_EQ(step["rows"], 17);
  EXPECT_EQ(step["columns"], 11);
  EXPECT_EQ(step["kept"], 11);
  ASSERT_EQ(step["matrix"].size(), 17);
  // The corner: 1 - 5/8 + (3 + 2cos(2 pi/5))^2/64 of itself, where 2cos(2 pi/5)^2 is one with 2cos(4 pi/5).
  EXPECT_EQ(step["matrix"][0]["1"],
            json::parse(R"({"rational": "35/64", "cosines": {"1": "3/32", "2": "1/64"}})"));
  EXPECT_EQ(step["matrix"][1]["2"], "3/8");
  EXPECT_EQ(step["pieces"].size(), 3);
  EXPECT_EQ(step["pieces"][0].size(), 12);
}

TEST_F(independence_command, tells_eigenvalues) {
  const json found = answer({"--scheme", "loop", "--valence", "3..4", "--domain", "omega", "--eigenvalues"});
  ASSERT_EQ(found["eigenvalues"].size(), 2);
  EXPECT_EQ(found["eigenvalues"][0]["as_stated"], true);
  EXPECT_EQ(
      found["eigenvalues"][0]["repeated"][2],
      json::parse(R"({"value": "1/16", "algebraic": 3, "geometric": 2, "span": [{"6": "1"}, {"8": "1"}]})"));
  EXPECT_EQ(found["eigenvalues"][1]["valence"], 4);
  expect_refused({"--valence", "5", "--scheme", "midedge", "--eigenvalues"}, "loop and catmark");
}

TEST_F(independence_command, names_the_kernel_of_a_mesh) {
  const std::string cube = write("cube.obj",
                                 "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 1 1 0\nv 0 0 1\nv 1 0 1\nv 0 1 1\nv 1 1 1\n"
                                 "f 1 3 4 2\nf 5 6 8 7\nf 1 2 6 5\nf 3 7 8 4\nf 1 5 7 3\nf 2 4 8 6\n");
  const json found = answer({"--mesh", cube});
  EXPECT_EQ(found["method"], "theorem");
  EXPECT_EQ(found["dimension"], 8);
  EXPECT_EQ(found["rank"], 7);
  EXPECT_EQ(found["independent"], false);
  ASSERT_EQ(found["kernel"].size(), 1);
  EXPECT_EQ(found["kernel"][0]["signs"], json::parse("[1, -1, -1, 1, -1, 1, 1, -1]"));
  EXPECT_EQ(answer({"--mesh", cube, "--scheme", "doo-sabin"})["independent"], true);
  const Outcome text = run_research({"independence", "--mesh", cube});
  EXPECT_NE(text.out.find("8 vertices with signs in turn: +0 -1 -2 +3"), std::string::npos) << text.out;
}

TEST_F(independence_command, ranks_what_the_theorem_leaves_out) {
  std::string fan;  // a face of seven corners and two quads around a vertex
  for (int v = 0; v < 10; ++v) fan += "v " + std::to_string(v) + " 0 1\n";
  fan += "f 1 2 3 4 5 6 7\nf 1 7 8 9\nf 1 9 10 2\n";
  const std::string file = write("fan.obj", fan);
  const json found = answer({"--mesh", file, "--scheme", "doo-sabin"});
  EXPECT_EQ(found["method"], "rank");
  EXPECT_EQ(found["dimension"], 10);
  EXPECT_EQ(found["rank"], 9);
  EXPECT_EQ(found["rank_interval"], json::parse("[9, 9]"));
  EXPECT_EQ(found["independent"], false);
  EXPECT_EQ(found["certificate"]["root_order"], 7);
  ASSERT_EQ(found["kernel"].size(), 1);
  EXPECT_EQ(found["kernel"][0], json::parse(R"({"vertices": [2, 3, 4, 5], "order": 7,
                                                "weights": ["-1", ["1", "1"], ["-1", "-1"], "1"]})"));
  const Outcome text = run_research({"independence", "--mesh", file, "--scheme", "doo-sabin"});
  EXPECT_NE(text.out.find("2: -1, 3: 1 + t, 4: -1 - t, 5: 1; t = 2cos(2 pi/7)"), std::string::npos)
      << text.out;
  // A cube with a hole keeps its kernel: the hole's corners support other faces.
  const std::string cube = write("hole.obj",
                                 "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 1 1 0\nv 0 0 1\nv 1 0 1\nv 0 1 1\nv 1 1 1\n"
                                 "f 1 3 4 2\nf 5 6 8 7\nf 1 2 6 5\nf 3 7 8 4\nf 1 5 7 3\nf 2 4 8 6\n"
                                 "t hole 1/0/0 2\n");
  const json hole = answer({"--mesh", cube});
  EXPECT_EQ(hole["method"], "rank");
  EXPECT_EQ(hole["rank"], 7);
  EXPECT_EQ(hole["kernel"][0]["signs"].size(), 8);
}

TEST_F(independence_command, says_where_a_rank_is_undecided) {
  constexpr int n = 131;
  std::string fan;
  for (int v = 0; v < n + 3; ++v) fan += "v " + std::to_string(v) + " 0 1\n";
  fan += "f";
  for (int v = 1; v <= n; ++v) fan += " " + std::to_string(v);
  const auto at = [](int v) { return " " + std::to_string(v); };
  fan += "\nf 1" + at(n) + at(n + 1) + at(n + 2) + "\nf 1" + at(n + 2) + at(n + 3) + " 2\n";
  const Outcome outcome =
      run_research({"independence", "--mesh", write("large.obj", fan), "--scheme", "doo-sabin", "--json"});
  EXPECT_EQ(outcome.status, 5) << outcome.err;
  const json found = json::parse(outcome.out);
  EXPECT_TRUE(found["rank"].is_null());
  EXPECT_TRUE(found["independent"].is_null());
  EXPECT_EQ(found["rank_interval"], json::parse("[9, 134]"));
}

TEST_F(independence_command, of_two_corners) {
  const json found = answer({"--scheme", "catmark", "--valence", "5", "--second", "7", "--opposite"});
  ASSERT_EQ(found["cases"].size(), 4);
  const json& last = found["cases"][3];
  EXPECT_EQ(last["valence"], 5);
  EXPECT_EQ(last["second"], 7);
  EXPECT_EQ(last["place"], "opposite");
  EXPECT_EQ(last["domain"], "omega");
  EXPECT_EQ(last["dimension"], 24);
  EXPECT_EQ(last["rank"], 24);
  EXPECT_EQ(last["certificate"]["rings"], 3);
  expect_refused({"--valence", "5", "--second", "7", "--opposite"}, "no opposite corners");
  expect_refused({"--valence", "3..5", "--second", "3"}, "two corners of valence 3");
  expect_refused({"--valence", "5", "--second", "2"}, "from 3 to 200");
  expect_refused({"--valence", "5", "--second", "7", "--domain", "annulus"}, "only rings:K and omega");
}

TEST_F(independence_command, of_faces_at_a_boundary) {
  const json found =
      answer({"--scheme", "catmark", "--border", "smooth", "--valence", "1..4", "--domain", "rings:1"});
  // Of mirror images one: 1, 1, 1 and 2, 1 and 2.
  ASSERT_EQ(found["cases"].size(), 6);
  const json& last = found["cases"][4];
  EXPECT_EQ(last["valence"], 4);
  EXPECT_EQ(last["border"], 1);
  EXPECT_FALSE(last.contains("corner"));
  EXPECT_EQ(last["dimension"], 16);
  EXPECT_EQ(last["rank"], 14);
  EXPECT_EQ(last["certificate"]["bound"], "kernel");
  EXPECT_EQ(last["certificate"]["left_out"], 0);
  EXPECT_FALSE(last["certificate"].contains("root"));
  const json corner = answer({"--border", "corner", "--valence", "8", "--face", "4", "--matrices"});
  ASSERT_EQ(corner["cases"].size(),
            10);  // three polynomials, their pairs, three numbers of rings, the whole piece
  for (const json& each : corner["cases"]) {
    EXPECT_EQ(each["border"], 4);
    EXPECT_EQ(each["corner"], true);
  }
  EXPECT_EQ(corner["cases"][7]["rank"], 14);
  EXPECT_EQ(corner["cases"][9]["certificate"]["rings"], 3);
  EXPECT_EQ(corner["matrices"][0]["corner"], true);
  EXPECT_EQ(corner["matrices"][0]["matrix"][0], json::parse(R"({"1": "1"})"));
  EXPECT_EQ(corner["matrices"][0]["matrix"][1], json::parse(R"({"1": "1/2", "2": "1/2"})"));
  const Outcome text =
      run_research({"independence", "--border", "smooth", "--valence", "6", "--domain", "rings:1"});
  EXPECT_NE(text.out.find("   6    2  rings:1       12 of 13   dependent"), std::string::npos) << text.out;
}

TEST_F(independence_command, refuses_what_boundaries_do_not_have) {
  for (const char* scheme : {"doo-sabin", "midedge"})
    expect_refused({"--border", "smooth", "--valence", "5", "--scheme", scheme},
                   "ends inside the control mesh");
  const std::vector<std::string> asked{"--border", "smooth", "--valence", "5"};
  const auto expect_refused_with = [&](std::vector<std::string> more, const std::string& why) {
    more.insert(more.begin(), asked.begin(), asked.end());
    expect_refused(more, why);
  };
  expect_refused_with({"--second", "5"}, "exclude each other");
  expect_refused_with({"--scheme", "catmark", "--older-rule"}, "exclude each other");
  expect_refused_with({"--eigenvalues"}, "exclude each other");
  expect_refused_with({"--domain", "annulus"}, "with --border, only");
  expect_refused_with({"--domain", "conjecture"}, "not with --second or --border");
  expect_refused_with({"--face", "6"}, "has no face 6");
  expect_refused_with({"--face", "0"}, "from 1 to 200");
  expect_refused({"--border", "sharp", "--valence", "5"}, "smooth or corner");
  expect_refused({"--border", "smooth", "--valence", "0"}, "from 1 to 200");
  expect_refused({"--border", "smooth", "--mesh", "mesh.obj"}, "needs --valence");
  expect_refused({"--face", "1", "--valence", "5"}, "needs --border");
}

TEST_F(independence_command, of_the_largest_valence_and_other_rules) {
  for (const char* scheme : {"loop", "catmark", "doo-sabin", "midedge"}) {
    const json found = answer({"--scheme", scheme, "--valence", "200", "--domain", "piece:1"});
    ASSERT_EQ(found["cases"].size(), 1) << scheme;
    EXPECT_EQ(found["cases"][0]["independent"], false);
  }
  const json older = answer({"--scheme", "catmark", "--older-rule", "--valence", "3", "--domain", "ring:2"});
  EXPECT_EQ(older["cases"][0]["rule"], "older");
  EXPECT_EQ(older["cases"][0]["independent"], true);
  const json halves = answer({"--scheme", "catmark", "--valence", "5..7", "--domain", "conjecture"});
  ASSERT_EQ(halves["cases"].size(), 4);
  EXPECT_EQ(halves["cases"][1]["domain"], "rings:2");
  EXPECT_EQ(halves["cases"][1]["independent"], true);
  const json dual = answer({"--scheme", "midedge", "--valence", "6", "--domain", "omega", "--matrices"});
  EXPECT_EQ(dual["matrices"][0]["pieces"][0][0].size(), 2);
}

TEST_F(independence_command, refuses_what_is_no_question) {
  expect_refused({}, "give --valence A..B");
  expect_refused({"--valence", "2"}, "from 3 to 200");
  expect_refused({"--valence", "30..3"}, "ends before it begins");
  expect_refused({"--valence", "3..1000000000"}, "from 3 to 200");
  expect_refused({"--valence", "3..1e9"}, "is not a valence");
  expect_refused({"--valence", "..7"}, "is not a valence");
  expect_refused({"--valence", "7", "--domain", "ring:0"}, "--domain: 'ring:0'");
  expect_refused({"--valence", "7", "--domain", "rings:257"}, "K goes from 1 to 256");
  expect_refused({"--valence", "3..7", "--domain", "conjecture"}, "loop with valence 8 and more");
  expect_refused({"--valence", "7", "--sharp", "30"}, "need --mesh");
  expect_refused({"--valence", "7", "--scheme", "curve"}, "loop, catmark, doo-sabin and midedge");
  expect_refused({"--valence", "7", "--scheme", "flat"}, "loop, catmark, doo-sabin and midedge");
  expect_refused({"--valence", "7", "--older-rule"}, "needs --scheme catmark");
  expect_refused({"--valence", "7", "--matrices"}, "needs --json");
  const std::string points = write("points.obj", "v 0 0 0\nv 1 0 0\n");
  const Outcome empty = run_research({"independence", "--mesh", points});
  EXPECT_NE(empty.status, 0);
  EXPECT_FALSE(empty.err.empty());
}

}  // namespace
}  // namespace snug::testing::independence_test
