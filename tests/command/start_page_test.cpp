// docs/start.md quotes what the command prints.

#include <gtest/gtest.h>
#include <testing/places.h>

#include <fstream>
#include <iomanip>
#include <sstream>
#include <string>
#include <vector>

#include "run_snug.h"

namespace snug::start_page_test {
namespace {

// The words after "$ snug", some in quotes; models by their paths.
std::vector<std::string> arguments_of(const std::string& line) {
  std::istringstream words(line.substr(std::string("$ snug").size()));
  std::vector<std::string> arguments;
  for (std::string word; words >> std::quoted(word);) {
    arguments.push_back(word.ends_with(".obj") ? testing::model(word) : word);
  }
  return arguments;
}

TEST(start_page, quotes_what_the_command_prints) {
  std::ifstream page(testing::models_dir() + "/../../docs/start.md");
  std::string line, quoted;
  int quotes = 0;
  while (std::getline(page, line)) {
    if (!line.starts_with("$ snug ") || !std::getline(page, quoted)) continue;
    ++quotes;
    const testing::Outcome outcome = testing::run_snug(arguments_of(line));
    EXPECT_EQ(outcome.out.substr(0, outcome.out.find('\n')), quoted) << line;
  }
  EXPECT_EQ(quotes, 2);
}

}  // namespace
}  // namespace snug::start_page_test
