#pragma once

#include <cmath>
#include <cstdint>
#include <vector>

#include <snug/bvh/obb.h>
#include <snug/geometry/triangle.h>
#include <snug/ray.h>
#include <snug/surface/piece_name.h>
#include <support/point.h>

namespace snug {

/// A ray in scaled units; lengths along it are from its origin.
struct RayTask {
  Point3 origin;
  Vector3 along;  ///< of length 1, up to some roundings
  Extent outer,
      inner;  ///< the part that counts: all of `inner`, nothing beyond `outer`; they differ by roundings
  RayQuery query = RayQuery::nearest;
  double precision = 0;
  std::uint64_t budget = 0;

  [[nodiscard]] bool within(const Extent& part) const {
    return part.lower >= inner.lower && part.upper <= inner.upper;
  }
  [[nodiscard]] bool is_located(const Extent& part) const { return part.upper - part.lower <= precision; }
};

/// RayHit in scaled units, at a parameter of a piece.
struct FoundHit {
  Extent along;
  bool certified = false, reached = false;
  int side = 0;
  PieceName piece;
  TriangleParameter at;
};
struct FoundHits {
  std::vector<FoundHit> hits;
  bool complete = true;

  void sort();
};

/// The part of a ray that comes near a surface: a segment, relative to whose middle single precision will do.
struct NearPart {
  NearPart() = default;
  NearPart(const RayTask& task, const Ball& ball);
  [[nodiscard]] bool bounded() const { return std::isfinite(lower) && std::isfinite(upper); }
  [[nodiscard]] bool empty() const { return upper < lower; }
  /// A place along the ray as a distance from the segment's middle, rounded up.
  [[nodiscard]] float from_middle(double place) const;

  double far = 0;  ///< how far the surface's middle is from the ray's origin, a coordinate
  double lower = INFINITY, upper = -INFINITY;  ///< along the ray
  double centre = 0, half = 0;                 ///< of these
  Point3 middle;
  double rounding = 0;  ///< of distances from it
};

}  // namespace snug
