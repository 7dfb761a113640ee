#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "run_snug.h"

namespace snug::testing {
namespace {

// A cube of six open sheets, each with vertices of its own, which are `gap` outside of where they meet.
std::string six_sheets(const std::string& gap) {
  std::string text;
  const std::string low = "-" + gap, high = "1" + gap.substr(1);
  for (int axis = 0; axis < 3; ++axis) {
    for (const bool upper : {false, true}) {
      for (int k = 0; k < 4; ++k) {
        const int turn = upper ? k : 3 - k;
        std::string p[3];
        p[axis] = upper ? high : low;
        p[(axis + 1) % 3] = turn == 1 || turn == 2 ? "1" : "0";
        p[(axis + 2) % 3] = turn >= 2 ? "1" : "0";
        text += "v " + p[0] + ' ' + p[1] + ' ' + p[2] + '\n';
      }
    }
  }
  for (int f = 0; f < 6; ++f) {
    text += 'f';
    for (int k = 1; k <= 4; ++k) text += ' ' + std::to_string(4 * f + k);
    text += '\n';
  }
  return text;
}

TEST(vertices_that_stand_twice, are_noted_with_their_number_and_joined_by_weld_0) {
  const std::string sheets = six_sheets("0.0");
  const Outcome apart = run_snug({"info", "-", "--json"}, sheets);
  EXPECT_NE(apart.err.find("24 vertices stand exactly where others stand, in 8 places"), std::string::npos);
  EXPECT_NE(apart.err.find("24 boundary edges lie on others"), std::string::npos) << apart.err;
  EXPECT_NE(apart.err.find("--weld 0"), std::string::npos) << apart.err;
  EXPECT_EQ(run_snug({"info", "-", "--json", "--quiet"}, sheets).err, "");
  EXPECT_FALSE(nlohmann::json::parse(apart.out)["closed"].get<bool>());
  const Outcome joined = run_snug({"info", "-", "--json", "--weld", "0"}, sheets);
  EXPECT_NE(joined.err.find("16 vertices were welded"), std::string::npos) << joined.err;
  EXPECT_EQ(joined.err.find("stand exactly"), std::string::npos) << joined.err;
  EXPECT_TRUE(nlohmann::json::parse(joined.out)["closed"].get<bool>());
}

TEST(vertices_that_stand_twice, are_noted_where_they_nearly_do_with_the_length_that_joins_them) {
  const std::string sheets = six_sheets("0.0000001");
  const Outcome apart = run_snug({"info", "-", "--json"}, sheets);
  const std::string option = "--weld ";
  const std::size_t at = apart.err.find(option);
  ASSERT_NE(at, std::string::npos) << apart.err;
  const std::string length =
      apart.err.substr(at + option.size(), apart.err.find(' ', at + option.size()) - at - option.size());
  EXPECT_NEAR(std::stod(length), std::sqrt(2e-14), 1e-12);
  const Outcome joined = run_snug({"info", "-", "--json", "--weld", length}, sheets);
  EXPECT_TRUE(nlohmann::json::parse(joined.out)["closed"].get<bool>()) << joined.err;
}

}  // namespace
}  // namespace snug::testing
