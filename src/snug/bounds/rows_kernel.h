#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include <snug/bounds/bounds_cache.h>
#include <snug/bounds/flat_table.h>

namespace snug::kernels {

/// Input of fit_rows() for a kind: its rows of a few levels, and tables for the tips below these.
class RowsWithTips {
 public:
  /// Has a kind tips with tables: is it cacheable, no polynomial, with self-similar tips?
  [[nodiscard]] static bool fit(const Kind& kind);
  /// Tips begin `levels` down.
  /// Requires:  fit(kind); the library outlives this.
  RowsWithTips(BoundsCache& library, const Kind& kind, unsigned levels);

  struct Tip {
    std::size_t begin, count;  ///< its control net among the rows
    FlatTable table;
    std::vector<TableColumn> columns;
  };
  [[nodiscard]] std::size_t control_count() const { return control_count_; }
  [[nodiscard]] std::size_t count() const { return weights_.size() / control_count_; }
  /// Weights of a row: first three of the limits of the corners, then points whose hull contains the patch
  /// but its tips, then the nets of these.
  [[nodiscard]] const double* row(std::size_t r) const { return weights_.data() + r * control_count_; }
  [[nodiscard]] const std::vector<Tip>& tips() const { return tips_; }
  [[nodiscard]] std::size_t tips_begin() const { return tips_.empty() ? count() : tips_.front().begin; }
  /// Times the largest |coordinate| of a control point, relative to any point: what a point is off by.
  [[nodiscard]] double error_of_largest() const { return error_of_largest_; }

 private:
  std::size_t control_count_;
  std::vector<double> weights_;
  std::vector<Tip> tips_;
  double error_of_largest_;
};

/// Offset triangles of many patches of one kind with extraordinary corners, a patch a lane. A negative radius
/// is no answer: take the general way.
///
/// Guarantee: the patch lies in the offset triangle, whose corners are the limits of the patch's, moved along
///            their normal to the middle of what bounds it; in the kind's order of corners.
///            No answer where farthest() has none, and where tips stick out of the rest by 3 %: more levels may
///            have one.
/// Requires:  control: rows.control_count() vertices of `points` a patch, in the kind's order; out.size()
///            patches; points as in farthest().
/// Cost:      six operations a row and control point, and some 30 a row.
void fit_rows(const RowsWithTips& rows, std::span<const Point3> points, std::span<const VertexId> control,
              std::span<OffsetTriangle> out);

}  // namespace snug::kernels
