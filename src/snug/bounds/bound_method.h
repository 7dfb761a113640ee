#pragma once

#include <cstdint>

namespace snug {

/// What bounds a patch.
enum class BoundMethod : std::uint8_t {
  rows,   ///< hull rows: bound_rows.h
  table,  ///< the dissertation's tables: bound_table.h
};

}  // namespace snug
