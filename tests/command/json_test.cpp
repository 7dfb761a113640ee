#include <gtest/gtest.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "run_snug.h"

namespace snug::testing::json_test {
namespace {

using nlohmann::json;

json answer(std::vector<std::string> arguments, int status = 0) {
  arguments.emplace_back("--json");
  const Outcome outcome = run_snug(arguments);
  EXPECT_EQ(outcome.status, status) << arguments[0] << ": " << outcome.err;
  EXPECT_EQ(outcome.err, "");
  return json::parse(outcome.out);
}

void expect_head(const json& document, const std::string& command) {
  EXPECT_EQ(document["command"], command);
  EXPECT_TRUE(document["version"].is_string());
  EXPECT_TRUE(document["mesh"].is_string() || document["mesh"].is_array());
  EXPECT_TRUE(document["scheme"].is_string() || document["scheme"].is_array());
  EXPECT_TRUE(document["seconds"].is_number());
}

void expect_points(const json& list, std::size_t count) {
  ASSERT_EQ(list.size(), count);
  for (const json& point : list) {
    ASSERT_EQ(point.size(), 3u);
    for (const json& x : point) EXPECT_TRUE(x.is_number());
  }
}

TEST(info, counts_the_star) {
  const json document = answer({"info", model("star.obj")});
  expect_head(document, "info");
  EXPECT_EQ(document["vertices"], 14);
  EXPECT_EQ(document["faces"], 24);
  EXPECT_EQ(document["closed"], true);
  EXPECT_EQ(document["components"], 1);
  EXPECT_EQ(document["valence"].size(), 2u);
  EXPECT_EQ(document["boundary_edges"], 0);
  EXPECT_EQ(document["creases"], 0);
  EXPECT_TRUE(document["kinds"].is_number());
  EXPECT_TRUE(document["extraordinary"].is_number());
  EXPECT_EQ(document["defects"].size(), 0u);
}

TEST(bound, has_the_fields_of_the_contract) {
  const json document = answer({"bound", model("star.obj"), "--error", "2%"});
  expect_head(document, "bound");
  EXPECT_EQ(document["count"], document["enclosures"].size());
  double largest = 0;
  for (const json& e : document["enclosures"]) {
    EXPECT_EQ(e["piece"].get<std::string>().size(), e["level"].get<std::size_t>());
    EXPECT_LT(e["face"].get<int>(), 24);
    for (const char* key : {"lower", "upper", "base", "corners"}) expect_points(e[key], 3);
    EXPECT_FALSE(e.contains("growth"));
    EXPECT_FALSE(e.contains("normals"));
    largest = std::max(largest, e["radius"].get<double>());
  }
  EXPECT_EQ(document["max_radius"], largest);
}

TEST(bound, gives_cones_of_normals_or_null) {
  const json document = answer({"bound", model("head.obj"), "--normals"});
  std::size_t cones = 0;
  for (const json& e : document["enclosures"]) {
    ASSERT_TRUE(e.contains("normals"));
    if (e["normals"].is_null()) continue;
    ++cones;
    expect_points(json::array({e["normals"]["axis"]}), 1);
    EXPECT_GT(e["normals"]["angle"].get<double>(), 0);
    EXPECT_LT(e["normals"]["angle"].get<double>(), 1.5708);
  }
  EXPECT_GT(cones, 600U);
  EXPECT_LT(cones, document["enclosures"].size());
  const Outcome text = run_snug({"bound", model("head.obj"), "--normals"});
  EXPECT_NE(text.out.find("normals: " + std::to_string(cones) + " of 700 pieces have a cone"),
            std::string::npos);
}

TEST(bound, that_runs_out_of_budget_ends_with_5_and_prints_what_holds) {
  const json document = answer({"bound", model("star.obj"), "--error", "0.01%", "--max-splits", "10"}, 5);
  EXPECT_EQ(document["outcome"], "budget-spent");
  EXPECT_EQ(document["count"], 24 + 3 * 10);
}

TEST(eval, covers_the_lattice_of_every_face) {
  const json document = answer({"eval", model("star.obj"), "--samples", "3"});
  expect_head(document, "eval");
  ASSERT_EQ(document["points"].size(), 24u * 10);
  for (const json& p : document["points"]) {
    expect_points(json::array({p["point"], p["tangents"][0], p["tangents"][1]}), 3);
    EXPECT_TRUE(p["normal"].is_array() || p["normal"].is_null());
    EXPECT_LE(p["u"].get<double>() + p["v"].get<double>(), 1.0);
  }
}

TEST(collide, answers_with_verdict_interval_and_witness) {
  const json apart = answer({"collide", model("star.obj"), model("pawn.obj"), "--tolerance", "1%",
                             "--place-b", "1 0 0 9  0 1 0 0  0 0 1 0"});
  expect_head(apart, "collide");
  EXPECT_EQ(apart["mesh"].size(), 2u);
  EXPECT_EQ(apart["scheme"].size(), 2u);
  EXPECT_EQ(apart["verdict"], "separated");
  EXPECT_GT(apart["distance"][0].get<double>(), 0);
  const json touching = answer({"collide", model("star.obj"), model("star.obj"), "--tolerance", "1%"});
  EXPECT_EQ(touching["verdict"], "within");
  expect_points(touching["witness"], 2);
  EXPECT_LE(touching["distance"][1], touching["tolerance"]);
  EXPECT_TRUE(touching["stats"].is_object());
}

TEST(subdivide_and_render, say_what_they_made) {
  const TemporaryFolder folder;
  const json fine =
      answer({"subdivide", model("star.obj"), "--level", "2", "--limit", "-o", folder.file("fine.obj")});
  expect_head(fine, "subdivide");
  EXPECT_EQ(fine["faces"], 24 * 16);
  EXPECT_EQ(answer({"info", folder.file("fine.obj")})["vertices"], fine["vertices"]);
  const json picture = answer({"render", model("star.obj"), "--size", "64", "-o", folder.file("star.png")});
  expect_head(picture, "render");
  EXPECT_GT(picture["hits"].get<double>(), 0);
  EXPECT_GE(picture["rays"].get<double>(), picture["hits"].get<double>());
}

}  // namespace
}  // namespace snug::testing::json_test
