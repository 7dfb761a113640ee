#pragma once

#include <oracle/distance_twin.h>
#include <oracle/twin_mesh.h>

#include <gmpxx.h>

#include <array>
#include <optional>
#include <vector>

namespace oracle {

/// Triangles as they are, as corners of their own.
using TriangleSoup = std::vector<std::array<Point, 3>>;

/// The first t in [0, 1] at which `moving`, translated by t times `by`, has a common point with `still`; in
/// exact rational arithmetic. Two triangles meet while their shadows on all axes do on which convex sets with
/// their edges can be told apart; the shadows of a translated one meet for an interval of times.
[[nodiscard]] std::optional<mpq_class> first_contact(const TriangleSoup& still, const TriangleSoup& moving,
                                                     const Point& by);

/// A rigid motion by its definition in words: from a placement, about an axis through a point by an angle, while
/// the point moves by `velocity` and by the integral of `turning` rotated along. In MPFI's 160-bit intervals.
struct TwinScrew {
  Placement from;
  Point axis, about, velocity, turning;
  double radians;
  std::optional<Placement> to;  ///< plus s (to - what the rest gives at s = 1)
};
/// Upper bounds of |placement - exact| for each number at s.
[[nodiscard]] std::array<double, 12> placement_errors(const TwinScrew& screw, double s,
                                                      const Placement& placement);

/// What a chain of joints moves, by the matrices of its frames and joints one after the other; with what is added so that it
/// begins and ends in two placements. In the same intervals.
struct TwinChain {
  struct Joint {
    Placement frame;
    Point axis;
    bool slides;
    double from, to;
  };
  std::vector<Joint> joints;
  Placement tip, from, to;
};
[[nodiscard]] std::array<double, 12> placement_errors(const TwinChain& chain, double s,
                                                      const Placement& placement);
/// The same chain without what is added, in long doubles, for a time in [0, 1].
[[nodiscard]] std::array<long double, 12> placement_of(const TwinChain& chain, long double s);

/// How far two boxes [-half, half] under placements are apart along the best of the fifteen axes; negative: so deep
/// they penetrate. In long doubles, up to some of their roundings; exact up to the sign of the distance.
[[nodiscard]] long double separation(const Point& half_a, const Placement& a, const Point& half_b,
                                     const Placement& b);

}  // namespace oracle
