#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <vector>

#include <snug/bounds/bound_table.h>
#include <snug/bounds/tip_table.h>

namespace snug::kernels {

/// A bounded control point of a table: its place, its weights in the linear function, and the planes around
/// its function at the table's corners as middle and half width.
struct TableColumn {
  double u, v;
  std::array<double, 3> linear, middle, half;
};

/// A table as kernels read it.
struct FlatTable {
  std::span<const TableColumn> columns;
  std::size_t first;  ///< bounded: 0 or 3
  std::array<LayoutPoint, 3> triangle;
  double error_of_largest;  ///< times the largest |c - origin| of a patch
  double error_at_least;
  double gain;  ///< what an error of all control points is multiplied by, at most
};

/// Writes the columns to `memory`.
/// Guarantee: each half width covers the rounding of both; the errors bound that of centre and half width
///            together: control points relative to the origin, the linear function, the sums.
/// Requires:  the table of this kind; both, and `memory`, outlive the result.
/// Source:    derivations/rounding.md, "Batches".
[[nodiscard]] FlatTable flatten(const BoundTable& table, const Kind& kind, std::vector<TableColumn>& memory);
[[nodiscard]] FlatTable flatten(const TipTable& table, const Kind& kind, std::vector<TableColumn>& memory);

}  // namespace snug::kernels
