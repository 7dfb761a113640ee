#pragma once

#include <array>
#include <cstdint>
#include <span>

#include <snug/geometry/point.h>

namespace snug {

/// Sorts of convex sets that trees are made of: boxes along the coordinate axes, boxes with axes of their own, and
/// polytopes with k fixed directions of facets.
enum class Volume : std::uint8_t { aabb, obb, dop14, dop18, dop26 };
inline constexpr std::array all_volumes{Volume::aabb, Volume::obb, Volume::dop14, Volume::dop18,
                                        Volume::dop26};
[[nodiscard]] const char* name_of(Volume volume);

/// The set of x with |dot(axis_k, x - centre)| <= half_k for k = 0, 1, 2. Axes are orthonormal up to a few
/// roundings; the set is meant with these very doubles.
struct Obb {
  Point3 centre;
  std::array<Vector3, 3> axes{Vector3{1, 0, 0}, Vector3{0, 1, 0}, Vector3{0, 0, 1}};
  Vector3 half;
};

/// Directions of the polytopes: the coordinate axes; the diagonals of a cube; those of its faces.
inline constexpr std::size_t max_directions = 13;
inline constexpr std::array<Vector3, max_directions> all_directions{{{1, 0, 0},
                                                                     {0, 1, 0},
                                                                     {0, 0, 1},
                                                                     {1, 1, 1},
                                                                     {1, 1, -1},
                                                                     {1, -1, 1},
                                                                     {1, -1, -1},
                                                                     {1, 1, 0},
                                                                     {1, -1, 0},
                                                                     {1, 0, 1},
                                                                     {1, 0, -1},
                                                                     {0, 1, 1},
                                                                     {0, 1, -1}}};
/// Places in all_directions of those that a sort has: the axes first. None for obb.
[[nodiscard]] std::span<const std::uint8_t> directions_of(Volume volume);

/// A set of any sort. obb: the box. Others: lower[i] <= dot(direction i, x) <= upper[i], the directions being those of
/// directions_of().
struct BoundingVolume {
  Obb box;
  std::array<double, max_directions> lower{}, upper{};
};

/// What a volume is fitted around.
class Enclosed {
 public:
  struct Extent {
    double lower, upper;
  };
  /// Bounds of dot(direction, x), rounding included.
  [[nodiscard]] virtual Extent extent(const Vector3& direction) const = 0;
  /// The same along several directions.
  virtual void extents(std::span<const Vector3> directions, std::span<Extent> out) const;
  /// Points spread like the set, from which axes are chosen.
  [[nodiscard]] virtual std::span<const Point3> points() const = 0;

 protected:
  ~Enclosed() = default;
};

/// Axes for a box around points: the principal axes, orthonormal up to a few roundings.
/// Source:    [Gottschalk96].
[[nodiscard]] std::array<Vector3, 3> principal_axes(std::span<const Point3> points);

/// A volume around a set. Extents that are not finite make one that nothing is certainly apart from.
/// Guarantee: contains the set, rounding included.
[[nodiscard]] BoundingVolume fit(Volume volume, const Enclosed& set);
/// The box with given axes.
[[nodiscard]] Obb fit(const std::array<Vector3, 3>& axes, const Enclosed& set);
/// A volume around volumes of the same sort.
/// Requires:  at least one.
[[nodiscard]] BoundingVolume merge(Volume volume, std::span<const BoundingVolume> parts);

/// A ball around a volume.
struct Ball {
  Point3 centre;
  double radius;
};
[[nodiscard]] Ball ball_around(Volume volume, const BoundingVolume& set);
/// A box around a volume.
[[nodiscard]] Obb box_around(Volume volume, const BoundingVolume& set);

}  // namespace snug
