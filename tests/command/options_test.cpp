#include <gtest/gtest.h>

#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>

#include <testing/counts.h>

#include "run_snug.h"

namespace snug::testing::options_test {
namespace {

// The document without what may differ between runs.
nlohmann::json comparable(const std::vector<std::string>& arguments) {
  const Outcome outcome = run_snug(arguments);
  EXPECT_EQ(outcome.status, 0) << outcome.err;
  auto document = nlohmann::json::parse(outcome.out);
  document.erase("seconds");
  document.erase("stats");
  return document;
}

TEST(threads, change_nothing) {
  for (const std::vector<std::string>& base :
       {std::vector<std::string>{"bound", model("bust.obj"), "--error", "0.5%", "--json"},
        {"collide", model("bust.obj"), model("pawn.obj"), "--tolerance", "0.1%", "--json"},
        {"eval", model("head.obj"), "--json"}}) {
    auto one = base, two = base;
    one.insert(one.end(), {"--threads", "1"});
    two.insert(two.end(), {"--threads", "2"});
    EXPECT_EQ(comparable(one), comparable(two)) << base[0];
  }
}

TEST(usage, ends_with_2) {
  const std::string star = model("star.obj");
  for (const std::vector<std::string>& arguments : std::vector<std::vector<std::string>>{
           {"frobnicate"},
           {"bound"},
           {"bound", star, "--error", "-1"},
           {"bound", star, "--error", "0"},
           {"bound", star, "--error", "1x%"},
           {"bound", star, "--error", "nan"},
           {"bound", star, "--error", "1%", "--level", "2"},
           {"bound", star, "--level", "99"},
           {"bound", star, "--scheme", "butterfly"},
           {"bound", star, "--bounds", "tables"},
           {"collide", star, star, "--tolerance", "1%", "--bounds", "control-box"},
           {"bound", star, "--threads", "-1"},
           {"collide", star, star, "--tolerance", "1%", "--place-b", "1 0 0"},
           {"collide", star, star, "--tolerance", "1%", "--place-b", "1 0 0 x 0 1 0 0 0 0 1 0"},
           {"subdivide", star},
           {"render", star}}) {
    const Outcome outcome = run_snug(arguments);
    EXPECT_EQ(outcome.status, 2) << (arguments.empty() ? "" : arguments[0]) << outcome.err;
    EXPECT_EQ(std::count(outcome.err.begin(), outcome.err.end(), '\n'), 1) << outcome.err;
    EXPECT_EQ(outcome.out, "");
  }
}

TEST(options, that_would_change_nothing_are_refused) {
  const std::string star = model("star.obj");
  const TemporaryFolder folder;
  const std::string png = folder.file("star.png"), obj = folder.file("star.obj");
  for (const std::vector<std::string>& arguments : std::vector<std::vector<std::string>>{
           {"experiment", "rates"},  // another program's
           {"info", star, "--max-splits", "9"},
           {"info", star, "--bounds", "table"},
           {"eval", star, "--max-splits", "9"},
           {"eval", star, "--bounds", "table"},
           {"eval", star, "--degree", "2"},
           {"subdivide", star, "-o", obj, "--max-splits", "9"},
           {"subdivide", star, "-o", obj, "--bounds", "rows"},
           {"subdivide", star, "-o", obj, "--degree", "3"},
           {"subdivide", star, "-o", obj, "--scheme", "catmark", "--vertex-rule", "older"},
           {"bound", star, "--degree", "3"},
           {"bound", star, "--bounds", "control-box"},
           {"bound", star, "--bounds", "table", "--layout", "ngon"},
           {"bound", star, "--creases", "split"},
           {"bound", star, "--scheme", "midedge", "--boundary", "none"},
           {"render", star, "-o", png, "--bounds", "table"},
           {"render", star, "-o", png, "--max-splits", "9"},
           {"render", star, "-o", png, "--nearest-rigid"},
           {"collide", star, star, "--volume", "obb"},
           {"collide", star, star, "--nearest-rigid"},
           {"collide", star, star, "--penetration"},
           {"distance", star, star, "--scheme", "loop", "--scheme-a", "loop", "--scheme-b", "catmark"},
           {"closest", star, "--points", "p.txt", "--volume", "obb"}}) {
    const Outcome outcome = run_snug(arguments);
    EXPECT_EQ(outcome.status, 2) << arguments[0] << ' ' << arguments.back() << outcome.err;
    EXPECT_EQ(std::count(outcome.err.begin(), outcome.err.end(), '\n'), 1) << outcome.err;
    EXPECT_EQ(outcome.out, "");
  }
  EXPECT_TRUE(folder.empty());
}

TEST(old_names, work_for_a_version_with_a_note) {
  const TemporaryFolder folder;
  const std::string pin = model("pin.obj"), bracket = model("bracket.obj"),
                    points = folder.file("points.txt"), rays = folder.file("rays.txt"),
                    facets = folder.file("facets.off"), out = folder.file("out.ply");
  std::ofstream(points) << "1 2 3\n";
  std::ofstream(rays) << "0.02 0.01 9 0 0 -1\n";
  ASSERT_EQ(run_snug({"tessellate", pin, "--error", "5%", "-o", facets}).status, 0);
  using Words = std::vector<std::string>;
  struct Name {
    Words words;
    std::string before, now, value;
  };
  std::vector<Name> names{
      {{"bound", pin}, "--tolerance", "--error", "5%"},
      {{"tessellate", pin, "-o", out}, "--tolerance", "--error", "5%"},
      {{"hull", pin, "--outer", out}, "--tolerance", "--error", "5%"},
      {{"envelope", pin, "-o", out}, "--tolerance", "--error", "5%"},
      {{"render", pin, "--enclosures", "--size", "50", "-o", folder.file("pin.png")},
       "--tolerance",
       "--error",
       "5%"},
      {{"collide", pin, bracket, "--all"}, "--precision", "--error", "5%"},
      {{"deviation", pin, facets}, "--precision", "--absolute", "5%"},
      {{"deviation", pin, facets}, "--tolerance", "--threshold", "50%"},
      {{"distance", pin, bracket}, "--precision", "--absolute", "5%"},
      {{"closest", pin, "--points", points}, "--precision", "--absolute", "5%"},
      {{"ray", pin, "--rays", rays}, "--precision", "--absolute", "5%"},
      {{"measure", pin}, "--precision", "--relative", "5%"},
      {{"self-contact", pin}, "--tolerance", "--within", "0.1%"},
  };
  for (const Words& words : std::vector<Words>{{"bound", pin},
                                               {"distance", pin, bracket},
                                               {"deviation", pin, facets},
                                               {"measure", pin},
                                               {"self-contact", pin},
                                               {"tessellate", pin, "--error", "5%", "-o", out},
                                               {"hull", pin, "--error", "5%", "--outer", out},
                                               {"envelope", pin, "--error", "5%", "-o", out}}) {
    names.push_back({words, "--budget", "--max-splits", "1000000"});
  }
  const auto expect_same = [](Words before, Words now, const std::string& note) {
    before.emplace_back("--json");
    now.emplace_back("--json");
    EXPECT_EQ(comparable(before), comparable(now)) << note;
    EXPECT_NE(run_snug(before).err.find("note: " + note), std::string::npos) << now.front() << ' ' << note;
    before.emplace_back("--quiet");
    EXPECT_EQ(run_snug(before).err, "") << now.front() << ' ' << note;
  };
  std::size_t number = 0;
  for (const auto& [words, before, now, value] : names) {
    if (testing::fewer(3) == 1 && ++number % 3 != 0)
      continue;  // which commands take their time under sanitizers
    Words old_words = words, new_words = words;
    old_words.insert(old_words.end(), {before, value});
    new_words.push_back(now + "=" + value);
    expect_same(old_words, new_words, before + " is now " + now);
  }
  expect_same({"self", pin}, {"self-contact", pin}, "self is now self-contact");
  expect_same({"contact", pin, bracket, "--velocity-b", "0 0 9"},
              {"time-of-contact", pin, bracket, "--velocity-b", "0 0 9"}, "contact is now time-of-contact");
  EXPECT_EQ(run_snug({"bound", pin, "--error", "5%", "--tolerance", "5%"}).status, 2);
}

TEST(placements, that_are_not_rigid_are_refused) {
  const std::string star = model("star.obj");
  for (const char* placement : {"2 0 0 0 0 1 0 0 0 0 1 0", "1 0 0 0 0 1 0 0 0 0 -1 0"}) {
    EXPECT_EQ(run_snug({"collide", star, star, "--tolerance", "1%", "--place-b", placement}).status, 4);
  }
}

TEST(verdicts, are_exit_codes_on_request_only) {
  const std::string star = model("star.obj");
  const std::string far = "1 0 0 9 0 1 0 0 0 0 1 0";
  EXPECT_EQ(run_snug({"collide", star, star, "--tolerance", "1%"}).status, 0);
  EXPECT_EQ(run_snug({"collide", star, star, "--tolerance", "1%", "--exit-code"}).status, 10);
  EXPECT_EQ(run_snug({"collide", star, star, "--tolerance", "1%", "--exit-code", "--place-b", far}).status,
            0);
}

TEST(tables, bound_render_and_collide) {
  const std::string star = model("star.obj");
  const auto rows = comparable({"bound", star, "--json"});
  const auto table = comparable({"bound", star, "--bounds", "table", "--json"});
  EXPECT_EQ(table["count"], rows["count"]);
  EXPECT_GT(table["max_radius"], rows["max_radius"]);
  EXPECT_EQ(table["enclosures"][0]["lower"].size(), 3u);
  EXPECT_EQ(table["enclosures"][0]["corners"], rows["enclosures"][0]["corners"]);
  for (const char* place : {"1 0 0 9 0 1 0 0 0 0 1 0", "1 0 0 0.2 0 1 0 0 0 0 1 0"}) {
    const std::vector<std::string> pair{"collide", star,        star,  "--tolerance",
                                        "1%",      "--place-b", place, "--json"};
    auto by_table = pair;
    by_table.insert(by_table.end(), {"--bounds", "table"});
    // Of surfaces that meet "within" and "intersecting" are both true.
    const std::string with_table = comparable(by_table)["verdict"], with_rows = comparable(pair)["verdict"];
    EXPECT_NE(with_table, "undecided");
    EXPECT_EQ(with_table == "separated", with_rows == "separated");
  }
  const TemporaryFolder folder;
  const Outcome picture = run_snug(
      {"render", star, "--enclosures", "--bounds", "table", "--size", "40", "-o", folder.file("star.png")});
  EXPECT_EQ(picture.status, 0) << picture.err;
}

TEST(no_command, shows_the_help_on_standard_error_and_ends_with_2) {
  const Outcome outcome = run_snug({});
  EXPECT_EQ(outcome.status, 2);
  EXPECT_EQ(outcome.out, "");
  EXPECT_EQ(outcome.err, run_snug({"--help"}).out);
}

TEST(help_and_version, go_to_standard_output) {
  const Outcome version = run_snug({"--version"});
  EXPECT_EQ(version.status, 0);
  EXPECT_TRUE(version.out.starts_with("snug 0.1.0 (")) << version.out;
  EXPECT_EQ(run_snug({"--help"}).status, 0);
  for (const char* command : {"info", "bound", "eval", "subdivide", "collide", "render"}) {
    const Outcome help = run_snug({command, "--help"});
    EXPECT_EQ(help.status, 0);
    EXPECT_FALSE(help.out.empty());
  }
}

TEST(eval, reads_parameters_from_a_file_and_names_bad_lines) {
  const TemporaryFolder folder;
  std::ofstream(folder.file("good.txt")) << "# a comment\n0 0 0\n\n23 0.25 0.5\n";
  std::ofstream(folder.file("bad.txt")) << "0 0 0\n0 0.7 0.5\n";
  std::ofstream(folder.file("beyond.txt")) << "24 0 0\n";
  const Outcome good = run_snug({"eval", model("star.obj"), "--at", folder.file("good.txt"), "--json"});
  EXPECT_EQ(nlohmann::json::parse(good.out)["points"].size(), 2u);
  const Outcome bad = run_snug({"eval", model("star.obj"), "--at", folder.file("bad.txt")});
  EXPECT_EQ(bad.status, 3);
  EXPECT_NE(bad.err.find("bad.txt:2"), std::string::npos) << bad.err;
  EXPECT_EQ(run_snug({"eval", model("star.obj"), "--at", folder.file("beyond.txt")}).status, 3);
}

TEST(files_and_streams, are_the_same_document) {
  const TemporaryFolder folder;
  const std::string file = folder.file("star.json");
  EXPECT_EQ(run_snug({"bound", model("star.obj"), "-o", file}).status, 0);
  std::ifstream written(file);
  auto document = nlohmann::json::parse(written);
  document.erase("seconds");
  EXPECT_EQ(document, comparable({"bound", model("star.obj"), "--json"}));
}

TEST(interruption, ends_with_130_and_leaves_nothing) {
  const TemporaryFolder folder;
  const Outcome outcome = interrupt_snug(
      {"subdivide", model("bust.obj"), "--level", "9", "--quiet", "-o", folder.file("huge.obj")}, 300);
  EXPECT_EQ(outcome.status, 130) << outcome.err;
  EXPECT_TRUE(folder.empty());
}

}  // namespace
}  // namespace snug::testing::options_test
