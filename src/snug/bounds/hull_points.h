#pragma once

#include <array>
#include <span>
#include <vector>

#include <snug/bounds/bounds_cache.h>
#include <snug/bounds/fit_kernels.h>
#include <snug/patch/curve_piece.h>
#include <snug/patch/patch.h>

namespace snug {

/// Points whose convex hull contains a piece of a surface or a curve, relative to its origin; arrays by axis.
class HullPoints {
 public:
  Point3 origin;
  double error = 0;    ///< upper bound, a coordinate, of |point - exact point|
  double largest = 0;  ///< upper bound of every |coordinate|
  /// The last points, if they are the control nets of tips (see BoundRows).
  std::array<BoundRows::Tip, 3> tips;

  [[nodiscard]] std::size_t size() const { return count_; }
  [[nodiscard]] std::size_t tips_begin() const { return tips[0].kind ? tips[0].begin : count_; }
  [[nodiscard]] kernels::Coordinates coordinates() const { return {x_.data(), y_.data(), z_.data(), count_}; }
  [[nodiscard]] Vector3 at(std::size_t i) const { return {x_[i], y_[i], z_[i]}; }

  /// No points, about another origin. Keeps its memory.
  void restart(const Point3& new_origin);
  /// Leaves the first points. Keeps its memory.
  void cut(std::size_t count) { count_ = count; }
  /// Memory for so many.
  void reserve(std::size_t count);
  /// A copy with no more memory than it needs.
  void assign(const HullPoints& other);
  /// Adds points of at most `of_largest` that are off by at most `of_error`.
  void add(std::span<const Vector3> points, double of_error, double of_largest);
  /// Adds rows times the points of a patch.
  void add(const BoundRows& rows, const Patch& patch);
  void add(const Stencils& rows, const Patch& patch);

 private:
  // Makes room for so many more; where the first of them is.
  std::size_t extend(std::size_t by);
  void set(std::size_t i, const Vector3& p);
  void widen(double of_error, double of_largest);

  std::size_t count_ = 0;
  std::vector<double> x_, y_, z_;  // as large as they ever were
};

/// How often offset_triangle() refines tips.
inline constexpr std::size_t max_tip_refinements = 3;

/// The points M c of a patch, written over `out`, which keeps its memory.
///
/// Guarantee: the patch lies in the hull of points that differ from these by at most out.error a coordinate.
/// Requires:  rows of the patch's kind.
/// Cost:      3 rows.count() rows.control_count() multiply-adds; no allocation once `out` has been as large.
void hull_points(const BoundRows& rows, const Patch& patch, HullPoints& out);

/// The same from the rows that a library keeps; the tips of a kind with several are refined, its own rows
/// being for one level only. Takes memory for all refinements to come. Passing and crowded kinds, which few
/// patches share, have no rows: the patch is split, and its pieces have theirs.
void hull_points(BoundsCache& library, const Patch& patch, HullPoints& out);
/// Makes the rows that the call above will need for patches of this kind.
void prepare_hull_points(BoundsCache& library, const Kind& kind);

/// The same of a curve: the Bezier points of its four quarters.
void hull_points(const CurvePiece& piece, HullPoints& out);

/// Few points whose hull holds the patch closely: the Bezier points of a polynomial one, else those above.
void close_points(BoundsCache& library, const Patch& patch, HullPoints& out);

/// Replaces the control nets of some tips by the points that the rows of their own kinds make of them: the
/// hull shrinks to the pieces around these corners, and nets some levels farther down.
void refine_tips(BoundsCache& library, const std::array<bool, 3>& which, HullPoints& points);

/// The set lower <= dot(normal, p) <= upper.
struct Slab {
  Vector3 normal;
  double lower, upper;
};

/// Slab along `normal`, which need not be of length 1, that contains the patch, rounding included; infinite
/// where a point is not finite. Bounds belong to points relative to points.origin.
[[nodiscard]] Slab outer_slab(const HullPoints& points, const Vector3& normal);

}  // namespace snug
