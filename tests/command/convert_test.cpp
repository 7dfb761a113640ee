#include <support/read_file.h>

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>
#include <string>
#include <vector>

#include "run_snug.h"

namespace snug::testing::convert_test {
namespace {

using nlohmann::json;

std::string text_of(const std::string& path) { return read_file(path); }

TEST(convert, writes_a_solid_and_says_how_near_it_is) {
  const TemporaryFolder folder;
  const std::string file = folder.file("bracket.step");
  const Outcome outcome =
      run_snug({"convert", model("bracket.obj"), "-o", file, "--error", "0.01mm", "--units", "cm", "--json"});
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  const json found = json::parse(outcome.out);
  EXPECT_EQ(found["error"], 0.001);
  EXPECT_LE(found["error_bound"], 0.001);
  EXPECT_LE(found["gap_bound"], 1e-13);
  EXPECT_EQ(found["outcome"], "complete");
  EXPECT_EQ(found["solids"], 1);
  EXPECT_EQ(found["sheets"], 0);
  EXPECT_GE(found["spans"], found["faces"]);
  const std::string text = text_of(file);
  EXPECT_EQ(found["bytes"], text.size());
  EXPECT_NE(text.find("MANIFOLD_SOLID_BREP('bracket'"), std::string::npos);
  EXPECT_NE(text.find("SI_UNIT(.CENTI.,.METRE.)"), std::string::npos);
  // The same to standard output.
  EXPECT_EQ(run_snug({"convert", model("bracket.obj"), "-o", "-", "--error", "0.01mm", "--units", "cm"}).out,
            text);
}

TEST(convert, says_what_it_cannot_do_and_leaves_nothing) {
  const TemporaryFolder folder;
  const auto refused = [&](std::vector<std::string> arguments, int status, const std::string& text) {
    arguments.insert(arguments.begin(), "convert");
    const Outcome outcome = run_snug(arguments);
    EXPECT_EQ(outcome.status, status) << outcome.err;
    EXPECT_NE(outcome.err.find(text), std::string::npos) << outcome.err;
    EXPECT_EQ(outcome.out, "");
    EXPECT_TRUE(std::filesystem::is_empty(folder.path()));
  };
  refused({model("bracket.obj")}, 2, "-o FILE.step is missing");
  refused({model("bracket.obj"), "-o", folder.file("a.stl")}, 2, ".step or .stp");
  refused({model("bracket.obj"), "-o", folder.file("a.step"), "--error", "1furlong"}, 2,
          "not a positive length");
  refused({model("bracket.obj"), "-o", folder.file("a.step"), "--error", "1e-20"}, 4, "the least is");
  refused({model("bracket.obj"), "--scheme", "midedge", "-o", folder.file("a.step")}, 4, "midedge");
}

// By its usual name, and by the angle.
TEST(convert, makes_faces_meet_smoothly) {
  const TemporaryFolder folder;
  const auto angle = [&](const std::vector<std::string>& more) -> double {
    std::vector<std::string> words{"convert", model("bracket.obj"), "-o", folder.file("a.step"), "--json"};
    words.insert(words.end(), more.begin(), more.end());
    const Outcome outcome = run_snug(words);
    EXPECT_EQ(outcome.status, 0) << outcome.err;
    return json::parse(outcome.out)["break_angle"];
  };
  EXPECT_GT(angle({"--continuity", "g0"}), 0.1);
  EXPECT_LE(angle({"--continuity", "g1"}), 0.1);
  EXPECT_LE(angle({"--max-angle", "0.05"}), 0.05);
}

// Two parts that overlap, and one that is shorter than a millimetre: written, but not silently.
TEST(convert, says_what_cad_programs_may_stumble_over) {
  const TemporaryFolder folder;
  std::string text = text_of(model("bracket.obj"));
  const std::string alone = folder.file("alone.obj"), twice = folder.file("twice.obj"),
                    file = folder.file("a.step");
  std::ofstream(alone) << text;
  std::string second;
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);) {
    std::istringstream words(line);
    std::string word;
    words >> word;
    if (word == "v") {
      double x = 0, y = 0, z = 0;
      words >> x >> y >> z;
      second += "v " + std::to_string(x + 0.25) + ' ' + std::to_string(y + 0.125) + ' ' +
                std::to_string(z + 0.0625) + '\n';
    } else if (word == "f") {
      second += "f";
      for (int corner = 0; words >> corner;) second += ' ' + std::to_string(corner + 16);
      second += '\n';
    }
  }
  std::ofstream(twice) << text << second;
  const Outcome clear = run_snug({"convert", alone, "-o", file, "--error", "1%", "--json"});
  ASSERT_EQ(clear.status, 0) << clear.err;
  EXPECT_EQ(json::parse(clear.out)["self_contact"], "clear");
  EXPECT_EQ(clear.err.find("note"), std::string::npos) << clear.err;
  const Outcome meets = run_snug({"convert", twice, "-o", file, "--error", "1%", "--json"});
  ASSERT_EQ(meets.status, 0) << meets.err;
  EXPECT_EQ(json::parse(meets.out)["self_contact"], "intersecting");
  EXPECT_NE(meets.err.find("twice.obj meets itself, near "), std::string::npos) << meets.err;
  const Outcome small = run_snug({"convert", alone, "-o", file, "--error", "1%", "--scale", "0.01"});
  ASSERT_EQ(small.status, 0) << small.err;
  EXPECT_NE(small.err.find("alone.obj is 0.02 mm long"), std::string::npos) << small.err;
  EXPECT_EQ(run_snug({"convert", alone, "-o", file, "--error", "1%", "--scale", "0.01", "--units", "m"})
                .err.find("long"),
            std::string::npos);
}

TEST(convert, a_scene_is_an_assembly) {
  const TemporaryFolder folder;
  const std::string scene = folder.file("scene.json"), file = folder.file("scene.step");
  const std::string mesh = json(model("bracket.obj")).dump();
  std::ofstream(scene) << R"({"parts": [{"name": "a", "mesh": )" << mesh << R"(}, {"name": "b", "mesh": )"
                       << mesh << R"(, "place": {"move": [3, 0, 0]}}]})";
  const Outcome outcome = run_snug({"convert", "--scene", scene, "-o", file, "--error", "1%", "--json"});
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  const json found = json::parse(outcome.out);
  EXPECT_EQ(found["parts"], 2);
  ASSERT_EQ(found["shapes"].size(), 1u);
  EXPECT_EQ(found["shapes"][0]["name"], "bracket");
  EXPECT_LE(found["shapes"][0]["error_bound"], 0.02);
  const std::string text = text_of(file);
  EXPECT_NE(text.find("NEXT_ASSEMBLY_USAGE_OCCURRENCE('2','b'"), std::string::npos);
  EXPECT_NE(text.find("PRODUCT('scene'"), std::string::npos);
}

TEST(convert, lengths_with_a_unit_need_a_mesh_with_one) {
  const TemporaryFolder folder;
  const Outcome outcome =
      run_snug({"tessellate", model("bracket.obj"), "-o", folder.file("a.ply"), "--error", "0.1mm"});
  EXPECT_EQ(outcome.status, 2);
  EXPECT_NE(outcome.err.find("a length in mm needs a mesh whose units are known"), std::string::npos)
      << outcome.err;
}

}  // namespace
}  // namespace snug::testing::convert_test
