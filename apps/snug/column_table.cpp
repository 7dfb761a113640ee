#include "column_table.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <string_view>

#include <support/binary.h>
#include <support/contract.h>
#include <support/system_files.h>

namespace snug {
namespace {

void append_csv(std::string& text, double value) {
  if (std::isnan(value)) {
    text += "nan";
  } else if (std::isinf(value)) {
    text += value > 0 ? "inf" : "-inf";
  } else {
    append_real(text, value);
  }
}

using Columns = std::vector<ColumnTable::Column>;

std::string npy_head(const Columns& columns, std::size_t rows) {
  constexpr std::array types{"<f8", "<u4", "|u1"};
  std::string text = "{'descr': [";
  for (const auto& [name, type] : columns) {
    text += "('" + name + "', '" + types[static_cast<std::size_t>(type)] + "'), ";
  }
  text += "], 'fortran_order': False, 'shape': (" + std::to_string(rows) + ",), }";
  constexpr std::size_t front = 10, unit = 64;  // the numbers begin at a multiple of it
  text.resize((front + text.size() + 1 + unit - 1) / unit * unit - front - 1, ' ');
  text += '\n';
  std::string head = "\x93NUMPY";
  head.append("\1\0", 2);
  append_binary(head, static_cast<std::uint16_t>(text.size()));
  return head + text;
}

std::string ply_head(const Columns& columns, std::size_t rows) {
  constexpr std::array types{"double", "uint", "uchar"};
  std::string text = "ply\nformat binary_little_endian 1.0\nelement vertex " + std::to_string(rows) + '\n';
  for (const auto& [name, type] : columns) {
    text += std::string("property ") + types[static_cast<std::size_t>(type)] + ' ' + name + '\n';
  }
  return text + "end_header\n";
}

std::string csv_head(const Columns& columns) {
  std::string text;
  for (const auto& column : columns) text += (text.empty() ? "" : ",") + column.name;
  return text + '\n';
}

}  // namespace

ColumnTable::ColumnTable(std::vector<Column> columns, const std::string& path)
    : columns_(std::move(columns)), ending_(system_files::ending_of(path)) {
  SNUG_EXPECT(is_table(path) && !columns_.empty());
}

void ColumnTable::add(double value) {
  if (ending_ == ".csv") {
    append_csv(values_, value);
    values_ += next_ + 1 == columns_.size() ? '\n' : ',';
  } else if (columns_[next_].type == Type::real) {
    append_binary(values_, value);
  } else if (columns_[next_].type == Type::integer) {
    append_binary(values_, static_cast<std::uint32_t>(value));
  } else {
    append_binary(values_, static_cast<std::uint8_t>(value));
  }
  next_ = (next_ + 1) % columns_.size();
  if (next_ == 0) ++rows_;
}

std::string ColumnTable::file() const {
  SNUG_EXPECT(next_ == 0);
  const std::string head = ending_ == ".csv"   ? csv_head(columns_)
                           : ending_ == ".ply" ? ply_head(columns_, rows_)
                                               : npy_head(columns_, rows_);
  return head + values_;
}

bool ColumnTable::is_table(const std::string& path) {
  const std::string ending = system_files::ending_of(path);
  return ending == ".npy" || ending == ".ply" || ending == ".csv";
}

}  // namespace snug
