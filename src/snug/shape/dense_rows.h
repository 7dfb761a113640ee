#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include <snug/scheme/stencils.h>

namespace snug {

/// Upper bound of the factor by which the extent of points in any direction grows when they are replaced by some rows of them.
/// Source:    derivations/measures.md, "What is left at a corner".
[[nodiscard]] double growth_of(const Stencils& rows, std::span<const std::uint32_t> which,
                               std::size_t columns);

/// Points after some steps, as rows over those before; with bounds of what these numbers err by.
class DenseRows {
 public:
  /// None yet: each point by itself.
  explicit DenseRows(std::size_t size) : columns_(size) {}

  void step(const Stencils& rows, std::span<const std::uint32_t> which);
  /// Requires:  as many rows as columns, at least one step.
  void square();
  [[nodiscard]] std::size_t columns() const { return columns_; }
  /// Row by row; empty before the first step.
  [[nodiscard]] const std::vector<double>& matrix() const { return matrix_; }
  /// Upper bounds of a row's absolute sum, and of the sum of its entries' errors.
  [[nodiscard]] double sum() const { return sum_; }
  [[nodiscard]] double error() const { return error_; }
  /// As growth_of() all rows.
  [[nodiscard]] double growth() const;

 private:
  void add(double weight, std::size_t row, double* to) const;
  void multiplied(double sum, double error);

  std::size_t columns_;
  std::vector<double> matrix_;
  double sum_ = 1, error_ = 0;
};

}  // namespace snug
