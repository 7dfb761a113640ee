#include <gtest/gtest.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "run_snug.h"

namespace snug::testing {
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
  const json document = answer({"bound", model("star.obj"), "--tolerance", "2%"});
  expect_head(document, "bound");
  EXPECT_EQ(document["count"], document["enclosures"].size());
  double largest = 0;
  for (const json& e : document["enclosures"]) {
    EXPECT_EQ(e["piece"].get<std::string>().size(), e["level"].get<std::size_t>());
    EXPECT_LT(e["face"].get<int>(), 24);
    for (const char* key : {"lower", "upper", "base", "corners"}) expect_points(e[key], 3);
    EXPECT_EQ(e["growth"], 0);
    largest = std::max(largest, e["radius"].get<double>());
  }
  EXPECT_EQ(document["max_radius"], largest);
}

TEST(bound, by_control_boxes_has_one_box_a_face) {
  const json document = answer({"bound", model("star.obj"), "--bounds", "control-box"});
  EXPECT_EQ(document["count"], 24);
  for (const json& e : document["enclosures"]) {
    expect_points(e["lower"], 1);
    expect_points(e["upper"], 1);
    EXPECT_TRUE(e["base"].is_null());
    EXPECT_TRUE(e["radius"].is_null());
  }
}

TEST(bound, that_runs_out_of_budget_ends_with_5_and_prints_what_holds) {
  const json document = answer({"bound", model("star.obj"), "--tolerance", "0.01%", "--budget", "10"}, 5);
  EXPECT_EQ(document["reached"], false);
  EXPECT_EQ(document["count"], 24 + 3 * 10);
}

