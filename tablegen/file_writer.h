#pragma once

#include <cstddef>
#include <string_view>
#include <vector>

#include <snug/bounds/bound_rows.h>
#include <snug/bounds/bound_table.h>

namespace tablegen {

/// What the file holds of one kind.
struct KindBounds {
  snug::KindKey key;
  snug::BoundRows rows;
  snug::BoundTable table;
};

/// The bytes of a file as snug/bounds/shipped.h describes it.
[[nodiscard]] std::vector<std::byte> file_of(const std::vector<KindBounds>& kinds, std::string_view text);

}  // namespace tablegen
