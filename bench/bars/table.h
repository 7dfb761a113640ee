#pragma once

#include <string>
#include <vector>

namespace snug::bench {

/// The bars, row by row: in each the values of several pairs of models, or of several meshes.
class BarTable {
 public:
  /// A value of the row `name`, which is made where it is new. `measured`: what the value is, such as
  /// "FCL over snug"; `part`: of which pair.
  void at_least(const std::string& name, const std::string& measured, double bar, const std::string& part,
                double value);
  void at_most(const std::string& name, const std::string& measured, double bar, const std::string& part,
               double value);
  /// A row that cannot be measured here.
  void missing(const std::string& name, const std::string& why);

  /// All rows. One is held if its median reaches the bar and its worst value 0.8 of it.
  void print() const;

 private:
  struct Row {
    std::string name, measured;
    double bar;
    bool at_least;
    std::vector<std::string> parts;
    std::vector<double> values;
    [[nodiscard]] double median() const;
    [[nodiscard]] std::size_t worst() const;
    [[nodiscard]] bool held() const;
  };
  void add(const Row& row);

  std::vector<Row> rows_;
};

}  // namespace snug::bench
