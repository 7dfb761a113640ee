#include <algorithm>
#include <cmath>
#include <fstream>
#include <map>
#include <numbers>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "run_snug.h"

namespace snug::testing::judge_test {
namespace {

using nlohmann::json;

json answer(std::vector<std::string> words) {
  words.emplace_back("--json");
  const Outcome outcome = run_snug(words);
  EXPECT_EQ(outcome.status, 0) << outcome.err;
  return json::parse(outcome.out);
}

class judge : public ::testing::Test {
 protected:
  std::string write(const std::string& name, const std::string& text) const {
    std::ofstream(folder_.file(name)) << text;
    return folder_.file(name);
  }
  // What was found, by kind.
  static std::map<std::string, json> findings(const std::vector<std::string>& words) {
    // Enough for what findings are of; envelopes may be left out.
    std::vector<std::string> all{"judge", "--seconds", "3"};
    all.insert(all.end(), words.begin(), words.end());
    std::map<std::string, json> found;
    const json document = answer(all);
    for (const json& finding : document["findings"]) found[finding["kind"]] = finding;
    return found;
  }

  TemporaryFolder folder_;
};

const std::string box =
    "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 0 0 1\nv 1 0 1\nv 1 1 1\nv 0 1 1\n"
    "f 1 4 3 2\nf 5 6 7 8\nf 1 2 6 5\nf 2 3 7 6\nf 3 4 8 7\nf 4 1 5 8\n";

TEST_F(judge, asks_every_question_and_finds_nothing_wrong_with_a_solid) {
  const json found = answer({"judge", write("box.obj", box), "--seconds", "600"});
  std::map<std::string, std::string> answers;
  for (const json& one : found["answers"]) {
    answers[one["question"]] = one["answer"];
    EXPECT_GE(one["seconds"], 0);
    EXPECT_FALSE(one["text"].get<std::string>().empty());
  }
  EXPECT_EQ(answers, (std::map<std::string, std::string>{{"self-contact", "clear"},
                                                         {"measure", "complete"},
                                                         {"bound", "complete"},
                                                         {"tessellate", "complete"},
                                                         {"hull", "complete"},
                                                         {"envelope", "complete"}}));
  EXPECT_TRUE(found["findings"].empty()) << found["findings"];
  const Outcome text = run_snug({"judge", folder_.file("box.obj"), "--seconds", "600"});
  EXPECT_EQ(std::count(text.out.begin(), text.out.end(), '\n'), 9) << text.out;
}

TEST_F(judge, names_what_is_wrong_and_what_mends_it) {
  const auto soup =
      findings({write("soup.obj", box + "v 0.5 0.5 0.5\nv 2 0.5 0.5\nv 2 1.5 0.5\nv 0.5 1.5 0.5\n"
                                        "v 0.5 0.5 1.5\nv 2 0.5 1.5\nv 2 1.5 1.5\nv 0.5 1.5 1.5\n"
                                        "f 9 12 11 10\nf 13 14 15 16\nf 9 10 14 13\nf 10 11 15 14\n"
                                        "f 11 12 16 15\nf 12 9 13 16\n"),
                "--scheme", "bilinear"});
  ASSERT_TRUE(soup.contains("meets-itself"));
  EXPECT_NE(soup.at("meets-itself")["mends"].get<std::string>().find("snug envelope"), std::string::npos);

  // A quad beside two that share its long side: a vertex stands on an edge. Another stands where one does.
  const auto sheet = findings({write("sheet.obj",
                                     "v 0 0 0\nv 2 0 0\nv 2 1 0\nv 0 1 0\nv 1 0 0\nv 0 -1 0\nv 1 -1 0\n"
                                     "v 2 -1 0\nv 0 0 0\nv 2 0 0\n"
                                     "f 1 2 3 4\nf 6 7 5 9\nf 7 8 10 5\n")});
  EXPECT_TRUE(sheet.contains("t-junctions")) << json(sheet);
  EXPECT_EQ(sheet.at("coincident-vertices")["mends"], "--weld 0 merges them");
  EXPECT_NE(sheet.at("meets-itself")["text"].get<std::string>().find("touches itself"), std::string::npos)
      << sheet.at("meets-itself");
  EXPECT_NE(sheet.at("open")["text"].get<std::string>().find("2 borders"), std::string::npos)
      << sheet.at("open");

  EXPECT_TRUE(
      findings({write("out.obj", box.substr(0, box.find('f')) +
                                     "f 2 3 4 1\nf 8 7 6 5\nf 5 6 2 1\nf 6 7 3 2\nf 7 8 4 3\nf 8 5 1 4\n")})
          .contains("inside-out"));
  EXPECT_TRUE(
      findings({write("needle.obj", "v 0 0 0\nv 1 0 0\nv 0.5 0.001 0\nf 1 2 3\n")}).contains("needles"));

  const auto l_face =
      findings({write("l.obj", "v 0 0 0\nv 2 0 0\nv 2 1 0\nv 1 1 0\nv 1 2 0\nv 0 2 0\nf 1 2 3 4 5 6\n")});
  ASSERT_TRUE(l_face.contains("meets-itself"));
  EXPECT_NE(l_face.at("meets-itself")["mends"].get<std::string>().find("--sharp auto"), std::string::npos);
  EXPECT_FALSE(findings({folder_.file("l.obj"), "--sharp", "auto"}).contains("meets-itself"));

  std::string fan = "v 0 0 1\n", faces;
  for (int k = 0; k < 40; ++k) {
    fan += "v " + std::to_string(std::cos(k * std::numbers::pi / 20)) + ' ' +
           std::to_string(std::sin(k * std::numbers::pi / 20)) + " 0\n";
    faces += "f 1 " + std::to_string(k + 2) + ' ' + std::to_string((k + 1) % 40 + 2) + '\n';
  }
  const auto cone = findings({write("fan.obj", fan + faces)});
  EXPECT_TRUE(cone.contains("valence"));
  ASSERT_TRUE(cone.contains("smoothed-triangles"));
  EXPECT_NE(cone.at("smoothed-triangles")["mends"].get<std::string>().find("--scheme flat"),
            std::string::npos);
}

// What has no surface is judged, too, and no question goes on for longer than it may.
TEST_F(judge, tells_of_refusals_and_of_time_that_is_up) {
  const json broken = answer({"judge", write("broken.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 2\n")});
  EXPECT_TRUE(broken["answers"].empty());
  EXPECT_EQ(broken["findings"][0]["kind"], "refused");
  // Self-contact and hulls of a bust take some seconds.
  const json late = answer({"judge", model("demon.obj"), "--seconds", "1", "--threads", "1"});
  for (const json& one : late["answers"]) EXPECT_LT(one["seconds"], 5) << one;
  EXPECT_EQ(run_snug({"judge", folder_.file("none.obj")}).status, 3);
  EXPECT_EQ(run_snug({"judge", folder_.file("broken.obj"), "--seconds", "0"}).status, 2);
}

TEST_F(judge, stops_at_an_interrupt) {
  EXPECT_EQ(interrupt_snug({"judge", model("bust.obj")}, 300).status, 130);
}

}  // namespace
}  // namespace snug::testing::judge_test
