#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include <snug/bounds/bounding_rows.h>
#include <snug/bounds/flat_table.h>

namespace snug {
class BoundsCache;
}

namespace snug::kernels {

/// Rows of a sparse matrix as kernels read them: those of one length together, since the end of a loop that is not foreseen costs as
/// much as a row.
template <class T>
struct SparseRows {
  /// The first `count` rows. Source i becomes names[i], if there are names.
  SparseRows(const Stencils& rows, std::size_t count, std::span<const std::uint32_t> names = {});
  struct Run {
    std::uint32_t rows, length;
  };
  std::vector<Run> runs;
  std::vector<std::uint32_t> places;   ///< of each row among all
  std::vector<std::uint32_t> sources;  ///< row by row
  std::vector<T> weights;
};

/// Where tips are, which are of kinds that come again by then, and how many there are.
inline constexpr unsigned least_row_levels = 3, most_row_levels = 6;
inline constexpr std::size_t most_tips = 3;

/// Has a kind tips with tables: is it cacheable, no polynomial, with self-similar tips, one a corner, beside which middle children
/// are made of polynomials, at the latest after another step?
[[nodiscard]] bool has_rows_with_tips(BoundsCache& library, const Kind& kind);
/// Such a kind: have these tips layouts, and is there a fit for quadratics?
[[nodiscard]] bool has_layouts(BoundsCache& library, const Kind& kind);

/// By what tips are bounded: by boxes of tables, or, where quadratics are compared too, by a layout.
enum class TipsBy { tables, layouts };

/// A quadratic over a patch to the same over a piece, corners and middles of edges in the order of the kinds.
template <class T>
using RestrictionOf = std::array<std::array<T, 6>, 6>;

/// Compares a tip with a quadratic, as QuadraticRows::distance() does.
template <class T>
struct TipLayout {
  struct Place {
    T u, v, largest;  ///< of its function, or a little more
  };
  std::vector<Place> places;                ///< of control points
  std::vector<std::array<T, 2>> offsets;    ///< corners of the polygon
  std::array<std::vector<T>, 3> to_corner;  ///< weights of control points in the limits of the corners
  double reach = 0;                         ///< sum of largest (1 + |u| + |v|)
  double offset_error = 0;
};

/// Input of fit_rows() and fit_pieces_by_rows() for a kind: its steps, level by level, and what bounds the tips below these; in
/// numbers T.
template <class T>
class RowsWithTips {
 public:
  /// Requires:  has_rows_with_tips(library, kind), for layouts has_layouts(); kind and library outlive this.
  RowsWithTips(BoundsCache& library, const Kind& kind, TipsBy by);

  /// New points of a step, from those of the step before, and Bezier points from these.
  struct Step {
    SparseRows<T> points, bezier;
    std::vector<std::array<T, 6>> quadratic;  ///< as LevelStep's
  };
  /// A step; the net of its tip, if there is only one; and the step of a middle child that is no polynomial, as of a half beside an
  /// extraordinary corner of its quad.
  struct Level {
    const Step* step = nullptr;
    std::vector<std::uint32_t> tip_control;
    RestrictionOf<T> to_tip{};
    const Step* middle = nullptr;
    RestrictionOf<T> to_middle{};
  };
  /// A piece that is no polynomial: its net, the levels from there on, and a table or a layout of their last kind.
  struct Tip {
    std::vector<std::uint32_t> control;
    RestrictionOf<T> from_patch{};
    std::array<Level, most_row_levels> levels;  // the first is the patch's
    FlatTable<T> table;
    std::vector<TableColumn<T>> columns;
    TipLayout<T> layout;
  };
  [[nodiscard]] const Kind& kind() const { return *kind_; }
  /// Of the patch itself.
  [[nodiscard]] const Level& first() const { return first_; }
  [[nodiscard]] const std::vector<Tip>& tips() const { return tips_; }
  /// At most, of a step.
  [[nodiscard]] std::size_t most_points() const { return most_points_; }
  /// After so many levels.
  [[nodiscard]] std::size_t bezier_count(unsigned levels) const;

  /// A coordinate of a point is off by at most these times an error of all control points, and times the largest such
  /// coordinate of one.
  [[nodiscard]] double error_of_points() const { return error_of_points_; }
  [[nodiscard]] double error_of_largest() const { return error_of_largest_; }
  /// No coordinate of a point is larger than this times the largest of a control point.
  [[nodiscard]] double growth() const { return growth_; }
  /// Weights of one control point in the six points of the quadratic, if tips have layouts.
  [[nodiscard]] const T* fit() const { return fit_.data(); }
  [[nodiscard]] std::size_t bytes() const;

 private:
  struct Growth;
  struct Maker;

  const Kind* kind_;
  std::vector<std::unique_ptr<const Step>> steps_;
  Level first_;
  std::vector<Tip> tips_;
  std::size_t most_points_ = 0;
  double error_of_points_ = 1, error_of_largest_ = 0, growth_ = 1;
  std::vector<T> fit_;
};

/// The radius of no answer where single precision would make it larger by some hundredth.
inline constexpr double needs_digits = -2;

/// Offset triangles of many patches of one kind with extraordinary corners, a patch a lane, in numbers T: float or double.
///
/// Guarantee: the patch lies in the offset triangle, whose corners are the limits of the patch's, moved along
///            their normal to the middle of what bounds it; in the kind's order of corners. The corners are found in double
///            precision whatever T is.
///            No answer, a negative radius, where farthest() has none, and where tips stick out of the rest by 15 %: more levels may
///            have one. `needs_digits` where single precision would make a radius larger by some hundredth.
/// Requires:  levels from least_row_levels to most_row_levels; control: rows.kind().control_count() vertices of `points` a
///            patch, in the kind's order; out.size() patches; points as in farthest().
/// Cost:      some 90 operations a Bezier point, of which a level of a tip has about 36.
/// Source:    derivations/rounding.md, "Batches".
template <class T>
void fit_rows(const RowsWithTips<T>& rows, unsigned levels, std::span<const Point3> points,
              std::span<const VertexId> control, std::span<OffsetTriangle> out);

}  // namespace snug::kernels
