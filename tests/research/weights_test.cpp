// weights, as people script it.

#include <gtest/gtest.h>

#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include <command/run_snug.h>
#include <snug/mesh.h>
#include <support/point.h>

namespace snug::testing::weights_test {
namespace {

using nlohmann::json;

constexpr const char* cube =
    "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 1 1 0\nv 0 0 1\nv 1 0 1\nv 0 1 1\nv 1 1 1\n"
    "f 1 3 4 2\nf 5 6 8 7\nf 1 2 6 5\nf 3 7 8 4\nf 1 5 7 3\nf 2 4 8 6\n";

class weights_command : public ::testing::Test {
 protected:
  std::string write(const std::string& name, const std::string& text) {
    std::ofstream(folder_.file(name)) << text;
    return folder_.file(name);
  }
  static json answer(std::vector<std::string> arguments) {
    arguments.insert(arguments.begin(), "weights");
    arguments.emplace_back("--json");
    const Outcome outcome = run_research(arguments);
    EXPECT_EQ(outcome.status, 0) << outcome.err;
    return json::parse(outcome.out, nullptr, false);
  }

  TemporaryFolder folder_;
};

// Positions are sums by the weights, which add up to 1.
TEST_F(weights_command, evaluates_nodal_functions) {
  for (const auto& [mesh, scheme] : {std::pair{model("pawn.obj"), "loop"},
                                     {write("cube.obj", cube), "catmark"},
                                     {write("box.obj", cube), "midedge"}}) {
    const ControlMesh control = read_mesh(mesh);
    const json found = answer({mesh, "--scheme", scheme, "--samples", "2"});
    EXPECT_EQ(found["command"], "weights");
    EXPECT_EQ(found["scheme"], scheme);
    EXPECT_EQ(found["count"], found["points"].size());
    for (const json& point : found["points"]) {
      Vector3 sum{};
      double one = 0;
      for (const auto& [vertex, weight] : point["weights"].items()) {
        sum = sum + weight.get<double>() * (control.points[std::stoul(vertex)] - Point3{});
        one += weight.get<double>();
      }
      ASSERT_NEAR(one, 1, 1e-14);
      for (std::size_t a = 0; a < 3; ++a) ASSERT_NEAR(sum[a], point["point"][a].get<double>(), 1e-13);
    }
  }
}

// All but the weights is what eval of snug writes, number by number.
TEST_F(weights_command, answers_for_the_places_of_eval) {
  for (const auto& [mesh, scheme] :
       {std::pair{model("pawn.obj"), "loop"}, {write("cube.obj", cube), "doo-sabin"}}) {
    for (const std::vector<std::string>& places :
         {std::vector<std::string>{"--samples", "3"},
          {"--at", write("at.txt", "0 0.25 0.5\n\n# a comment\n3 0 0.125\n")}}) {
      std::vector<std::string> arguments{"eval", mesh, "--scheme", scheme, "--json"};
      arguments.insert(arguments.end(), places.begin(), places.end());
      const json expected = json::parse(run_snug(arguments).out);
      json found = answer({mesh, "--scheme", scheme, places[0], places[1]});
      ASSERT_FALSE(found["points"].empty());
      for (json& point : found["points"]) EXPECT_EQ(point.erase("weights"), 1);
      EXPECT_EQ(found["points"], expected["points"]);
      EXPECT_EQ(found["count"], expected["count"]);
    }
  }
}

TEST_F(weights_command, prints_a_line_for_each_place) {
  const std::string mesh = write("cube.obj", cube);
  const Outcome text = run_research({"weights", mesh, "--at", "-"}, "0 0.25 0.5\n5 0 0\n");
  EXPECT_EQ(text.status, 0) << text.err;
  std::istringstream lines(text.out);
  std::string line;
  std::getline(lines, line);
  EXPECT_EQ(line, "# face u v corner  vertex:weight ...");
  std::getline(lines, line);
  EXPECT_TRUE(line.starts_with("0 0.25 0.5 0  0:0.")) << line;
  EXPECT_EQ(std::count(line.begin(), line.end(), ':'), 8) << line;
  EXPECT_FALSE(std::getline(lines, line) && std::getline(lines, line));
}

TEST_F(weights_command, refuses_curves_and_places_that_are_not_there) {
  const std::string curve = write("curve.obj", "v 0 0 0\nv 1 0 0\nv 1 1 0\nl 1 2 3\n");
  const Outcome curves = run_research({"weights", curve, "--json"});
  EXPECT_EQ(curves.status, 2);
  EXPECT_NE(curves.err.find("weights are those of surfaces"), std::string::npos) << curves.err;
  EXPECT_EQ(run_research({"weights", model("pawn.obj"), "--at", "-"}, "0 0.7 0.7\n").status, 3);
  EXPECT_EQ(run_research({"weights", model("pawn.obj"), "--samples", "0"}).status, 2);
  EXPECT_EQ(run_research({"weights", model("pawn.obj"), "-o", folder_.file("a.npy")}).status, 2);
}

}  // namespace
}  // namespace snug::testing::weights_test
