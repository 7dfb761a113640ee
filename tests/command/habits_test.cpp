#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>
#include <string>
#include <utility>
#include <vector>

#include "run_snug.h"

namespace snug::testing::habits_test {
namespace {

const std::string beside = "1 0 0 9 0 1 0 0 0 0 1 0";

nlohmann::json answer(std::vector<std::string> arguments) {
  arguments.emplace_back("--json");
  const Outcome outcome = run_snug(arguments);
  EXPECT_EQ(outcome.status, 0) << outcome.err;
  return nlohmann::json::parse(outcome.out);
}

// One line on standard error that has this text in it, nothing on standard output, status 2.
void expect_usage_error(const std::vector<std::string>& arguments, const std::string& text) {
  const Outcome outcome = run_snug(arguments);
  EXPECT_EQ(outcome.status, 2) << outcome.err;
  EXPECT_EQ(outcome.out, "");
  EXPECT_EQ(std::count(outcome.err.begin(), outcome.err.end(), '\n'), 1) << outcome.err;
  EXPECT_NE(outcome.err.find(text), std::string::npos) << outcome.err;
}

TEST(tolerance, of_collide_is_a_thousandth_by_default) {
  const std::string star = model("star.obj");
  const auto by_default = answer({"collide", star, star, "--place-b", beside});
  const auto given = answer({"collide", star, star, "--place-b", beside, "--tolerance", "0.1%"});
  EXPECT_EQ(by_default["tolerance"], given["tolerance"]);
  EXPECT_EQ(by_default["verdict"], "separated");
}

TEST(lengths, may_have_a_blank_before_the_percent_sign) {
  const std::string star = model("star.obj");
  const auto joined = answer({"collide", star, star, "--place-b", beside, "--tolerance", "2%"});
  for (const char* text : {"2 %", " 2  % "}) {
    const auto apart = answer({"collide", star, star, "--place-b", beside, "--tolerance", text});
    EXPECT_EQ(apart["tolerance"], joined["tolerance"]) << text;
  }
  expect_usage_error({"collide", star, star, "--tolerance", "2 2%"}, "'2 2%' is not a length");
  expect_usage_error({"collide", star, star, "--tolerance", "%"}, "'%' is separate");
}

TEST(lengths, of_two_words_are_refused_with_both_ways_to_write_them) {
  const std::string star = model("star.obj");
  expect_usage_error({"collide", star, star, "--tolerance", "1", "%"}, "join it to its number (1%)");
  expect_usage_error({"collide", "--tolerance", "1", "%", star, star}, "or put quotes around both (\"1 %\")");
}

TEST(schemes, have_the_names_of_usd_and_opensubdiv_too) {
  const std::string star = model("star.obj");
  for (const auto& [name, scheme] :
       std::vector<std::pair<std::string, std::string>>{{"catmullClark", "catmark"},
                                                        {"catmull-clark", "catmark"},
                                                        {"Catmull-Clark", "catmark"},
                                                        {"cc", "catmark"},
                                                        {"CC", "catmark"},
                                                        {"SCHEME_CATMARK", "catmark"},
                                                        {"LOOP", "loop"},
                                                        {"SCHEME_LOOP", "loop"},
                                                        {"doosabin", "doo-sabin"},
                                                        {"DooSabin", "doo-sabin"},
                                                        {"mid-edge", "midedge"},
                                                        {"SCHEME_BILINEAR", "bilinear"},
                                                        {"none", "flat"}}) {
    EXPECT_EQ(answer({"info", star, "--scheme", name})["scheme"], scheme) << name;
    const auto pair = answer({"collide", star, star, "--place-b", beside, "--scheme-b", name});
    EXPECT_EQ(pair["scheme"], nlohmann::json({"loop", scheme})) << name;
  }
}

TEST(schemes, that_are_none_are_refused_with_the_list) {
  for (const char* name : {"sqrt3", "SCHEME_BUTTERFLY"}) {
    expect_usage_error({"info", model("star.obj"), "--scheme", name}, "is not auto, loop, catmark,");
  }
}

TEST(boundary_rules, have_the_names_of_usd_and_opensubdiv_too) {
  const TemporaryFolder folder;
  std::ofstream(folder.file("square.obj")) << "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1 2 3\nf 1 3 4\n";
  const auto corner = [&](const std::string& rule) {
    return answer({"eval", folder.file("square.obj"), "--samples", "1", "--boundary", rule})["points"][1];
  };
  const auto sharp = corner("edge-and-corner"), smooth = corner("edge-only");
  EXPECT_NE(sharp, smooth);
  for (const char* name : {"edgeAndCorner", "VTX_BOUNDARY_EDGE_AND_CORNER"}) EXPECT_EQ(corner(name), sharp);
  for (const char* name : {"edgeOnly", "EDGE_ONLY", "VTX_BOUNDARY_EDGE_ONLY"})
    EXPECT_EQ(corner(name), smooth);
  for (const char* name : {"none", "None", "VTX_BOUNDARY_NONE"}) {
    EXPECT_EQ(answer({"eval", folder.file("square.obj"), "--boundary", name})["count"], 0) << name;
  }
}

TEST(mistyped, commands_options_and_values_are_answered_with_the_nearest) {
  const std::string star = model("star.obj");
  for (const auto& [typed, meant] : std::vector<std::pair<std::string, std::string>>{{"colide", "collide"},
                                                                                     {"collied", "collide"},
                                                                                     {"dist", "distance"},
                                                                                     {"rendre", "render"},
                                                                                     {"Info", "info"},
                                                                                     {"sub", "subdivide"}}) {
    expect_usage_error({typed, star}, "unknown command '" + typed + "'; did you mean '" + meant + "'?");
  }
  expect_usage_error({"xyzzy"}, "unknown command 'xyzzy'; see snug --help");
  expect_usage_error({"collide", star, star, "--tolerence", "1%"},
                     "unknown option '--tolerence'; did you mean '--tolerance'?");
  expect_usage_error({"info", star, "--jsn"}, "unknown option '--jsn'; did you mean '--json'?");
  expect_usage_error({"info", "--jsn"}, "did you mean '--json'?");
  expect_usage_error({"info", star, "--tolerence=1"}, "unknown option '--tolerence'; see snug info --help");
  expect_usage_error({"info", star, "-x"}, "unknown option '-x'");
  expect_usage_error({"info", star, "--scheme", "catmerk"}, "did you mean 'catmark'?");
  expect_usage_error({"bound", star, "--bounds", "tables"}, "did you mean 'table'?");
  expect_usage_error({"info", star, star}, "unexpected argument");
  expect_usage_error({"info"}, "info: MESH is missing");
  expect_usage_error({"--json", "info", star}, "comes before the command");
}

TEST(words, are_numbers_in_range_given_once_and_with_what_they_need) {
  const std::string star = model("star.obj");
  expect_usage_error({"info", star, "--threads", "-1"}, "'-1' is not a whole number from 0 to 1024");
  expect_usage_error({"info", star, "--threads", "two"}, "'two' is not a whole number from 0 to 1024");
  expect_usage_error({"info", star, "--threads", ""}, "'' is not a whole number");
  expect_usage_error({"info", star, "--threads"}, "--threads needs a value: N");
  expect_usage_error({"info", star, "--threads="}, "'' is not a whole number");
  expect_usage_error({"info", star, "--json=no"}, "--json takes no value");
  expect_usage_error({"info", star, "--threads", "1", "--threads", "2"}, "--threads is given twice");
  expect_usage_error({"bound", star, "--level", "1", "--error", "1%"},
                     "--level and --error exclude each other");
  expect_usage_error({"render", star, "--level", "1", "-o", "x.png"}, "--level needs --enclosures");
  expect_usage_error({"closest", star}, "--points is missing");
  expect_usage_error({"closest", star, "--points", "p.txt", "--relative", "2"},
                     "'2' is not a finite number from 0 to 1");
}

TEST(words, are_sorted_as_everywhere) {
  const std::string star = model("star.obj");
  const TemporaryFolder folder;
  const std::string file = folder.file("x.json");
  for (const std::vector<std::string>& arguments :
       std::vector<std::vector<std::string>>{{"info", star, "--threads", "1", "-o", file},
                                             {"info", "--threads=1", "-o" + file, star},
                                             {"info", "-o", file, "--threads=1", "--", star}}) {
    EXPECT_EQ(run_snug(arguments).status, 0);
    EXPECT_TRUE(std::filesystem::remove(file));
  }
  EXPECT_EQ(run_snug({"info", "--", "--json"}).status, 3);  // a file of that name
}

TEST(render, draws_witnesses) {
  const TemporaryFolder folder;
  const std::string star = model("star.obj"), with = folder.file("with.png"),
                    without = folder.file("without.png");
  const auto picture = [&](const std::string& file, const std::vector<std::string>& more) {
    std::vector<std::string> arguments{"render", star, "--size", "64", "-o", file};
    arguments.insert(arguments.end(), more.begin(), more.end());
    const Outcome outcome = run_snug(arguments);
    EXPECT_EQ(outcome.status, 0) << outcome.err;
    std::ifstream stream(file, std::ios::binary);
    return std::string(std::istreambuf_iterator<char>(stream), {});
  };
  const std::string bare = picture(without, {});
  EXPECT_NE(picture(with, {"--witness", "0 0 2  1,1,1"}), bare);
  EXPECT_NE(picture(with, {"--witness", "0 0 2 1 1 1", "--witness", "0 0 2 -1 -1 -1"}),
            picture(without, {"--witness", "0 0 2 1 1 1"}));
  for (const char* bad : {"0 0 2 1 1", "0 0 2 1 1 1 1", "0 0 2 1 1 x", "0 0 2 1 1 nan", ""}) {
    expect_usage_error({"render", star, "-o", with, "--witness", bad}, "is not two points");
  }
  EXPECT_EQ(run_snug({"render", star, "-o", with, "--witness", "0 0 1e300 0 0 0"}).status, 4);
}

// Help in groups: each heading once, in this order, an example last.
void expect_help(const Outcome& help, const std::vector<std::string>& in_order) {
  EXPECT_EQ(help.status, 0);
  EXPECT_EQ(help.err, "");
  std::size_t at = 0;
  for (const std::string& text : in_order) {
    const std::size_t found = help.out.find(text, at);
    ASSERT_NE(found, std::string::npos) << text << " is not where it should be in\n" << help.out;
    at = found + text.size();
  }
}

TEST(help, is_in_groups_with_an_example_and_options_for_research_last) {
  expect_help(run_snug({"--help"}), {"Usage: snug COMMAND", "Two surfaces:\n", "  collide", "  distance",
                                     "One surface, or curves:\n", "  closest", "Meshes and pictures:\n",
                                     "Example", "  snug collide"});
  expect_help(run_snug({"collide", "--help"}),
              {"Usage: snug collide A B [OPTIONS]", "Options:\n", "--tolerance LENGTH", "(default 0.1%)",
               "Poses:\n", "--place-a", "Meshes:\n", "--scheme", "Output:\n", "--json", "Effort:\n",
               "--threads", "For research:\n", "--bounds", "Examples:\n  snug collide "});
  expect_help(run_snug({"bound", "-h"}), {"--error", "For research:\n", "--bounds"});
  expect_help(run_snug({"subdivide", "--help"}), {"--level", "Example"});
  for (const char* command : {"distance", "closest", "render"}) {
    expect_help(run_snug({command, "--help"}), {"Usage: snug ", "For research:\n", "Example"});
  }
  for (const char* command : {"info", "eval", "subdivide"}) {
    const Outcome help = run_snug({command, "--help"});
    expect_help(help, {"Usage: snug ", "Example"});
    EXPECT_EQ(help.out.find("For research"), std::string::npos) << help.out;
  }
}

TEST(completion, is_for_bash) {
  const Outcome script = run_snug({"--completion", "bash"});
  EXPECT_EQ(script.status, 0);
  EXPECT_NE(script.out.find("\ncomplete -F _snug snug\n"), std::string::npos);
  EXPECT_EQ(script.out.find('%'), std::string::npos);
  EXPECT_EQ(run_snug({"--completion"}).status, 2);
  EXPECT_EQ(run_snug({"--completion", "fish"}).status, 2);
}

}  // namespace
}  // namespace snug::testing::habits_test
