#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include <snug/geometry/interval.h>
#include <snug/mesh/topology.h>
#include <snug/run.h>
#include <support/point.h>

namespace snug {

/// Rows of a sparse matrix: each new point is a sum of weighted old points. The exact weights of a row sum to
/// 1.
/// Guarantee: a row's error is at least the sum over its entries of |weight stored - exact weight|.
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
  void end_row();
  /// Adds a row that is one of the sources.
  void add_unit_row(std::uint32_t source);
  /// Adds a copy of a row.
  void append(const Row& row);

  [[nodiscard]] std::size_t row_count() const { return offsets_.size() - 1; }
  [[nodiscard]] std::size_t bytes() const {
    return (offsets_.size() + sources_.size()) * sizeof(std::uint32_t) +
           (weights_.size() + errors_.size() + abs_sums_.size()) * sizeof(double);
  }
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

/// One row in the making, each source once. Intervals keep its entries sound.
class RowBuilder {
 public:
  void add(std::uint32_t source, const Interval& weight) {
    for (Entry& entry : entries_) {
      if (entry.source != source) continue;
      entry.weight = entry.weight + weight;
      return;
    }
    entries_.push_back({source, weight});
  }
  /// factor times a row of `rows`.
  void add(const Interval& factor, const Stencils::Row& row) {
    for (std::size_t i = 0; i < row.sources.size(); ++i) {
      // The row's error is one of all its entries together: each may have all of it.
      const double w = row.weights[i], e = row.error;
      add(row.sources[i], factor * (e == 0 ? Interval(w) : Interval(rounded_down(w - e), rounded_up(w + e))));
    }
  }
  /// Multiplies everything by a factor.
  void scale(const Interval& factor) {
    for (Entry& entry : entries_) entry.weight = factor * entry.weight;
  }
  /// Writes the row, and begins anew.
  void end_row(Stencils& out) {
    for (const Entry& entry : entries_) out.add(entry.source, entry.weight);
    out.end_row();
    entries_.clear();
  }

 private:
  struct Entry {
    std::uint32_t source;
    Interval weight;
  };
  std::vector<Entry> entries_;
};

/// factor * weight; of a factor 1 the weight itself: rows of regular parts are free of rounding.
[[nodiscard]] Interval times(const Interval& factor, const Interval& weight);
/// Adds the mean of the vertices of a face, times `share`.
void add_mean(std::span<const VertexId> face, const Interval& share, RowBuilder& row);

/// Adds a row for each face: the mean of its vertices.
void add_face_means(const Topology& topology, const WorkMonitor& monitor, Stencils& out);

/// Adds the product of a row and a matrix to `out`, sources renamed; without names they keep their own.
void add_product(const Stencils::Row& outer, const Stencils& inner, std::span<const VertexId> names,
                 Stencils& out);

}  // namespace snug
