#pragma once

#include <cstddef>
#include <string_view>
#include <vector>

#include <snug/bounds/bound_rows.h>
#include <snug/bounds/bound_table.h>

namespace tablegen {

struct NamedTable {
  snug::TableLayout layout;  ///< all the same where the kind is not laid by rings
  snug::BoundTable table;
};

/// What the file holds of one kind.
struct KindBounds {
  snug::KindKey key;
  snug::BoundRows rows;
  std::vector<NamedTable> tables;
};

/// The bytes of a file as snug/basis/shipped.h describes it.
[[nodiscard]] std::vector<std::byte> file_of(const std::vector<KindBounds>& kinds, std::string_view text);

}  // namespace tablegen
