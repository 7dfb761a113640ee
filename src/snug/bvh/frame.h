#pragma once

#include <array>

#include <snug/geometry/motion.h>
#include <support/point.h>
#include <support/scaling.h>

namespace snug {

/// x -> scale (R x) + t with scale a power of two: how a surface is placed in the frame of a query.
struct PlacedFrame {
  Rows3 rows;  ///< of R
  double scale = 1;
  Vector3 translation;
  double defect = 0;  ///< upper bound of the largest entry of |R'R - I|
  /// Upper bound of how far the image that is meant of a point may be from the exact one. Only RelativeFrame
  /// accounts for it.
  double deviation = 0;

  [[nodiscard]] Point3 apply(const Point3& p) const {
    return Point3{} + (scale * times(rows, p - Point3{}) + translation);
  }
  /// Upper bound, a coordinate, of |apply(p) - exact image|.
  [[nodiscard]] double apply_error(const Point3& p) const;
  /// The same for any point with coordinates of at most 4.
  [[nodiscard]] double largest_apply_error() const;
  /// The exact point's image is within the error of the result.
  [[nodiscard]] BoundedPoint apply(const BoundedPoint& p) const;
  /// Upper bound of scale times the spectral norm of R: how much radii grow.
  [[nodiscard]] double growth() const { return scale * (1 + 2 * defect); }
};

/// How points of one placed model are seen from the frame of another one: x -> M x + t, in double precision,
/// and a bound of what is wrong with it.
///
/// Guarantee: for points p of the target and q of the source, both at most 2 in their own frames,
///            |M q + t - p| <= (1 + 4 defects) / target.scale times their placed distance, plus `slack`. The
///            same for the places that are meant, if these are as near as the frames' deviations say.
/// Source:    derivations/boxes.md.
struct RelativeFrame {
  Rows3 rows;  ///< of M
  Vector3 translation;
  double scale = 1;        ///< of M: source.scale / target.scale
  double slack = 0;        ///< in units of the target; a number of single precision
  double to_world = 1;     ///< lower bound of the placed length of one unit of the target
  double from_world = 1;   ///< a little more than its inverse
  bool comparable = true;  ///< false: the source is so much larger that single precision cannot hold it

  RelativeFrame() = default;
  RelativeFrame(const PlacedFrame& target, const PlacedFrame& source);
  /// How the second is seen from the first, and the first from the second.
  [[nodiscard]] static std::array<RelativeFrame, 2> both(const PlacedFrame& a, const PlacedFrame& b);

  [[nodiscard]] Point3 apply(const Point3& p) const {
    return Point3{} + (times(rows, p - Point3{}) + translation);
  }

 private:
  // `turn` is that of M.
  RelativeFrame(const PlacedFrame& target, const PlacedFrame& source, const Rows3& turn);
};

}  // namespace snug
