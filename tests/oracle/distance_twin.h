#pragma once

#include <oracle/twin_mesh.h>

#include <cstdint>
#include <memory>
#include <optional>

namespace oracle {

/// Row-major 3 x 4: x' = R x + t. Meant for rigid motions; any affine map gives right, if slower, answers.
using Placement = std::array<double, 12>;
inline constexpr Placement kUnmoved{1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0};

/// lower <= distance <= upper. on_a and on_b are placed limit points at a distance of at most upper (up to
/// their rounding).
struct TwinDistance {
  double lower, upper;
  Point on_a, on_b;
};

/// lower <= distance of a point to the surface <= upper; `nearest` is a limit point at a distance of at most
/// upper.
struct PointDistance {
  double lower, upper;
  Point nearest;
};

/// When a search may stop: upper - lower <= max(absolute, relative * upper).
struct Precision {
  double absolute;
  double relative = 0;
};

/// A Loop limit surface with a tree of sub-patches that grows with the questions and is kept between them.
///
/// Each patch is known by its own control net, which its limit patch never leaves (all masks are convex), and
/// by the limit points of its three corners. The tree starts afresh when it outgrows kLargestTree patches.
///
/// Rounding:  plain doubles. Every bound below is moved outwards by slack() = (62 (N + 8) + 64) 2^-52 S, N
/// the largest
///            valence, S the largest |coordinate| the placed nets can have: 2.3e-13 S at valence 8, below
///            1e-12 S to valence 60.
/// Requires:  coordinates between 1e-140 and 1e140 in size, or zero: squares are taken.
/// Errors:    std::invalid_argument, see TwinMesh; also if no face has a surface or a placement is not
/// finite.
/// Cost:      splitting a patch some 10 microseconds, once.
class SurfaceTwin {
 public:
  static constexpr std::size_t kLargestTree = 200'000;

  explicit SurfaceTwin(const TwinMesh& mesh);
  ~SurfaceTwin();
  SurfaceTwin(SurfaceTwin&&) noexcept;
  SurfaceTwin& operator=(SurfaceTwin&&) noexcept;

  /// Distance of `point` to the placed surface, or to the part of it that belongs to control face `face`.
  ///
  /// Guarantee: the bounds hold; they are as close as `precision` asks, unless rounding stops it (absolute
  ///            below 4 slack).
  /// Requires:  a face with a surface.
  /// Cost:      on the surface, with absolute = 1e-10 of the size: below 1 ms. Away from it a tight precision
  ///            at a centre of curvature makes the search exhaustive: give a relative one.
  [[nodiscard]] PointDistance distance_to(const Placement& placement, const Point& point,
                                          const Precision& precision, std::optional<std::uint32_t> face = {});

  /// Is there a limit point within `tolerance` of `point`?
  ///
  /// Guarantee: true only if there is; false only if there is none within tolerance - 4 slack.
  [[nodiscard]] bool on_surface(const Placement& placement, const Point& point, double tolerance,
                                std::optional<std::uint32_t> face = {});

  /// The most that rounding can hide for this placement, in units of length.
  [[nodiscard]] double slack(const Placement& placement) const;

 private:
  friend class DistanceTwin;
  struct Tree;
  std::unique_ptr<Tree> tree_;
};

/// Distances between two Loop limit surfaces under placements, by best-first branch and bound over pairs of
/// sub-patches.
///
/// A pair is bounded from below by the gap of its two control nets along a direction: any direction is valid,
/// Gilbert's iteration finds good ones. It is bounded from above by the distances of limit corners.
/// Source:    [Gilbert66] for the directions; the bound itself is the convex hull property.
class DistanceTwin {
 public:
  DistanceTwin(const TwinMesh& a, const TwinMesh& b);

  /// Guarantee: lower <= distance <= upper, rounding included (sum of both slacks); upper - lower <=
  ///            precision.absolute or the relative bound, plus twice the slacks. Disjoint surfaces are also
  ///            told from touching ones: lower is 0 unless a gap is proved. One surface inside the other
  ///            counts as disjoint: these are surfaces, not solids.
  /// Requires:  precision.absolute at least 1e-9 of the size, or the search may take very long.
  /// Cost:      meshes of 250 faces, absolute = 1e-3 of the size: some 10 ms where they meet, 20 to 50 ms
  ///            where they do not.
  [[nodiscard]] TwinDistance query(const Placement& place_a, const Placement& place_b,
                                   const Precision& precision);

 private:
  SurfaceTwin a_, b_;
};

/// One query without a twin to keep. `precision` is absolute.
[[nodiscard]] TwinDistance brute_distance(const TwinMesh& a, const Placement& place_a, const TwinMesh& b,
                                          const Placement& place_b, double precision);

/// SurfaceTwin::on_surface without a twin to keep.
[[nodiscard]] bool on_surface(const TwinMesh& mesh, const Placement& placement, const Point& point,
                              double tolerance, std::optional<std::uint32_t> face = {});

}  // namespace oracle
