#pragma once

#include <array>
#include <cstddef>
#include <limits>
#include <span>
#include <vector>

#include <snug/bounds/bound_table.h>
#include <snug/bounds/tip_table.h>

namespace snug {

/// As unit_roundoff, underflow_error and gamma_bound(), of another type of numbers.
template <class T>
inline constexpr double roundoff_of = static_cast<double>(std::numeric_limits<T>::epsilon()) / 2;
template <class T>
inline constexpr double underflow_of = static_cast<double>(std::numeric_limits<T>::min());
/// Infinite beyond thousands of roundings in single precision.
template <class T>
[[nodiscard]] constexpr double gamma_of(std::size_t k) {
  const double sum = static_cast<double>(k) * roundoff_of<T>;
  return sum <= 0x1p-13 ? sum * (1 + 0x1p-12) : std::numeric_limits<double>::infinity();
}

}  // namespace snug

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
template <class T>
[[nodiscard]] FlatTable<T> flatten(const BoundTable& table, const Kind& kind,
                                   std::vector<TableColumn<T>>& memory);
template <class T>
[[nodiscard]] FlatTable<T> flatten(const TipTable& table, const Kind& kind,
                                   std::vector<TableColumn<T>>& memory);

}  // namespace snug::kernels
