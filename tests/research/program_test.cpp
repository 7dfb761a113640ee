#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>

#include <command/run_snug.h>

namespace snug::testing::program_test {
namespace {

using nlohmann::json;

json answer(std::vector<std::string> arguments) {
  arguments.emplace_back("--json");
  const Outcome outcome = run_research(arguments);
  EXPECT_EQ(outcome.status, 0) << arguments[0] << ": " << outcome.err;
  EXPECT_EQ(outcome.err, "");
  return json::parse(outcome.out);
}

void expect_head(const json& document, const std::string& command) {
  EXPECT_EQ(document["command"], command);
  EXPECT_TRUE(document["version"].is_string());
  EXPECT_TRUE(document["seconds"].is_number());
}

TEST(program, refuses_what_it_has_no_use_for) {
  const std::string star = model("star.obj");
  for (const std::vector<std::string>& arguments :
       std::vector<std::vector<std::string>>{{"nothing"},
                                             {"rates", "--nets", "0"},
                                             {"rates", "--nets", "-3"},
                                             {"rates", "--levels", "3"},
                                             {"rates", "--levels", "41"},
                                             {"rates", "--json", "-o", "rates.svg"},
                                             {"rates", "--at", "middle"},
                                             {"rates", "--at", "crease", "--scheme", "midedge"},
                                             {"rates", "--at", "boundary", "--scheme", "curve"},
                                             {"rates", "--bounds", "table"},
                                             {"rates", "--max-splits", "3"},
                                             {"tightness", "--samples", "0"},
                                             {"tightness", "--seed", "x"},
                                             {"tightness", "star.obj"},
                                             {"prism", "--levels", "4"},
                                             {"pair-test", "--nets", "4"},
                                             {"table-5-1", star, "--placements", "4"},
                                             {"table-5-3", star},
                                             {"volumes", star},
                                             {"volumes", "--placements", "0"},
                                             {"table-5-1", star, "--scheme", "catmark"},
                                             {"table-5-3", "--placements", "0"},
                                             {"bounds", star, "--degree", "2"},
                                             {"subdivide", star}}) {
    const Outcome outcome = run_research(arguments);
    EXPECT_EQ(outcome.status, 2) << arguments[0] << outcome.err;
    EXPECT_EQ(std::count(outcome.err.begin(), outcome.err.end(), '\n'), 1) << outcome.err;
    EXPECT_EQ(outcome.out, "");
  }
}

TEST(program, has_a_help_that_names_it) {
  const Outcome help = run_research({"--help"});
  EXPECT_EQ(help.status, 0);
  for (const char* text : {"Usage: snug-research COMMAND", "table-5-1", "prism",
                           "Nodal functions:", "snug-research independence"})
    EXPECT_NE(help.out.find(text), std::string::npos) << text;
  EXPECT_NE(run_research({"nothing"}).err.find("see snug-research --help"), std::string::npos);
  EXPECT_NE(run_research({"rates", "--help"}).out.find("Usage: snug-research rates"), std::string::npos);
  EXPECT_TRUE(run_research({"--version"}).out.starts_with("snug-research 0.1.0 ("));
}

// The names of the libraries that a program loads are in its file.
bool loads_flint(const char* program) {
  std::ifstream file(program, std::ios::binary);
  const std::string bytes{std::istreambuf_iterator<char>(file), {}};
  EXPECT_NE(bytes.find("libstdc++"), std::string::npos) << program;
  return bytes.find("libflint") != std::string::npos;
}

TEST(program, is_alone_in_loading_flint) {
  EXPECT_FALSE(loads_flint(SNUG_COMMAND));
  EXPECT_TRUE(loads_flint(SNUG_RESEARCH));
}

TEST(program, names_itself_in_messages) {
  const Outcome outcome = run_research({"independence"});
  EXPECT_EQ(outcome.status, 2);
  EXPECT_EQ(outcome.err.rfind("snug-research: independence: give --valence", 0), 0u) << outcome.err;
}

// One line, which names the program and its package, whatever else the line has.
TEST(program, is_named_where_a_command_was) {
  const std::string star = model("star.obj");
  for (const std::vector<std::string>& arguments :
       std::vector<std::vector<std::string>>{{"independence"},
                                             {"independence", "--help"},
                                             {"table", "--scheme", "loop", "--valence", "7"},
                                             {"fit", star, "--points", "-", "-o", "out.obj"}}) {
    const Outcome outcome = run_snug(arguments);
    EXPECT_EQ(outcome.status, 2);
    EXPECT_EQ(outcome.err,
              "snug: " + arguments[0] + " is a command of snug-research (package snug-research)\n");
    EXPECT_EQ(outcome.out, "");
    EXPECT_EQ(run_research({arguments[0], "--help"}).status, 0);
  }
  const Outcome weights = run_snug({"eval", star, "--weights", "--json"});
  EXPECT_EQ(weights.status, 2);
  EXPECT_EQ(weights.err,
            "snug: eval --weights is the command weights of snug-research (package snug-research)\n");
  EXPECT_NE(run_snug({"--help"}).out.find("snug-research (package snug-research) has"), std::string::npos);
}

TEST(program, prisms_are_left_where_nets_are_bent) {
  const json document = answer({"prism", "--nets", "4", "--samples", "8"});
  ASSERT_EQ(document["rows"].size(), 3u * 12);
  for (const json& row : document["rows"]) {
    EXPECT_EQ(row["patches"], 8);
    EXPECT_EQ(row["left"] == 0, row["outside"] == 0.0);
    EXPECT_LE(row["prism"], 1.1 * row["offset"].get<double>());
    EXPECT_GT(row["prism"], 0);
    if (row["shape"] != "flat") {
      EXPECT_GT(row["left"], 0) << row;
      EXPECT_LT(row["offset"], row["box"]);
    }
  }
}

TEST(program, counts_pieces_by_what_lost) {
  const json document = answer({"bounds", model("star.obj"), "--error", "5%"});
  EXPECT_EQ(document["scheme"], "loop");
  ASSERT_EQ(document["rows"].size(), 5u);
  const json& rows = document["rows"];
  EXPECT_EQ(rows[0]["bounds"], "rows");
  EXPECT_EQ(rows[3]["bounds"], "control-box");
  EXPECT_GT(rows[3]["count"], 20 * rows[0]["count"].get<int>());
  EXPECT_EQ(rows[4]["count"], rows[0]["count"]);  // no creases
  for (const json& row : rows) EXPECT_TRUE(row["reached"]);
  const Outcome curves = run_research({"bounds", "-"}, "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 1\nl 1 2 3 4\n");
  EXPECT_EQ(curves.status, 0) << curves.err;
  EXPECT_NE(curves.out.find("control-box"), std::string::npos);
}

TEST(program, refines_by_the_older_rule) {
  const TemporaryFolder folder;
  const std::string out = folder.file("older.obj");
  const json document = answer({"subdivide", model("bracket.obj"), "--level", "2", "-o", out});
  EXPECT_EQ(document["faces"], 14 * 16);
  EXPECT_TRUE(std::filesystem::exists(out));
}

TEST(program, pair_test_finds_the_printed_test_unsound) {
  const json document = answer({"pair-test", "--pairs", "2000"});
  expect_head(document, "pair-test");
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

TEST(program, rates_fits_a_factor_to_thicknesses) {
  const json document = answer({"rates", "--nets", "3", "--levels", "7", "--seed", "5"});
  expect_head(document, "rates");
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

TEST(program, rates_says_where_it_measured) {
  const json document = answer({"rates", "--nets", "1", "--levels", "6", "--at", "semi-sharp"});
  ASSERT_EQ(document["rows"].size(), 4u * 2 * 3);
  for (const json& row : document["rows"]) {
    EXPECT_EQ(row["at"], "semi-sharp");
    EXPECT_EQ(row["valence"], 6);
    EXPECT_GT(row["sharpness"], 0);
    EXPECT_NEAR(row["second"].get<double>(), 0.5, 1e-9);
  }
}

TEST(program, tightness_has_quantiles_of_ratios) {
  const json document = answer({"tightness", "--nets", "2", "--samples", "6"});
  expect_head(document, "tightness");
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

TEST(program, volumes_say_the_same_and_need_less_where_they_are_tighter) {
  const json document = answer({"volumes", model("star.obj"), model("pawn.obj"), "--placements", "200"});
  expect_head(document, "volumes");
  EXPECT_EQ(document["placements"], 200);
  ASSERT_EQ(document["rows"].size(), 2u * 9);
  for (std::size_t i = 0; i < 18; ++i) {
    const json& row = document["rows"][i];
    const json& first = document["rows"][i - i % 9];  // boxes along axes
    EXPECT_EQ(row["pair"], json::array({"star", "pawn"}));
    EXPECT_EQ(row["room"], i < 9 ? 6 : 3);
    EXPECT_EQ(row["verdicts"], first["verdicts"]);
    EXPECT_EQ(row["possible"], first["possible"]);
    EXPECT_LE(row["volume_tests"], first["volume_tests"]);
    EXPECT_LE(row["triangle_tests"], first["triangle_tests"]);
    EXPECT_GE(row["bytes"], first["bytes"]);
    EXPECT_GT(row["query_us"], 0);
    EXPECT_EQ(row["turning"], i % 9 == 8 ? "turned" : i % 2 == (i < 9 ? 0 : 1) ? "bounded" : "refitted");
  }
  EXPECT_GT(document["rows"][9]["possible"], 0);
}

// A column of the peers: null in all rows or in none.
void expect_peer(const json& document, const json& value) {
  EXPECT_EQ(document["peers"].get<bool>(), value.is_number()) << value;
}

TEST(program, table_5_1_counts_triangles) {
  const json document = answer({"table-5-1", model("star.obj"), model("pawn.obj")});
  expect_head(document, "table-5-1");
  ASSERT_EQ(document["rows"].size(), 6u);
  for (std::size_t i = 0; i < 6; ++i) {
    const json& row = document["rows"][i];
    EXPECT_EQ(row["model"], i < 3 ? "star" : "pawn");
    EXPECT_EQ(row["faces"], i < 3 ? 24 : 262);
    EXPECT_GE(row["rows"], row["faces"]);
    EXPECT_GT(row["tables"], row["rows"]);
    EXPECT_GE(row["printed"], row["tables"]);
    EXPECT_GT(row["aabb"], 10 * row["printed"].get<int>());
    expect_peer(document, row["uniform"]);
    if (i % 3 != 0) {
      EXPECT_LT(row["tolerance"], document["rows"][i - 1]["tolerance"]);
      EXPECT_GE(row["rows"], document["rows"][i - 1]["rows"]);
    }
  }
}

TEST(program, table_5_2_times_creation) {
  const json document = answer({"table-5-2", model("star.obj")});
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

TEST(program, table_5_3_counts_the_same_whatever_the_threads) {
  std::vector<json> rows;
  for (const char* threads : {"1", "2"}) {
    const json document = answer({"table-5-3", model("star.obj"), model("pawn.obj"), "--placements", "400",
                                  "--seed", "3", "--threads", threads});
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

TEST(program, prints_a_table_for_people) {
  const Outcome rates = run_research({"rates", "--nets", "1", "--levels", "4"});
  EXPECT_EQ(rates.status, 0) << rates.err;
  EXPECT_EQ(std::count(rates.out.begin(), rates.out.end(), '\n'), 3 + 12 * 3);
  const Outcome tightness = run_research({"tightness", "--nets", "1", "--samples", "2"});
  EXPECT_EQ(tightness.status, 0) << tightness.err;
  EXPECT_EQ(std::count(tightness.out.begin(), tightness.out.end(), '\n'), 2 + 3 * 12 * 3);
}

TEST(program, rates_of_curves_are_measured) {
  const json document = answer({"rates", "--scheme", "curve", "--nets", "3"});
  ASSERT_EQ(document["rows"].size(), 12u);
  EXPECT_EQ(document["rows"][0]["degree"], 2);
  EXPECT_EQ(document["rows"][0]["place"], "closed");
  EXPECT_NEAR(document["rows"][0]["factor"].get<double>(), 0.25, 0.01);
}

}  // namespace
}  // namespace snug::testing::program_test
