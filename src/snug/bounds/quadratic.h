#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <vector>

#include <snug/bounds/bounding_rows.h>
#include <snug/bounds/fit_kernels.h>
#include <snug/bounds/layout.h>
#include <snug/patch/patch.h>

namespace snug {

class BoundsCache;
class BoundingPoints;

/// A quadratic Bezier triangle near a patch, parameter by parameter.
struct QuadraticTriangle {
  std::array<Point3, 3> corners;  ///< near the patch's limit corners, in the patch's order
  std::array<Point3, 3> middles;  ///< Bezier points of the edges from corner 0 to 1, 1 to 2, 2 to 0
  double error;                   ///< |patch(t) - quadratic(t)| <= error for all t; infinite if not finite
  Vector3 normal{};  ///< of about length 1 across the corners, or zero; the patch usually errs less along it:
  double normal_error = 0;  ///< |dot(normal, patch(t) - quadratic(t))| <= normal_error for all t
};

/// The errors that matter to a caller: one of at most `sufficient` need not be less, and one above `useless` may as well be infinite.
struct ErrorUse {
  double sufficient = 0, useless = INFINITY;
};

/// Are a kind's pieces compared with quadratics by rows? Others are split.
[[nodiscard]] inline bool has_quadratic_rows(const Kind& kind) { return !kind.high_valence(); }

/// Rows that make and bound the quadratic triangles of a kind. Immutable.
///
/// Guarantee: whatever the fit is, errors are proved for the quadratics that came out.
/// Source:    derivations/quadratics.md.
class QuadraticRows {
 public:
  /// Of a quadratic to a piece, in the order of the piece's kind.
  using Restriction = std::array<QuadraticWeights, 6>;
  /// To the pieces whose nets end the rows that a library keeps of this kind, and the level of them.
  [[nodiscard]] const std::vector<Restriction>& to_nets() const { return to_nets_; }
  [[nodiscard]] const std::vector<Restriction>& to_level_nets() const { return to_level_nets_; }
  /// Weights of one control point in the six points of the quadratic.
  [[nodiscard]] const double* fit() const { return fit_.data(); }
  /// Inputs of distance(): places of control points, none where it is infinite; corners of a polygon that
  /// holds, up to an error a coordinate, where limit points of the places are less their parameters; upper
  /// bounds of basis functions' sizes.
  [[nodiscard]] const std::vector<LayoutPoint>& layout() const { return layout_; }
  [[nodiscard]] const std::vector<LayoutPoint>& offsets() const { return offsets_; }
  [[nodiscard]] double offset_error() const { return offset_error_; }
  [[nodiscard]] const std::vector<double>& largest() const { return largest_; }
  [[nodiscard]] std::size_t bytes() const;

  /// How far a patch and a quadratic in the kind's order are apart, and along `normal`; infinite unless the kind has a
  /// layout: it comes again at a corner, or its lattice stays a lattice.
  [[nodiscard]] Apart distance(const Kind& kind, const Patch& patch, const std::array<Vector3, 6>& quadratic,
                               const Vector3& normal) const;

 private:
  friend QuadraticRows make_quadratic_rows(BoundsCache& library, const Kind& kind);
  void make_fit(const BoundingRows& deep);
  void make_frame(const Kind& kind, const BoundingRows& deep);
  void make_lattice(BoundsCache& library, const Kind& kind);
  [[nodiscard]] Apart distance_on_lattice(const Patch& patch, const std::array<Vector3, 6>& q,
                                          const Vector3& normal) const;

  std::vector<Restriction> to_nets_, to_level_nets_;
  std::vector<double> fit_;  // 6 x controls, column by column
  // Of a kind that comes again at a corner: places of control points, such that the corners' limits are at
  // (0, 0), (1, 0), (0, 1); corners of a polygon that holds, up to an error a coordinate, where its limit
  // points are less their parameters; largest |basis function|. Of one that stays a lattice: its places, no polygon.
  std::vector<LayoutPoint> layout_, offsets_;
  double offset_error_ = 0;
  std::vector<double> largest_;
  bool lattice_ = false;  // limit points of the places are the parameters themselves, up to the error
};

/// Quadratics over the four children of a patch (split()), in the patch's order of corners.
struct QuarterRows {
  /// From a quadratic over the patch to the same over a child.
  std::array<QuadraticRows::Restriction, 4> to_child;
  /// Back from any four: the sum of their images is the quadratic over the patch that is nearest to them, Bezier point for
  /// Bezier point.
  std::array<QuadraticRows::Restriction, 4> from_child;
};
[[nodiscard]] const QuarterRows& quarter_rows();

/// The fit of a kind that comes again, or of one whose children are polynomials, come again, or are made of such: the quadratic
/// nearest to theirs, which are of kinds that many patches have, so that it costs little. Empty for others.
[[nodiscard]] std::vector<double> quadratic_fit(BoundsCache& library, const Kind& kind);

/// Of a transient kind the lattice alone, and no fit.
/// Requires:  a patch, no polygon, with has_quadratic_rows().
/// Cost:      0.1 to 1 ms up to valence 12.
[[nodiscard]] QuadraticRows make_quadratic_rows(BoundsCache& library, const Kind& kind);

/// The quadratic triangle of a patch, least squares over Bezier points, with its error.
///
/// Guarantee: both errors, rounding and the patch's own error included. Both are infinite where the error shows to be above
///            use.useless.
/// Requires:  hull: of bounding_points() for this patch, no tip of it refined, or by the rows that the library keeps of
///            its kind, without boxes of tips; none is needed unless kind->cacheable().
/// Tightness: in the median 1.3 times the largest distance over all parameters.
/// Cost:      given the hull about 0.1 microseconds; with extraordinary corners 0.3 each, and one product a
///            level that is refined.
[[nodiscard]] QuadraticTriangle quadratic_triangle(BoundsCache& library, const Patch& patch,
                                                   const BoundingPoints& hull, const ErrorUse& use = {});
/// The same without a hull at hand.
[[nodiscard]] QuadraticTriangle quadratic_triangle(BoundsCache& library, const Patch& patch,
                                                   const ErrorUse& use = {});

/// Upper bound of |patch(t) - l(t)| over all t, for the linear map l of the patch's parameters to this triangle,
/// corner to corner; infinite if not finite. Rounding and the patch's own error included.
/// Requires, Cost: those of quadratic_triangle(); no hull is needed unless kind->cacheable().
[[nodiscard]] double distance_to_triangle(BoundsCache& library, const Patch& patch,
                                          const BoundingPoints& hull, const Triangle& triangle,
                                          const ErrorUse& use = {});

}  // namespace snug
