#pragma once

#include <oracle/twin_mesh.h>

#include <array>
#include <cstddef>
#include <vector>

namespace oracle {

/// A triangle by its corners. Any three points: it may be a segment or a point.
using Corners = std::array<Point, 3>;

/// Of the points of a set, which count: all, or those on one side of the solid that the other set bounds.
enum class Side { any, inside, outside };

struct HausdorffGoal {
  long double precision = 0;  ///< upper - lower may be this
  Side side = Side::any;
  std::size_t effort = 20'000;  ///< or the search ends after so many splits
};

/// lower <= distance <= upper, whether the goal was reached or not.
struct HausdorffBounds {
  long double lower = 0, upper = 0;
  Point farthest{};    ///< rounded to doubles; meaningless where lower is 0
  bool spent = false;  ///< the effort ended the search
};

/// The greatest distance of a point of `from` from the set `to`: a one-sided Hausdorff distance, by branch and
/// bound over parts of the triangles. With a side: of its points there, and 0 if there are none.
///
/// A part is bounded from above by its corners' distances from one triangle of `to`, the best one: the
/// distance from a convex set is convex. From below corners themselves count. The distance of a corner from a
/// triangle lies between that of a plane which has all three corners on its far side and that of a point of the
/// triangle: both hold however the nearest point was found. Parts are halved, or cut where their best triangle
/// ends, so that parts over one triangle each are soon told. Inside is where `to` winds around a point,
/// measured by solid angles, which is the same for all points of a part that stays away from `to`.
///
/// Rounding:  long double, of 64 bits. Corners after L <= 100 splits are off by at most 20 (L + 1) 2^-64 D,
///            distances by 50 2^-64 D, D the largest difference of a coordinate and that of a corner of `to`.
///            Bounds are moved outwards by 2^-52 D. Points nearer to `to` than 1e-7 D count for either side
///            from above, for none from below.
/// Requires:  the long double of x86: squares of all doubles fit it. With a side, `to` is closed.
/// Errors:    std::invalid_argument if a set is empty or `to` is not closed though it has to be.
/// Cost:      the product of both numbers, and some microseconds a split. It stays at `effort` where many points
///            are as far away as the farthest one and as far from two triangles.
[[nodiscard]] HausdorffBounds one_sided_hausdorff(const std::vector<Corners>& from,
                                                  const std::vector<Corners>& to, const HausdorffGoal& goal);

/// The distance of a point from a set, enclosed in the same way.
[[nodiscard]] HausdorffBounds distance_to_triangles(const Point& point, const std::vector<Corners>& to);

}  // namespace oracle
