#pragma once

#include <cstddef>
#include <span>
#include <vector>

namespace snug {

/// The plane z = at_centre + slope_x (x - centre_x) + slope_y (y - centre_y).
struct Plane {
  double at_centre = 0, slope_x = 0, slope_y = 0;
  double centre_x = 0, centre_y = 0;
  [[nodiscard]] double operator()(double x, double y) const {
    return at_centre + slope_x * (x - centre_x) + slope_y * (y - centre_y);
  }
};

/// Planes above points at given places, whose heights differ from plane to plane.
class PlanesAbove {
 public:
  /// Requires:  spans of equal size, at least 1, that outlive this; finite numbers, of about 1.
  PlanesAbove(std::span<const double> x, std::span<const double> y, double centre_x, double centre_y);

  /// The plane that passes above all points (x_j, y_j, z_j) and is least at the centre. With the centroid of a triangle as
  /// centre it has the least volume below it over that triangle.
  ///
  /// Guarantee: none: up to rounding it is above the points and the least that is. Who needs a proof moves it
  ///            up by the largest violation. Always a finite plane, whatever duplicates, points on a line and
  ///            ties there are; slopes are at most 2^12 in size. The same input gives the same plane.
  /// Requires:  as many numbers, likewise.
  /// Cost:      a pass over the points for each that joins: some six.
  /// Source:    [Seidel91] for some of the points, which the one farthest above joins until there is none; differs: one fixed
  ///            pseudo-random order, slopes held in a box instead of a check for unboundedness, and constraints without a
  ///            direction are passed over.
  [[nodiscard]] Plane lowest(std::span<const double> z) const;

 private:
  std::span<const double> x_, y_;
  double centre_x_, centre_y_;
  std::vector<std::size_t> extremes_;  // along either axis
};

}  // namespace snug
