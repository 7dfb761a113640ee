#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include <snug/bounds/bound_table.h>
#include <snug/patch/patch.h>

namespace snug {

/// Boxes whose convex hull contains a patch, relative to its origin.
struct TipBoxes {
  std::array<Vector3, 3> lower, upper;
};

/// A table of bounds (bound_table.h) in the form in which boxes are made of it at once: planes by their
/// middle and half width.
class TipTable {
 public:
  explicit TipTable(const BoundTable& table);

  /// The boxes at the corners of the table's triangle.
  ///
  /// Guarantee: as table_triangle(): the hull of these boxes contains every limit point of the patch,
  ///            rounding and the control points' own error included.
  /// Requires:  a patch of the table's kind.
  /// Cost:      about 25 multiply-adds a control point.
  [[nodiscard]] TipBoxes boxes(const Patch& patch) const;
  [[nodiscard]] std::size_t bytes() const { return sizeof(*this) + columns_.size() * sizeof(Column); }

  /// A bounded function: the place of its control point, and the planes at the corners; the fourth is nothing.
  struct Column {
    double u, v;
    std::array<double, 4> middle, half;
  };
  [[nodiscard]] const std::array<LayoutPoint, 3>& triangle() const { return triangle_; }
  [[nodiscard]] const std::vector<Column>& columns() const { return columns_; }
  [[nodiscard]] std::size_t first_bounded() const { return first_bounded_; }
  /// Error of boxes: factors of the error of control points and of the largest coordinate, and a constant.
  [[nodiscard]] double error_of_points() const { return error_of_points_; }
  [[nodiscard]] double error_of_largest() const { return error_of_largest_; }
  [[nodiscard]] double error_at_least() const { return error_at_least_; }

 private:
  std::array<LayoutPoint, 3> triangle_;
  std::vector<Column> columns_;
  std::size_t first_bounded_;
  double error_of_points_;   // times the error of control points
  double error_of_largest_;  // times the largest coordinate
  double error_at_least_;
};

}  // namespace snug
