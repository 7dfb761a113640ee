#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include <snug/bounds/bounds_cache.h>
#include <snug/bounds/flat_table.h>

namespace snug::kernels {

/// Input of fit_rows() for a kind: its steps, level by level, and tables for the tips below these.
class RowsWithTips {
 public:
  /// Where tips are, which are of kinds that come again by then.
  static constexpr unsigned least_levels = 3, most_levels = 6;
  static constexpr std::size_t most_tips = 3;

  /// Has a kind tips with tables: is it cacheable, no polynomial, with self-similar tips, one a corner, beside which middle children
  /// are made of polynomials, at the latest after another step?
  [[nodiscard]] static bool fit(BoundsCache& library, const Kind& kind);
  /// Requires:  fit(kind); kind and library outlive this.
  RowsWithTips(BoundsCache& library, const Kind& kind);

  /// A step, and what it leaves: control points of the tip, if there is only one, and those of a middle child that is no polynomial,
  /// as of a half beside an extraordinary corner of its quad, with the step that it takes.
  struct Level {
    const LevelStep* step;
    std::span<const std::uint32_t> tip_control;
    const LevelStep* middle;
    std::span<const std::uint32_t> middle_control;
  };
  /// A piece that is no polynomial: its net, the levels from there on, and the table of their last kind.
  struct Tip {
    std::span<const std::uint32_t> control;
    std::array<Level, most_levels> levels;  // the first is the patch's
    FlatTable table;
    std::vector<TableColumn> columns;
  };
  [[nodiscard]] const Kind& kind() const { return *kind_; }
  /// Of the patch itself.
  [[nodiscard]] const Level& first() const { return first_; }
  [[nodiscard]] const std::vector<Tip>& tips() const { return tips_; }
  /// At most, of a step.
  [[nodiscard]] std::size_t most_points() const { return most_points_; }
  /// After so many levels.
  [[nodiscard]] std::size_t bezier_count(unsigned levels) const;
  /// Times the largest |coordinate| of a control point, relative to any point: what a point is off by.
  [[nodiscard]] double error_of_largest() const { return error_of_largest_; }

 private:
  const Kind* kind_;
  std::vector<std::unique_ptr<const LevelStep>> steps_;  // of the patch, then of tips
  Level first_{};
  std::vector<Tip> tips_;
  std::size_t most_points_ = 0;
  double error_of_largest_ = 0;
};

/// Offset triangles of many patches of one kind with extraordinary corners, a patch a lane. A negative radius
/// is no answer: take the general way.
///
/// Guarantee: the patch lies in the offset triangle, whose corners are the limits of the patch's, moved along
///            their normal to the middle of what bounds it; in the kind's order of corners.
///            No answer where farthest() has none, and where tips stick out of the rest by 15 %: more levels may
///            have one.
/// Requires:  levels from least_levels to most_levels; control: rows.kind().control_count() vertices of `points` a
///            patch, in the kind's order; out.size() patches; points as in farthest().
/// Cost:      some 90 operations a Bezier point, of which a level of a tip has about 36.
void fit_rows(const RowsWithTips& rows, unsigned levels, std::span<const Point3> points,
              std::span<const VertexId> control, std::span<OffsetTriangle> out);

}  // namespace snug::kernels
