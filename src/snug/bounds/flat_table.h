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
template <class T>
struct TableColumn {
  T u, v;
  std::array<T, 3> linear, middle, half;
};

/// A table as kernels read it that compute with numbers T.
template <class T>
struct FlatTable {
  std::span<const TableColumn<T>> columns;
  std::size_t first;  ///< bounded: 0 or 3
  std::array<std::array<T, 2>, 3> triangle;
  /// Times the largest |c - origin| of a coordinate, and times the largest difference from the linear function.
  double error_of_largest, error_of_offset;
  double error_at_least;
  double gain;  ///< what an error of all control points is multiplied by, at most
};

/// Writes the columns to `memory`.
/// Guarantee: each half width covers the rounding of both; the errors bound that of centre and half width
///            together: control points relative to the origin, the linear function, the sums.
/// Requires:  the table of this kind; both, and `memory`, outlive the result.
/// Source:    derivations/rounding.md, "Batches".
[[nodiscard]] FlatTable<double> flatten(const BoundTable& table, const Kind& kind,
                                        std::vector<TableColumn<double>>& memory);
template <class T>
[[nodiscard]] FlatTable<T> flatten(const TipTable& table, const Kind& kind,
                                   std::vector<TableColumn<T>>& memory);

}  // namespace snug::kernels
