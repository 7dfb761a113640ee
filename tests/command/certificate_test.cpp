// --certificate: what the command writes and says, by the checker.

#include <checker/answers/file.h>
#include <checker/rejected.h>
#include <gtest/gtest.h>
#include <support/read_file.h>

#include <filesystem>

#include "scene_testing.h"

namespace snug::testing::certificate_command_test {
namespace {

using Words = std::vector<std::string>;

class certificates : public ::testing::Test {
 protected:
  // The sentences that the checker says of the file of a query, whose document is kept.
  std::vector<std::string> proved(const Words& words, const std::string& input = "") {
    Words all = words;
    all.insert(all.end(), {"--certificate", path_, "--json", "--quiet"});
    const Outcome outcome = run_snug(all, input);
    EXPECT_EQ(outcome.status, 0) << outcome.err;
    document_ = Json::parse(outcome.out);
    answers::LeastSlack least;
    try {
      return answers::check(read_file(path_), least);
    } catch (const checker::Rejected& refused) {
      ADD_FAILURE() << refused.what();
      return {};
    }
  }
  void expect_complete() { EXPECT_EQ(document_["certificate"], (Json{{"file", path_}, {"missing", ""}})); }
  static bool says(const std::string& sentence, const std::string& words) {
    return sentence.find(words) != std::string::npos;
  }

  TemporaryFolder folder_;
  std::string path_ = folder_.file("proof.txt");
  Json document_;
};

TEST_F(certificates, of_a_pair_are_named_in_its_document) {
  const auto apart =
      proved({"collide", model("bracket.obj"), model("pin.obj"), "--solid", "--move-b", "0 0 2"});
  ASSERT_EQ(apart.size(), 1U);
  EXPECT_TRUE(says(apart[0], "have no point in common, and bound solids that are as far apart")) << apart[0];
  expect_complete();
  const auto meeting = proved({"distance", model("bracket.obj"), model("pin.obj"), "--move-b", "0 0 0.5"});
  ASSERT_EQ(meeting.size(), 1U);
  EXPECT_TRUE(says(meeting[0], "have a point in common")) << meeting[0];
  expect_complete();
}

TEST_F(certificates, of_poses_have_a_sentence_each) {
  const std::string poses = "1 0 0 0 0 1 0 0 0 0 1 2\n1 0 0 0 0 1 0 0 0 0 1 3\n1 0 0 0 0 1 0 0 0 0 1 0.5\n";
  for (const char* query : {"collide", "distance"}) {
    const auto all = proved({query, model("bracket.obj"), model("pin.obj"), "--poses", "-"}, poses);
    ASSERT_EQ(all.size(), 3U) << query;
    EXPECT_TRUE(says(all[2], "have a point in common")) << all[2];
    expect_complete();
  }
}

TEST_F(certificates, of_a_scene_hold_every_pair) {
  const Json scene{{"parts",
                    {{{"mesh", model("bracket.obj")}},
                     {{"mesh", model("pin.obj")}, {"place", {{"move", {0, 0, 0.5}}}}},
                     {{"mesh", model("pin.obj")}, {"place", {{"move", {9, 0, 0}}}}},
                     {{"mesh", model("pawn.obj")}, {"place", {{"move", {-9, 3, 0}}}}}}}};
  const std::string file = write_scene(folder_.file("scene.json"), scene);
  const auto touch = proved({"collide", "--scene", file});
  ASSERT_EQ(touch.size(), 3U);
  EXPECT_TRUE(says(touch[0], "scene 0 of 4 parts, sha256 ")) << touch[0];
  EXPECT_TRUE(says(touch[0], "all pairs of parts but 0 and 1 lie in convex hulls that")) << touch[0];
  EXPECT_TRUE(says(touch[1], "scene 0: parts 0 and 1 have a point in common")) << touch[1];
  EXPECT_TRUE(says(touch[2], "every pair of parts has a claim")) << touch[2];
  expect_complete();
  const auto far = proved({"distance", "--scene", file, "--limit", "20"});
  EXPECT_EQ(far.size(), 6U);  // all pairs have an answer
  expect_complete();
}

// Witnesses belong to the parts in the order in which they were asked.
TEST_F(certificates, of_pairs_in_both_orders_hold_both) {
  const Json scene{{"parts",
                    {{{"mesh", model("bracket.obj")}},
                     {{"mesh", model("bust.obj")}, {"place", {{"move", {0, 0, 0.5}}}}},
                     {{"mesh", model("pin.obj")}, {"place", {{"move", {2, 0, 0}}}}},
                     {{"mesh", model("pin.obj")}, {"place", {{"move", {2, 0, 0}}}}}}},
                   {"pairs", {{0, 1}, {1, 0}, {2, 0}, {0, 2}, {0, 3}}}};
  const std::string file = write_scene(folder_.file("scene.json"), scene);
  const auto touch = proved({"collide", "--scene", file});
  ASSERT_EQ(touch.size(), 5U);
  EXPECT_TRUE(says(touch[1], "parts 1 and 0 have a point in common")) << touch[1];
  expect_complete();
  const auto far = proved({"distance", "--scene", file, "--limit", "5"});
  ASSERT_EQ(far.size(), 5U);
  EXPECT_TRUE(says(far[4], "parts 0 and 3 are farther apart than")) << far[4];
  expect_complete();
}

TEST_F(certificates, of_signed_distances_hold_the_sign) {
  const auto points =
      proved({"closest", model("pawn.obj"), "--points", "-", "--signed"}, "0 0.01 0.4\n5 5 5\n");
  ASSERT_EQ(points.size(), 2U);
  const bool inside = document_["results"][0]["signed_distance"][1] < 0;
  EXPECT_TRUE(says(points[0], inside ? "winding number 1" : "winding number 0")) << points[0];
  EXPECT_TRUE(says(points[1], "winding number 0")) << points[1];
  expect_complete();
}

TEST_F(certificates, that_do_not_exist_leave_no_file) {
  write_text(path_, "a proof of something else");
  const Outcome same = run_snug({"collide", model("star.obj"), model("star.obj"), "--tolerance", "0",
                                 "--max-splits", "1000", "--certificate", path_, "--json"});
  EXPECT_NE(same.err.find("not written, there is no proof of the verdict, which is undecided"),
            std::string::npos)
      << same.err;
  EXPECT_TRUE(Json::parse(same.out)["certificate"]["file"].is_null());
  EXPECT_FALSE(std::filesystem::exists(path_));
}

TEST_F(certificates, need_a_file_of_their_own_and_all_answers) {
  const Words pair{"collide", model("star.obj"), model("ring.obj")};
  for (const Words& more :
       {Words{"--certificate", "-"}, Words{"--certificate", path_, "-o", path_},
        Words{"--certificate", path_, "--solid", "--penetration"}, Words{"--certificate", path_, "--all"}}) {
    Words words = pair;
    words.insert(words.end(), more.begin(), more.end());
    EXPECT_EQ(run_snug(words).status, 2);
  }
  EXPECT_EQ(run_snug({"collide", "--scene", "none.json", "--resume", folder_.file("journal"), "--certificate",
                      path_})
                .status,
            2);
  EXPECT_FALSE(std::filesystem::exists(path_));
}

}  // namespace
}  // namespace snug::testing::certificate_command_test
