#pragma once

#include <array>
#include <span>
#include <vector>

#include <snug/bounds/bounds_cache.h>
#include <snug/bounds/fit_kernels.h>
#include <snug/patch/curve_piece.h>
#include <snug/patch/patch.h>

namespace snug {

/// Levels that a patch of a kind that few share is split before the nets of its pieces bound it: one of a transient kind, and
/// one at a high-valence corner.
inline constexpr unsigned transient_split_levels = 5, high_valence_split_levels = 12;

/// Points whose convex hull contains a piece of a surface or a curve, relative to its origin; arrays by axis.
class BoundingPoints {
 public:
  Point3 origin;
  double error = 0;    ///< upper bound, a coordinate, of |point - exact point|
  double largest = 0;  ///< upper bound of every |coordinate|

  /// Control nets of tips, the pieces at extraordinary corners some levels down. The first points are, for
  /// each of them tip_size, the corners of the boxes that the table of its kind gives (tip_table.h).
  [[nodiscard]] std::span<const Patch> tips() const { return {tips_.data(), tip_count_}; }
  static constexpr std::size_t tip_size = 24;
  [[nodiscard]] std::size_t tips_end() const { return tip_size * tip_count_; }

  [[nodiscard]] std::size_t size() const { return count_; }
  [[nodiscard]] kernels::Coordinates coordinates() const { return {x_.data(), y_.data(), z_.data(), count_}; }
  [[nodiscard]] Vector3 at(std::size_t i) const { return {x_[i], y_[i], z_[i]}; }

  /// No points, about another origin. Keeps its memory.
  void restart(const Point3& new_origin);
  /// Leaves the first points. Keeps its memory.
  void cut(std::size_t count) { count_ = count; }
  /// Memory for so many.
  void reserve(std::size_t count);
  /// A copy of the points with no more memory than they need.
  void assign(const BoundingPoints& other);
  /// Adds points of at most `of_largest` that are off by at most `of_error`.
  void add(std::span<const Vector3> points, double of_error, double of_largest);
  /// Adds rows times the points of a patch.
  void add(const BoundingRows& rows, const Patch& patch);
  void add(const Stencils& rows, const Patch& patch);
  /// The net whose points begin at `begin`, as a patch in its kind's order.
  void take_net(const BoundingRows::Net& net, std::size_t begin, Patch& out) const;
  /// Adds all points of others.
  void add(const BoundingPoints& others);
  /// Adds the points of the rows that a library keeps for a patch, to none, with tips for their nets.
  void add_with_tips(BoundsCache& library, const Patch& patch);
  /// Replaces a tip by the points that a level of rows of its kind makes of its net: the hull
  /// shrinks to the pieces around this corner, and a tip a level farther down.
  void refine_tip(BoundsCache& library, std::size_t tip);

 private:
  // Makes room for so many more; where the first of them is.
  std::size_t extend(std::size_t by);
  void set(std::size_t i, const Vector3& p);
  void widen(double of_error, double of_largest);
  // The points that come first of tip i.
  void set_boxes(BoundsCache& library, std::size_t i);

  std::size_t count_ = 0, tip_count_ = 0;
  std::vector<double> x_, y_, z_;  // as large as they ever were
  std::array<Patch, 3> tips_;
};

/// How often offset_triangle() refines tips.
inline constexpr std::size_t max_tip_refinements = 20;

/// The points M c of a patch, written over `out`, which keeps its memory.
///
/// Guarantee: the patch lies in the hull of points that differ from these by at most out.error a coordinate.
/// Requires:  rows of the patch's kind.
/// Cost:      3 rows.count() rows.control_count() multiply-adds; no allocation once `out` has been as large.
void bounding_points(const BoundingRows& rows, const Patch& patch, BoundingPoints& out);

/// The same from the rows and tables that a library keeps, with tips. Takes memory for all refinements to
/// come. Transient and high-valence kinds, which few patches share, have no rows: the patch is split, and its pieces
/// have theirs, see also make_crease_rows().
void bounding_points(BoundsCache& library, const Patch& patch, BoundingPoints& out);
/// Makes the rows and tables that the call above and refinements will need for patches of this kind.
void prepare_bounding_points(BoundsCache& library, const Kind& kind);

/// The same of a curve: the Bezier points of its four quarters.
void bounding_points(const CurvePiece& piece, BoundingPoints& out);

/// The set lower <= dot(normal, p) <= upper.
struct Slab {
  Vector3 normal;
  double lower, upper;
};

/// Slab along `normal`, which need not be of length 1, that contains the patch, rounding included; infinite
/// where a point is not finite. Bounds belong to points relative to points.origin.
[[nodiscard]] Slab outer_slab(const BoundingPoints& points, const Vector3& normal);

}  // namespace snug
