#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include <snug/geometry/interval.h>
#include <snug/geometry/point.h>

namespace snug {

/// Rows of a sparse matrix: each new point is a sum of weighted old points. The exact weights of a row sum
/// to 1.
///
/// Guarantee: row_error(r) is at least the sum over a row's entries of |weight stored - exact weight|.
class Stencils {
 public:
  struct Row {
    std::span<const std::uint32_t> sources;
    std::span<const double> weights;
    double error;    ///< of the entries, in sum
    double abs_sum;  ///< upper bound of the sum of |weight|
  };

  void reserve(std::size_t rows, std::size_t entries);
  /// Adds an entry to the row in the making. The same source may come twice in a row.
  void add(std::uint32_t source, double weight) { add(source, weight, 0); }
  void add(std::uint32_t source, const Interval& weight) { add(source, middle(weight), radius(weight)); }
  void add(std::uint32_t source, double weight, double error);
  /// Ends the row.
  void end_row();
  /// Adds a row that is one of the sources.
  void add_unit_row(std::uint32_t source);
  /// Adds a copy of a row.
  void append(const Row& row);

  [[nodiscard]] std::size_t row_count() const { return offsets_.size() - 1; }
  [[nodiscard]] Row row(std::size_t r) const {
    const std::size_t begin = offsets_[r], count = offsets_[r + 1] - begin;
    return {{sources_.data() + begin, count}, {weights_.data() + begin, count}, errors_[r], abs_sums_[r]};
  }
  /// Largest entry error and absolute sum of a row.
  [[nodiscard]] double max_error() const { return max_error_; }
  [[nodiscard]] double max_abs_sum() const { return max_abs_sum_; }

  /// One row applied to positions (or to displacements).
  template <class P>
  [[nodiscard]] P apply(std::size_t r, std::span<const P> old_points) const {
    P sum;
    for (std::size_t i = offsets_[r]; i < offsets_[r + 1]; ++i) {
      const P& p = old_points[sources_[i]];
      const double w = weights_[i];
      sum = P{sum.x + w * p.x, sum.y + w * p.y, sum.z + w * p.z};
    }
    return sum;
  }

  /// Upper bound, a coordinate, of |computed - exact| for every row, given points of at most `largest` whose
  /// own error is at most `source_error`.
  [[nodiscard]] double result_error(double largest, double source_error) const;

 private:
  std::vector<std::uint32_t> offsets_{0};
  std::vector<std::uint32_t> sources_;
  std::vector<double> weights_;
  std::vector<double> errors_, abs_sums_;
  double open_error_ = 0, open_sum_ = 0;
  std::size_t max_entries_ = 0;
  double max_error_ = 0, max_abs_sum_ = 0;
};

}  // namespace snug
