// self, as people script it.

#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>
#include <numbers>
#include <string>

#include "run_snug.h"

namespace snug::testing::self_test {
namespace {

using nlohmann::json;

constexpr const char* box =
    "v 0 0 0\nv 2 0 0\nv 0 3 0\nv 2 3 0\nv 0 0 4\nv 2 0 4\nv 0 3 4\nv 2 3 4\n"
    "f 1 3 4 2\nf 5 6 8 7\nf 1 2 6 5\nf 3 7 8 4\nf 1 5 7 3\nf 2 4 8 6\n";
constexpr const char* another =
    "v 1 1 1\nv 3 1 1\nv 1 4 1\nv 3 4 1\nv 1 1 5\nv 3 1 5\nv 1 4 5\nv 3 4 5\n"
    "f 9 11 12 10\nf 13 14 16 15\nf 9 10 14 13\nf 11 15 16 12\nf 9 13 15 11\nf 10 12 16 14\n";

class self_command : public ::testing::Test {
 protected:
  Outcome run(const std::string& obj, std::vector<std::string> more = {}) {
    std::ofstream(folder_.file("mesh.obj")) << obj;
    more.insert(more.begin(), {"self-contact", folder_.file("mesh.obj")});
    return run_snug(more);
  }
  TemporaryFolder folder_;
};

TEST_F(self_command, of_a_box_is_clear) {
  const Outcome outcome = run(box, {"--json"});
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  const json found = json::parse(outcome.out);
  EXPECT_EQ(found["command"], "self-contact");
  EXPECT_EQ(found["verdict"], "clear");
  EXPECT_TRUE(found["pairs"].empty());
  EXPECT_GT(found["stats"]["stars"], 0);
  EXPECT_NE(run(box).out.find("clear"), std::string::npos);
}

TEST_F(self_command, of_two_boxes_in_each_other_tells_where) {
  const Outcome outcome = run(std::string(box) + another, {"--json"});
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  const json found = json::parse(outcome.out);
  EXPECT_EQ(found["verdict"], "intersecting");
  ASSERT_FALSE(found["pairs"].empty());
  const json& pair = found["pairs"][0];
  EXPECT_EQ(pair["verdict"], "intersecting");
  EXPECT_LT(pair["witness_at"][0]["face"], 6);
  EXPECT_GE(pair["witness_at"][1]["face"], 6);
  EXPECT_EQ(pair["witness"].size(), 2U);
  EXPECT_EQ(pair["distance"][1], 0);
  EXPECT_NE(run(std::string(box) + another).out.find("intersecting"), std::string::npos);
}

TEST_F(self_command, of_two_boxes_beside_each_other_tells_whether_they_are_near) {
  // Half a unit apart, as faces are.
  const std::string boxes =
      std::string(box) +
      "v 2.5 0 0\nv 4.5 0 0\nv 2.5 3 0\nv 4.5 3 0\nv 2.5 0 4\nv 4.5 0 4\nv 2.5 3 4\nv 4.5 3 4\n"
      "f 9 11 12 10\nf 13 14 16 15\nf 9 10 14 13\nf 11 15 16 12\nf 9 13 15 11\nf 10 12 16 14\n";
  const auto found = [&](const char* tolerance) {
    const Outcome outcome = run(boxes, {"--scheme", "bilinear", "--within", tolerance, "--json"});
    EXPECT_EQ(outcome.status, 0) << outcome.err;
    return json::parse(outcome.out);
  };
  const json clear = found("0.4"), near = found("0.6");
  EXPECT_EQ(clear["verdict"], "clear");
  EXPECT_EQ(clear["radius"], 1.6);
  EXPECT_EQ(near["verdict"], "near");
  ASSERT_FALSE(near["pairs"].empty());
  EXPECT_EQ(near["pairs"][0]["verdict"], "near");
  EXPECT_LE(near["pairs"][0]["distance"][0], 0.5);
  EXPECT_LE(near["pairs"][0]["distance"][1], 0.6);
  EXPECT_NE(run(boxes, {"--scheme", "bilinear", "--within", "0.6"}).out.find("apart"), std::string::npos);
}

TEST_F(self_command, refuses_lengths_that_make_no_sense) {
  EXPECT_EQ(run(box, {"--within", "-1"}).status, 2);
  EXPECT_EQ(run(box, {"--within", "nan"}).status, 2);
  EXPECT_EQ(run(box, {"--radius", "1"}).status, 2);
  const Outcome short_radius = run(box, {"--within", "0.1", "--radius", "0.1"});
  EXPECT_EQ(short_radius.status, 4);
  EXPECT_NE(short_radius.err.find("twice 'within'"), std::string::npos) << short_radius.err;
}

TEST_F(self_command, ends_with_five_where_nothing_is_decided) {
  const Outcome outcome = run(box, {"--json", "--max-splits", "0"});
  EXPECT_EQ(outcome.status, 5);
  EXPECT_EQ(json::parse(outcome.out)["verdict"], "undecided");
}

// A cone of 128 triangles with a sharp tip.
TEST(self_places, names_the_vertex_that_is_in_the_way) {
  const TemporaryFolder folder;
  std::string text = "v 0 0 1\n", faces;
  for (int k = 0; k < 128; ++k) {
    const double angle = k * std::numbers::pi / 64;
    text += "v " + std::to_string(std::cos(angle)) + ' ' + std::to_string(std::sin(angle)) + " 0\n";
    faces += "f 1 " + std::to_string(k + 2) + ' ' + std::to_string((k + 1) % 128 + 2) + '\n';
  }
  faces += "t corner 1/1/0 0 10\n";
  std::ofstream(folder.file("fan.obj")) << text << faces;
  const Outcome outcome = run_snug({"self-contact", folder.file("fan.obj"), "--scheme", "loop"});
  EXPECT_EQ(outcome.status, 5);
  EXPECT_NE(outcome.out.find("vertex 0 of 128 faces"), std::string::npos) << outcome.out;
}

}  // namespace
}  // namespace snug::testing::self_test
