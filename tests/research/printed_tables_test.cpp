// docs/tables.md prints what the program counts. Times are not counted.

#include <gtest/gtest.h>

#include <command/run_snug.h>
#include <array>
#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>
#include <regex>
#include <sstream>
#include <string>
#include <vector>

namespace snug::testing::printed_tables_test {
namespace {

using nlohmann::json;

constexpr std::array columns{"rows", "printed", "aabb", "uniform"};

std::string page() {
  std::ifstream in(SNUG_TABLES_PAGE);
  std::ostringstream text;
  text << in.rdbuf();
  return text.str();
}

// The rows below a head, each as its cells.
std::vector<std::vector<std::string>> table_below(const std::string& text, const std::string& head) {
  std::istringstream lines(text.substr(text.find(head)));
  std::vector<std::vector<std::string>> rows;
  std::string line;
  for (std::size_t i = 0; std::getline(lines, line) && line.starts_with("|"); ++i) {
    if (i < 2) continue;
    std::istringstream cells(line.substr(2));
    std::vector<std::string>& row = rows.emplace_back();
    for (std::string cell; cells >> cell;) {
      if (cell != "|") row.push_back(cell);
    }
  }
  return rows;
}

struct Range {
  double least = INFINITY, most = 0;
  void add(double x) {
    least = std::min(least, x);
    most = std::max(most, x);
  }
};

// "0.25 to 0.68", as the page has it after some words.
Range printed_range(const std::string& text, const std::string& words) {
  std::smatch found;
  if (!std::regex_search(text, found, std::regex(words + R"(\s+([0-9.]+)\s+to\s+([0-9.]+))"))) {
    ADD_FAILURE() << "the page has no range after: " << words;
    return {};
  }
  return {std::stod(found[1]), std::stod(found[2])};
}

TEST(tables_page, prints_the_triangles_that_the_program_counts) {
  const Outcome outcome = run_research({"table-5-1", "--json"});
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  const json rows = json::parse(outcome.out)["rows"];
  const std::string text = page();
  const auto printed = table_below(text, "| model | faces | 2 %: rows");
  ASSERT_EQ(rows.size(), 3 * printed.size());
  Range of_printed, of_uniform, of_boxes;
  for (std::size_t m = 0; m < printed.size(); ++m) {
    ASSERT_EQ(printed[m].size(), 2 + 3 * columns.size());
    EXPECT_EQ(printed[m][0], rows[3 * m]["model"]);
    EXPECT_EQ(printed[m][1], rows[3 * m]["faces"].dump());
    for (std::size_t t = 0; t < 3; ++t) {
      const json& row = rows[3 * m + t];
      for (std::size_t c = 0; c < columns.size(); ++c) {
        if (row[columns[c]].is_null()) continue;  // built without OpenSubdiv
        EXPECT_EQ(printed[m][2 + columns.size() * t + c], row[columns[c]].dump())
            << printed[m][0] << " at " << row["tolerance"] << ": " << columns[c];
      }
      if (t < 2) continue;
      const double own = row["rows"], dissertation = row["printed"], boxes = row["aabb"];
      of_printed.add(own / dissertation);
      of_boxes.add(boxes / dissertation);
      if (!row["uniform"].is_null()) of_uniform.add(own / row["uniform"].get<double>());
    }
  }
  const auto expect_range = [&](const std::string& words, const Range& counted, double half_a_digit) {
    const Range range = printed_range(text, words);
    EXPECT_NEAR(range.least, counted.least, half_a_digit) << words;
    EXPECT_NEAR(range.most, counted.most, half_a_digit) << words;
  };
  expect_range("Bounding rows take", of_printed, 0.005);
  if (of_uniform.most > 0) expect_range("triangles at 0.5 %, and", of_uniform, 0.005);
  expect_range("it takes", of_boxes, 5);
}

}  // namespace
}  // namespace snug::testing::printed_tables_test
