#include <gtest/gtest.h>
#include <sys/resource.h>

#include <algorithm>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "run_snug.h"

namespace snug::testing::budget_test {
namespace {

using nlohmann::json;

struct Question {
  std::vector<std::string> arguments;
  std::string budget;
  std::string count;  // JSON pointer of the work done; empty: memory alone is held
  bool spent = true;  // more is asked for than the budget allows
};

std::vector<Question> questions(const TemporaryFolder& folder, const std::string& facets,
                                const std::string& points, const std::string& rays) {
  const std::string pawn = model("pawn.obj"), pin = model("pin.obj"), out = folder.file("out.ply");
  return {
      {{"bound", pawn, "--error", "1e-9"}, "1000", "/splits"},
      {{"render", pawn, "--enclosures", "--error", "1e-9", "--size", "100", "-o", folder.file("out.png")},
       "1000",
       "",
       false},
      {{"collide", pawn, pawn, "--tolerance", "1e-13"}, "10", "/stats/splits"},
      {{"collide", pawn, pawn, "--move-b", "0.1 0.3 0", "--all", "--error", "1e-9", "--tolerance", "1e-9"},
       "1000",
       ""},
      {{"collide", pawn, pawn, "--move-b", "0.1 0.3 0", "--solid", "--penetration"}, "1000", "", false},
      {{"distance", pawn, pin, "--move-b", "0 0 9", "--absolute", "1e-14"}, "1000", "/stats/splits"},
      {{"closest", pawn, "--points", points, "--absolute", "1e-14"}, "1000", ""},
      {{"ray", pawn, "--rays", rays, "--absolute", "1e-14"}, "10", ""},
      {{"self-contact", pawn, "--within", "1e-7"}, "1000", ""},
      {{"self-contact", pin, "--within", "3%"}, "20000", ""},
      {{"measure", pawn, "--relative", "1e-12"}, "1000", "/stats/splits"},
      {{"time-of-contact", pawn, pawn, "--velocity-b", "0 0 9", "--move-b", "1 0 -5", "--tolerance", "1e-13"},
       "5",
       ""},
      {{"deviation", pawn, facets, "--absolute", "1e-8"}, "10000", ""},
      {{"deviation", pawn, pin, "--surface", "--absolute", "1e-9"}, "10000", ""},
      {{"hull", pin, "--error", "1e-7", "--outer", out}, "300", "/outer/triangles"},
      {{"hull", pin, "--error", "1e-7", "--inner", out}, "30000", "/inner/triangles"},
      {{"envelope", pawn, "--error", "1e-7", "-o", folder.file("around.obj")}, "300", "/envelope/triangles"},
      {{"tessellate", pawn, "--error", "1e-9", "-o", out}, "1000", "/triangles"},
      {{"tessellate", pawn, "--max-angle", "0.01", "-o", out}, "1000", "/triangles"},
      {{"tessellate", pawn, "--error", "1e-9", "--coarsen", "-o", out}, "1000", "/triangles"},
      {{"tessellate", pawn, "--max-triangles", "4000000000", "-o", out}, "1000", "/triangles"},
  };
}

// The outcome of a document, or of one of its results.
bool ended_by_the_budget(const json& document) {
  if (!document.contains("results")) return document["outcome"] == "budget-spent";
  const json& results = document["results"];
  return std::any_of(results.begin(), results.end(), ended_by_the_budget);
}

// Little is asked of the machine by whoever gives a small budget, however much they ask for.
TEST(budget, bounds_the_work_and_the_memory_of_every_command) {
  SNUG_SKIP_UNDER_SANITIZERS();
  const TemporaryFolder folder;
  const std::string points = folder.file("points.txt"), rays = folder.file("rays.txt"),
                    facets = folder.file("facets.off");
  std::ofstream(points) << "0 0 0\n1 2 3\n9 9 9\n";
  std::ofstream(rays) << "9 9 9 -1 -1 -1\n5 1.5 0 -1 0 0\n";
  ASSERT_EQ(run_snug({"subdivide", model("pawn.obj"), "--level", "0", "-o", facets}).status, 0);
  const Surroundings small{[] {
                             const rlimit memory{rlim_t{1} << 30, rlim_t{1} << 30};
                             setrlimit(RLIMIT_AS, &memory);
                           },
                           {}};
  for (const auto& [arguments, budget, count, spent] : questions(folder, facets, points, rays)) {
    std::vector<std::string> command = arguments;
    for (const char* const more : {"--max-splits", budget.c_str(), "--quiet"}) command.emplace_back(more);
    if (command[0] != "render") command.emplace_back("--json");
    const Outcome outcome = run_snug_in(small, command);
    std::string line;
    for (const std::string& word : command) line += word + " ";
    EXPECT_TRUE(outcome.status == 5 || (!spent && outcome.status == 0))
        << line << ": " << outcome.status << outcome.err;
    if (command[0] == "render" || outcome.out.empty()) continue;
    const json document = json::parse(outcome.out);
    EXPECT_TRUE(!spent || ended_by_the_budget(document)) << line << document["outcome"];
    if (count.empty()) continue;
    EXPECT_LE(document.at(json::json_pointer(count)).get<std::uint64_t>(), std::stoull(budget)) << line;
  }
}

// The advised budget is enough, and one less is not; an unknown one is not named.
TEST(budget, numbers_of_triangles_that_are_named_are_enough) {
  const TemporaryFolder folder;
  const std::string out = folder.file("out.off"), pawn = model("pawn.obj");
  const auto asked = [&](const std::string& most, const std::string& budget, const std::string& edge) {
    return run_snug({"tessellate", pawn, "--max-triangles", most, "--max-splits", budget, "--max-edge", edge,
                     "--quiet", "-o", out});
  };
  for (const char* const edge : {"90%", "5%", "1%"}) {
    const Outcome refused = asked("3", "1000000", edge);
    ASSERT_EQ(refused.status, 4);
    const std::size_t at = refused.err.find("take ");
    ASSERT_NE(at, std::string::npos) << refused.err;
    const std::uint64_t needed = std::stoull(refused.err.substr(at + 5));
    EXPECT_EQ(asked(std::to_string(needed), "1000000", edge).status, 0) << edge;
    EXPECT_EQ(asked(std::to_string(needed - 1), "1000000", edge).status, 4) << edge;
  }
  const Outcome unknown = asked("1000", "1000", "0.01%");
  EXPECT_EQ(unknown.status, 4);
  EXPECT_EQ(unknown.err.find("take "), std::string::npos) << unknown.err;
  EXPECT_NE(unknown.err.find("budget of 1000"), std::string::npos) << unknown.err;
}

}  // namespace
}  // namespace snug::testing::budget_test
