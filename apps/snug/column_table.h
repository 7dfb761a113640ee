#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace snug {

/// Rows of numbers in named columns, to be written as a file that other programs map into memory.
class ColumnTable {
 public:
  enum class Type : std::uint8_t { real, integer, flag };  ///< double; 32 bits without sign; 8 bits, 0 or 1
  struct Column {
    std::string name;
    Type type;
  };

  /// The ending of `path` chooses the format: one of is_table().
  ColumnTable(std::vector<Column> columns, const std::string& path);

  /// The next number of a row, in the order of the columns; reals may be NaN.
  void add(double value);
  [[nodiscard]] std::size_t rows() const { return rows_; }

  /// The whole file: `.npy`, a structured array of NumPy, version 1.0; `.ply`, binary and little endian, each
  /// row a vertex; `.csv`, the names and then a line a row, numbers as the shortest decimals that read back.
  [[nodiscard]] std::string file() const;

  /// Does a name, in upper or lower case, end like one of these formats?
  [[nodiscard]] static bool is_table(const std::string& path);

 private:
  std::vector<Column> columns_;
  std::string ending_;
  std::string values_;  // of all rows, without what stands before them
  std::size_t rows_ = 0, next_ = 0;
};

}  // namespace snug
