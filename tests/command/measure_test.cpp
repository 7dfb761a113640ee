// measure, as people script it.

#include <gtest/gtest.h>

#include <fstream>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "run_snug.h"

namespace snug::testing::measure_test {
namespace {

using nlohmann::json;

constexpr const char* box =
    "v 0 0 0\nv 2 0 0\nv 0 3 0\nv 2 3 0\nv 0 0 4\nv 2 0 4\nv 0 3 4\nv 2 3 4\n"
    "f 1 3 4 2\nf 5 6 8 7\nf 1 2 6 5\nf 3 7 8 4\nf 1 5 7 3\nf 2 4 8 6\n";

class measure_command : public ::testing::Test {
 protected:
  std::string write(const std::string& name, const std::string& text) {
    std::ofstream(folder_.file(name)) << text;
    return folder_.file(name);
  }
  static json answer(std::vector<std::string> arguments, int status = 0) {
    arguments.insert(arguments.begin(), "measure");
    arguments.emplace_back("--json");
    const Outcome outcome = run_snug(arguments);
    EXPECT_EQ(outcome.status, status) << outcome.err;
    return json::parse(outcome.out, nullptr, false);
  }
  static void expect_holds(const json& interval, double x) {
    EXPECT_LE(interval[0], x);
    EXPECT_GE(interval[1], x);
  }

  TemporaryFolder folder_;
};

TEST_F(measure_command, of_a_box_is_that_of_a_box) {
  const std::string part = write("box.obj", box);
  for (const std::vector<std::string>& how :
       {std::vector<std::string>{part, "--scheme", "bilinear"}, {part, "--sharp", "auto"}}) {
    const json found = answer(how);
    EXPECT_EQ(found["command"], "measure");
    EXPECT_EQ(found["relative"], 1e-4);
    EXPECT_EQ(found["outcome"], "complete");
    EXPECT_EQ(found["closed"], true);
    expect_holds(found["area"], 52);
    expect_holds(found["volume"], 24);
    ASSERT_EQ(found["centroid"].size(), 3);
    expect_holds(found["centroid"][0], 1);
    expect_holds(found["centroid"][1], 1.5);
    expect_holds(found["centroid"][2], 2);
    ASSERT_EQ(found["inertia"].size(), 6);
    expect_holds(found["inertia"][0], 50);
    expect_holds(found["inertia"][1], 40);
    expect_holds(found["inertia"][2], 26);
    expect_holds(found["inertia"][4], 0);
    EXPECT_TRUE(found["stats"]["splits"].is_number_unsigned());
  }
}

TEST_F(measure_command, precision_is_a_share_or_percent) {
  const std::string part = write("box.obj", box);
  const json rough = answer({part, "--relative", "1%"}), fine = answer({part, "--relative", "1e-6"});
  EXPECT_EQ(rough["relative"], 0.01);
  EXPECT_EQ(fine["relative"], 1e-6);
  const auto width = [](const json& x) { return x[1].get<double>() - x[0].get<double>(); };
  EXPECT_LE(width(fine["volume"]), 1e-6 * fine["volume"][1].get<double>());
  EXPECT_LE(rough["volume"][0], fine["volume"][1]);
  EXPECT_GE(rough["volume"][1], fine["volume"][0]);
  for (const char* bad : {"-1", "nan", "x", ""}) {
    EXPECT_EQ(run_snug({"measure", part, "--relative", bad}).status, 2) << bad;
  }
}

TEST_F(measure_command, ends_with_five_where_the_budget_does) {
  const std::string part = write("box.obj", box);
  const json found = answer({part, "--scheme", "catmark", "--max-splits", "10"}, 5);
  EXPECT_EQ(found["outcome"], "budget-spent");
  EXPECT_LT(found["area"][0], found["area"][1]);
}

TEST_F(measure_command, of_an_open_surface_is_its_area) {
  const std::string open = write("open.obj", "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1 2 3 4\n");
  const json found = answer({open, "--scheme", "bilinear"});
  expect_holds(found["area"], 1);
  EXPECT_EQ(found["closed"], false);
  for (const char* field : {"volume", "centroid", "inertia"}) EXPECT_TRUE(found[field].is_null()) << field;
  const Outcome text = run_snug({"measure", open, "--scheme", "bilinear"});
  EXPECT_EQ(text.status, 0);
  EXPECT_NE(text.out.find("volume    none: edge (0, 1) of face 0"), std::string::npos) << text.out;
}

TEST_F(measure_command, text_has_a_line_for_each_number) {
  const Outcome text = run_snug({"measure", write("box.obj", box), "--scheme", "bilinear"});
  EXPECT_EQ(text.status, 0);
  for (const char* word : {"area", "volume", "centroid  x", "centroid  z", "inertia   xx", "inertia   zx"}) {
    EXPECT_NE(text.out.find(word), std::string::npos) << word;
  }
}

TEST_F(measure_command, refuses_what_is_no_surface) {
  EXPECT_EQ(run_snug({"measure", write("curve.obj", "v 0 0 0\nv 1 0 0\nv 1 1 0\nl 1 2 3\n")}).status, 4);
  const Outcome none =
      run_snug({"measure", write("one.obj", "v 0 0 0\nv 1 0 0\nv 1 1 0\nf 1 2 3\n"), "--boundary", "none"});
  EXPECT_EQ(none.status, 4);
  EXPECT_NE(none.err.find("one.obj"), std::string::npos) << none.err;
  EXPECT_EQ(run_snug({"measure", write("nan.obj", "v nan 0 0\nv 1 0 0\nv 1 1 0\nf 1 2 3\n")}).status, 3);
  EXPECT_EQ(run_snug({"measure", "nowhere.obj"}).status, 3);
}

}  // namespace
}  // namespace snug::testing::measure_test
