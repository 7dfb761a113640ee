#pragma once

#include <span>
#include <vector>

#include <snug/mesh/topology.h>
#include <snug/monitor.h>
#include <snug/scheme/stencils.h>

namespace snug {

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