TEST(eval, covers_the_lattice_of_every_face) {
  const json document = answer({"eval", model("star.obj"), "--samples", "3"});
  expect_head(document, "eval");
  ASSERT_EQ(document["points"].size(), 24u * 10);
  for (const json& p : document["points"]) {
    expect_points(json::array({p["position"], p["tangents"][0], p["tangents"][1]}), 3);
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

TEST(experiment, pair_test_finds_the_printed_test_unsound) {
  const json document = answer({"experiment", "pair-test", "--pairs", "2000"});
  expect_head(document, "experiment");
  ASSERT_FALSE(document["rows"].empty());
  double wrong = 0;
  for (const json& row : document["rows"]) {
    wrong += row["called_separated"].get<double>();
    EXPECT_EQ(row["rule_a_false"], 0);
  }
  EXPECT_GT(wrong, 200);
}

// Rows of the experiments say what bounded the patches.
void expect_source(const json& row) {
  EXPECT_TRUE(row["valence"].is_number_integer());
  if (row["bounds"] == "rows") {
    EXPECT_TRUE(row["layout"].is_null());
  } else {
    EXPECT_EQ(row["bounds"], "table");
    EXPECT_TRUE(row["layout"] == "ngon" || row["layout"] == "characteristic");
  }
}

TEST(experiment, rates_fits_a_factor_to_thicknesses) {
  const json document = answer({"experiment", "rates", "--nets", "3", "--levels", "7", "--seed", "5"});
  expect_head(document, "experiment");
  EXPECT_EQ(document["name"], "rates");
  EXPECT_EQ(document["seed"], 5);
  EXPECT_EQ(document["nets"], 3);
  EXPECT_EQ(document["levels"], 7);
  ASSERT_EQ(document["rows"].size(), 12u * 3 * 3);
  for (const json& row : document["rows"]) {
    expect_source(row);
    EXPECT_TRUE(row["measure"] == "radius" || row["measure"] == "interval" || row["measure"] == "normal");
    EXPECT_EQ(row["thickness"].size(), 8u);
    for (const json& t : row["thickness"]) EXPECT_GT(t, 0);
    EXPECT_NEAR(row["factor"].get<double>(), row["expected"].get<double>(), 0.15);
    EXPECT_TRUE(row["expected"] == row["subdominant"] || row["expected"] == row["next"]);
  }
}

TEST(experiment, rates_says_where_it_measured) {
  const json document = answer({"experiment", "rates", "--nets", "1", "--levels", "6", "--at", "semi-sharp"});
  ASSERT_EQ(document["rows"].size(), 4u * 2 * 3);
  for (const json& row : document["rows"]) {
    EXPECT_EQ(row["at"], "semi-sharp");
    EXPECT_EQ(row["valence"], 6);
    EXPECT_GT(row["sharpness"], 0);
    EXPECT_NEAR(row["second"].get<double>(), 0.5, 1e-9);
  }
}

TEST(experiment, tightness_has_quantiles_of_ratios) {
  const json document = answer({"experiment", "tightness", "--nets", "2", "--samples", "6"});
  expect_head(document, "experiment");
  EXPECT_EQ(document["name"], "tightness");
  EXPECT_EQ(document["nets"], 2);
  EXPECT_EQ(document["samples"], 6);
  ASSERT_EQ(document["rows"].size(), 3u * 12 * 3);
  for (const json& row : document["rows"]) {
    expect_source(row);
    EXPECT_TRUE(row["shape"] == "bent" || row["shape"] == "bumpy" || row["shape"] == "flat");
    EXPECT_EQ(row["patches"], 4);
    EXPECT_GE(row["median"], 1);
    EXPECT_GE(row["high"], row["median"]);
    EXPECT_GE(row["most"], row["high"]);
    EXPECT_GT(row["over_rows"], 0);
  }
}

// A column of the peers: null in all rows or in none.
void expect_peer(const json& document, const json& value) {
  EXPECT_EQ(document["peers"].get<bool>(), value.is_number()) << value;
}

TEST(experiment, table_5_1_counts_triangles) {
  const json document = answer({"experiment", "table-5-1", model("star.obj"), model("pawn.obj")});
  expect_head(document, "experiment");
  ASSERT_EQ(document["rows"].size(), 6u);
  for (std::size_t i = 0; i < 6; ++i) {
    const json& row = document["rows"][i];
    EXPECT_EQ(row["model"], i < 3 ? "star" : "pawn");
    EXPECT_EQ(row["faces"], i < 3 ? 24 : 262);
    EXPECT_GE(row["rows"], row["faces"]);
    EXPECT_GT(row["tables"], row["rows"]);
    EXPECT_GE(row["printed"], row["tables"]);
    expect_peer(document, row["uniform"]);
    if (i % 3 != 0) {
      EXPECT_LT(row["tolerance"], document["rows"][i - 1]["tolerance"]);
      EXPECT_GE(row["rows"], document["rows"][i - 1]["rows"]);
    }
  }
}

TEST(experiment, table_5_2_times_creation) {
  const json document = answer({"experiment", "table-5-2", model("star.obj")});
  ASSERT_EQ(document["rows"].size(), 3u);
  for (const json& row : document["rows"]) {
    EXPECT_EQ(row["model"], "star");
    for (const char* time : {"ready_ms", "tight_ms", "rows_ms", "printed_ms"})
      EXPECT_GE(row[time], 0) << time;
    EXPECT_GT(row["printed_ms"], row["ready_ms"]);
    expect_peer(document, row["uniform_obb_ms"]);
    expect_peer(document, row["uniform_obbrss_ms"]);
  }
}

TEST(experiment, table_5_3_counts_the_same_whatever_the_threads) {
  std::vector<json> rows;
  for (const char* threads : {"1", "2"}) {
    const json document = answer({"experiment", "table-5-3", model("star.obj"), model("pawn.obj"),
                                  "--placements", "400", "--seed", "3", "--threads", threads});
    ASSERT_EQ(document["rows"].size(), 12u);
    for (const json& row : document["rows"]) expect_peer(document, row["uniform_hits"]);
    rows.push_back(document["rows"]);
  }
  int hits_by_room[4]{};
  for (std::size_t i = 0; i < 12; ++i) {
    const json &row = rows[0][i], &again = rows[1][i];
    for (const char* count : {"hits", "within", "printed_missed", "printed_missed_moeller",
                              "printed_missed_hits", "printed_alarms"}) {
      EXPECT_EQ(row[count], again[count]) << count;
    }
    EXPECT_EQ(row["hits"], rows[0][i - i % 3]["hits"]);  // whatever the tolerance
    EXPECT_GE(row["within"], row["hits"]);
    EXPECT_LE(row["printed_missed"], row["printed_missed_moeller"]);
    hits_by_room[i / 3] = row["hits"];
  }
  // Rooms of side 6, 3, 4.5, 2.4.
  EXPECT_LT(hits_by_room[0], hits_by_room[1]);
  EXPECT_LT(hits_by_room[2], hits_by_room[1]);
  EXPECT_LT(hits_by_room[1], hits_by_room[3]);
  EXPECT_GT(hits_by_room[3], 20);
}

TEST(experiment, prints_a_table_for_people) {
  const Outcome rates = run_snug({"experiment", "rates", "--nets", "1", "--levels", "4"});
  EXPECT_EQ(rates.status, 0) << rates.err;
  EXPECT_EQ(std::count(rates.out.begin(), rates.out.end(), '\n'), 2 + 12 * 3);
  const Outcome tightness = run_snug({"experiment", "tightness", "--nets", "1", "--samples", "2"});
  EXPECT_EQ(tightness.status, 0) << tightness.err;
  EXPECT_EQ(std::count(tightness.out.begin(), tightness.out.end(), '\n'), 2 + 3 * 12 * 3);
}

}  // namespace
}  // namespace snug::testing
