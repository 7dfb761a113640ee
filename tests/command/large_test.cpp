#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "run_snug.h"

namespace snug::testing::large_test {
namespace {

TEST(large, a_million_triangles_are_bounded) {
  const TemporaryFolder folder;
  const std::string mesh = folder.file("million.off");
  ASSERT_EQ(run_snug({"subdivide", model("bust.obj"), "--level", "5", "-o", mesh}).status, 0);
  const Outcome info = run_snug({"info", mesh, "--json"});
  ASSERT_EQ(info.status, 0) << info.err;
  EXPECT_GT(nlohmann::json::parse(info.out)["faces"], 1'000'000);
  const Outcome bound = run_snug({"bound", mesh});
  EXPECT_EQ(bound.status, 0) << bound.err;
  const Outcome collide = run_snug({"collide", mesh, model("pawn.obj"), "--tolerance", "1%", "--json"});
  EXPECT_EQ(collide.status, 0) << collide.err;
}

TEST(polyhedra, beyond_four_million_facets_are_refused_and_leave_no_file) {
  const TemporaryFolder folder;
  const Outcome outcome =
      run_snug({"bound", model("star.obj"), "--quiet", "--level", "8", "--polyhedra", folder.file("a.ply")});
  EXPECT_EQ(outcome.status, 4);
  EXPECT_NE(outcome.err.find("4000000 facets"), std::string::npos) << outcome.err;
  EXPECT_TRUE(folder.empty());
}

}  // namespace
}  // namespace snug::testing::large_test
