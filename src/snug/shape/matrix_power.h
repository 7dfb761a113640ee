#pragma once

#include <cstddef>
#include <vector>

#include <snug/scheme/stencils.h>

namespace snug {

/// Upper bound of the factor by which extents may grow under a square matrix whose rows have the same sum: half the largest distance
/// of two rows in sum.
[[nodiscard]] double growth_of_rows(const std::vector<double>& matrix, std::size_t size);

/// The inverse of a matrix of rows, about; empty if there is none.
[[nodiscard]] std::vector<std::vector<double>> about_inverse(std::vector<std::vector<double>> m);

/// Powers of a square matrix, row by row.
struct MatrixPower {
  std::size_t size;
  std::vector<double> matrix;
  double sum, error;  ///< the largest absolute sum of a row; the largest sum of a row's errors

  MatrixPower(const Stencils& rows, std::size_t columns);
  /// Takes one row off all rows, here and, up to some row, in all powers: no extent sees that. Off the limit's row, so that powers
  /// shrink as what is left does.
  void remove(const Stencils::Row& row);
  void square();
};

}  // namespace snug
