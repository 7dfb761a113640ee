#include "table.h"

#include <algorithm>
#include <cstdio>

namespace snug::bench {

double BarTable::Row::median() const {
  std::vector<double> sorted = values;
  std::sort(sorted.begin(), sorted.end());
  return (sorted[(sorted.size() - 1) / 2] + sorted[sorted.size() / 2]) / 2;
}

std::size_t BarTable::Row::worst() const {
  const auto place = at_least ? std::min_element(values.begin(), values.end())
                              : std::max_element(values.begin(), values.end());
  return static_cast<std::size_t>(place - values.begin());
}

bool BarTable::Row::held() const {
  const double min_of_all = 0.8;
  return at_least ? median() >= bar && values[worst()] >= min_of_all * bar
                  : median() <= bar && min_of_all * values[worst()] <= bar;
}

void BarTable::add(const Row& row) {
  const auto same = [&](const Row& other) {
    return other.name == row.name && other.measured == row.measured && !other.values.empty();
  };
  const auto found = std::find_if(rows_.begin(), rows_.end(), same);
  if (found == rows_.end()) {
    rows_.push_back(row);
    return;
  }
  found->parts.push_back(row.parts.front());
  found->values.push_back(row.values.front());
}

void BarTable::at_least(const std::string& name, const std::string& measured, double bar,
                        const std::string& part, double value) {
  add({name, measured, bar, true, {part}, {value}});
}

void BarTable::at_most(const std::string& name, const std::string& measured, double bar,
                       const std::string& part, double value) {
  add({name, measured, bar, false, {part}, {value}});
}

void BarTable::missing(const std::string& name, const std::string& why) {
  rows_.push_back({name, why, 0, true, {}, {}});
}

void BarTable::print() const {
  std::printf("\n%-40s  %-48s  %12s  %8s  %8s  %s\n", "bar", "measured", "to reach", "median", "worst", "");
  for (const Row& row : rows_) {
    std::printf("%-40s  %-48s  ", row.name.c_str(), row.measured.c_str());
    if (row.values.empty()) {
      std::printf("not measured\n");
      continue;
    }
    std::printf("%8s %3.3g  %8.3g  %8.3g  %s (of %zu, worst: %s)\n", row.at_least ? "at least" : "at most",
                row.bar, row.median(), row.values[row.worst()], row.held() ? "held" : "missed",
                row.values.size(), row.parts[row.worst()].c_str());
  }
  std::fflush(stdout);
}

}  // namespace snug::bench
