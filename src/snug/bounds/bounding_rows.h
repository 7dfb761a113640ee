#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include <snug/bounds/parameter_triangle.h>
#include <snug/patch/kind_cache.h>

namespace snug {

/// Bounding rows of a kind: a matrix M such that, whatever the control points c, the limit patch lies in the
/// convex hull of the points M c.
///
/// Guarantee: the exact rows have that property; every stored row differs from the exact one by at most
///            entry_error() in the sum of its entries' absolute values.
/// Source:    derivations/bounding_rows.md.
class BoundingRows {
 public:
  [[nodiscard]] std::size_t count() const { return count_; }
  [[nodiscard]] std::size_t control_count() const { return control_count_; }
  /// Weights of one control point in all rows; control points in the kind's order.
  [[nodiscard]] const double* column(std::size_t control) const { return weights_.data() + control * count_; }
  [[nodiscard]] double weight(std::size_t row, std::size_t control) const { return column(control)[row]; }
  [[nodiscard]] double entry_error() const { return entry_error_; }
  /// Upper bound of a row's sum of absolute values: 1 but for ghost points.
  [[nodiscard]] double abs_sum() const { return abs_sum_; }
  [[nodiscard]] std::size_t bytes() const { return (weights_.size() + quadratic_.size()) * sizeof(double); }

  /// Number of rows of Bezier points: the first ones.
  [[nodiscard]] std::size_t bezier_count() const { return bezier_count_; }
  /// In all these points the weights of Bezier point k of a quadratic over the patch: its own Bezier points
  /// over the pieces, raised to their degree. Point for point, patch minus quadratic lies in the hull of the
  /// differences. Zeros for a kind of degree 1.
  [[nodiscard]] const double* quadratic(std::size_t k) const { return quadratic_.data() + k * bezier_count_; }

  /// The control net of a piece that is no polynomial, some levels down, in the order of its kind's control
  /// points.
  struct Net {
    const Kind* kind;
    std::size_t begin;        ///< first row
    ParameterTriangle place;  ///< corners of the piece, in its kind's order
  };
  /// The last rows are those of the nets, one after the other.
  [[nodiscard]] const std::vector<Net>& nets() const { return nets_; }
  /// Do the nets belong to tips, one at each extraordinary corner in turn (has_self_similar_tips())?
  [[nodiscard]] bool self_similar() const { return self_similar_; }

  /// Upper bound, a coordinate, of |M c computed - M c exact| for points of at most `largest`, off by at most
  /// `error`.
  [[nodiscard]] double result_error(double largest, double error) const;

 private:
  friend BoundingRows make_bounding_rows(const Kind& kind, unsigned max_levels);
  friend BoundingRows polynomial_rows(std::size_t control_count, std::span<const double> weights,
                                      double entry_error, std::span<const QuadraticWeights> quadratic);
  std::size_t count_ = 0, control_count_ = 0, bezier_count_ = 0;
  std::vector<double> weights_, quadratic_;
  std::vector<Net> nets_;
  bool self_similar_ = false;
  double entry_error_ = 0, abs_sum_ = 0;
};

/// Levels at an extraordinary corner after which rows end at the latest.
inline constexpr unsigned deepest_tip = 24;

/// The rows of a kind: Bezier points of the polynomial pieces after one split; at an extraordinary corner of
/// the rings of pieces around it down to tip_depth() levels, and the control net of the last piece there, the
/// tip. Tips end at `max_levels` if that is less. Where sharpness decays, or polygons are about, control
/// nets of pieces a few levels down end it.
///
/// Requires:  a patch, no polygon.
/// Cost:      up to valence 12 well below a millisecond; for valence n about 20 n^2 multiply-adds a level.
[[nodiscard]] BoundingRows make_bounding_rows(const Kind& kind, unsigned max_levels = deepest_tip);

/// The rows of one level of a kind as two sparse products, which take a third of the operations.
/// Source:    derivations/quadratics.md, "Many patches at once".
struct LevelStep {
  Stencils points;                          ///< new control points, each once, from the control points
  Stencils bezier;                          ///< rows of Bezier points from the new points
  std::vector<QuadraticWeights> quadratic;  ///< as BoundingRows::quadratic(), Bezier point by Bezier point
  /// Those after so many lie on the side that faces the corner of the only net: they are in the hull of a polynomial beyond it.
  std::size_t inner = 0;
  /// The control net of a piece that is no polynomial, among the new points.
  struct Net {
    const Kind* kind;
    std::vector<std::uint32_t> control;
    std::size_t corner,
        own;  ///< which child it is, and the number of its corner at that one's corner in its own kind
  };
  std::vector<Net> nets;
  [[nodiscard]] std::size_t bytes() const;
  /// Has it one net alone, at a corner?
  [[nodiscard]] bool goes_to(std::size_t corner) const {
    return nets.size() == 1 && nets[0].corner == corner && corner < 3;
  }
};
/// Requires:  a kind that is no polynomial, a patch.
[[nodiscard]] LevelStep make_level_step(const Kind& kind);

/// Rows of Bezier points alone, from their weights row by row, entry_error() and what quadratic() has of each.
[[nodiscard]] BoundingRows polynomial_rows(std::size_t control_count, std::span<const double> weights,
                                           double entry_error, std::span<const QuadraticWeights> quadratic);
/// The Bezier points of a polynomial kind of degree 2 or more as it is, without a split.
[[nodiscard]] BoundingRows polynomial_rows(const Kind& kind);

/// Is the quarter at each extraordinary corner, after a few levels, of a kind that comes again at every
/// level? Only such tips can be bounded by tables of their own.
/// Requires:  a kind that is no polynomial.
[[nodiscard]] bool has_self_similar_tips(const Kind& kind);

/// Levels of rings around an extraordinary corner until the control net of the tip sticks out behind the
/// corner by less than 1 % of the width of the patch there.
[[nodiscard]] unsigned tip_depth(const CornerFan& fan, Scheme scheme);

}  // namespace snug
