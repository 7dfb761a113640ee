#include <gtest/gtest.h>
#include <testing/counts.h>
#include <testing/places.h>

#include <algorithm>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>
#include <set>

#include "run_snug.h"

namespace snug::testing::bad_input_test {
namespace {

// Rows "| file | status | what |" of the corpus' index.
std::map<std::string, int> corpus() {
  std::map<std::string, int> files;
  std::ifstream index(testing::corpus_dir() + "/INDEX.md");
  for (std::string line; std::getline(index, line);) {
    if (!line.starts_with("| ")) continue;
    const auto bar = line.find(" | ", 2);
    if (bar == std::string::npos) continue;
    std::string name = line.substr(2, bar - 2);
    name.erase(std::remove(name.begin(), name.end(), '`'), name.end());
    while (name.ends_with(' ')) name.pop_back();
    const char digit = line[line.find_first_not_of(' ', bar + 3)];
    if (digit >= '0' && digit <= '9') files[name] = digit - '0';
  }
  return files;
}

void expect_one_line_error(const Outcome& outcome, const std::string& about) {
  EXPECT_EQ(std::count(outcome.err.begin(), outcome.err.end(), '\n'), 1) << about << ": " << outcome.err;
  EXPECT_TRUE(outcome.err.starts_with("snug: ")) << about << ": " << outcome.err;
  EXPECT_NE(outcome.err.find(about), std::string::npos) << outcome.err;
}

TEST(bad_input, ends_with_the_status_of_the_index_for_every_command) {
  const std::map<std::string, int> files = corpus();
  ASSERT_GT(files.size(), 100u);
  // Faces that name a vertex twice: refinement needs no patches.
  const std::set<std::string> refined{"repeated_index.obj", "repeated_index.off", "repeated_index.ply"};
  std::size_t number = 0;
  for (const auto& [name, listed] : files) {
    const std::string path = testing::corpus_dir() + "/" + name;
    const Outcome info = run_snug({"info", path, "--json", "--quiet"});
    EXPECT_EQ(info.status, listed == 3 ? 3 : 0) << name << info.err;
    int expected = listed;
    if (info.status == 0) {
      const auto document = nlohmann::json::parse(info.out);
      EXPECT_EQ(document["kinds"].is_null(), document["refusal"].is_string());
      // Legal meshes whose scheme or rules are not there yet.
      const std::string refusal = document["refusal"].is_null() ? "" : document["refusal"].get<std::string>();
      if (refusal.find("not supported yet") != std::string::npos) expected = 4;
    }
    const TemporaryFolder folder;
    const std::vector<std::vector<std::string>> commands{
        {"bound", path, "--quiet", "-o", folder.file("bound.json")},
        {"eval", path, "--quiet", "--samples", "2", "-o", folder.file("eval.json")},
        {"subdivide", path, "--quiet", "-o", folder.file("fine.obj")},
        {"collide", path, path, "--quiet", "--tolerance", "1%", "-o", folder.file("collide.json")},
        {"render", path, "--quiet", "--size", "40", "-o", folder.file("picture.png")}};
    // Whatever reads refuses, and what it accepts is one mesh for all: some of the commands by turns.
    const std::size_t some = testing::long_check() ? commands.size() : testing::fewer(expected == 0 ? 2 : 1);
    for (std::size_t i = 0; i < some; ++i) {
      const std::vector<std::string>& command = commands[(number + i) % commands.size()];
      const Outcome outcome = run_snug(command);
      const int status = command[0] == "subdivide" && refined.contains(name) ? 0 : expected;
      EXPECT_EQ(outcome.status, status) << command[0] << " " << name << ": " << outcome.err;
      if (status != 0) {
        expect_one_line_error(outcome, name);
        EXPECT_TRUE(folder.empty()) << command[0] << " " << name << " left a file";
      } else {
        EXPECT_TRUE(std::filesystem::exists(command.back())) << command[0] << " " << name;
        std::filesystem::remove(command.back());
      }
    }
    ++number;
  }
}

TEST(bad_input, missing_files_and_folders_are_named) {
  expect_one_line_error(run_snug({"bound", "nowhere.obj"}), "nowhere.obj");
  EXPECT_EQ(run_snug({"bound", "nowhere.obj"}).status, 3);
  EXPECT_EQ(run_snug({"bound", testing::corpus_dir()}).status, 3);
  EXPECT_EQ(run_snug({"subdivide", model("star.obj"), "-o", "/nowhere/at/all.obj"}).status, 3);
  EXPECT_EQ(run_snug({"subdivide", model("star.obj"), "-o", "out.xyz"}).status, 3);
}

TEST(bad_input, a_lone_triangle_works) {
  const std::string triangle = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";
  for (const char* rule : {"edge-and-corner", "edge-only"}) {
    EXPECT_EQ(run_snug({"bound", "-", "--boundary", rule, "--error", "0.1%"}, triangle).status, 0);
  }
  const auto none =
      nlohmann::json::parse(run_snug({"bound", "-", "--boundary", "none", "--json"}, triangle).out);
  EXPECT_EQ(none["count"], 0);
}

}  // namespace
}  // namespace snug::testing::bad_input_test
