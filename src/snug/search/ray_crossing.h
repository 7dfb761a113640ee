#pragma once

#include <array>
#include <optional>

#include <snug/geometry/triangle.h>
#include <snug/search/piece_leaf.h>
#include <support/point.h>

namespace snug {

/// A line, and axes across it: coordinates of points are the distance along it and the offset across.
struct RayFrame {
  /// Requires:  direction of length 1, up to some roundings.
  RayFrame(const Point3& from, const Vector3& direction);
  Point3 origin;
  Vector3 along;
  std::array<Vector3, 2> across;
};

/// A place across a ray, relative to it.
struct Offset2 {
  double x = 0, y = 0;
};

/// Does a line near a ray meet a piece? Where it does so, and on which side.
struct LinePieceCrossing {
  enum class State : std::uint8_t {
    none,    ///< the piece is not met
    one,     ///< it is met, and its border, seen along the line, winds around that once
    unsure,  ///< met near its border, or next to it
    bent,    ///< the piece bends too much as seen along the line, or lies along it
  };
  State state = State::bent;
  /// Only errors and the reach leave it open; otherwise bending does, and splits help.
  bool limited_by_errors = false;
  int side = 0;          ///< of `one`: +1 where the line leaves to the side of the normal, else -1
  TriangleParameter at;  ///< close to the place, on the triangle; but for `none`
  Extent along;          ///< holds all of the piece that the line meets, as distances from the ray's origin
};

/// A piece as it is seen from a ray: the quadratic triangle near it, and how near it is.
///
/// Guarantee: all results hold for the limit surface, rounding included.
/// Source:    derivations/rays.md.
class SeenPiece {
 public:
  SeenPiece() = default;
  SeenPiece(const RayFrame& ray, const PieceBounds& record, const Point3& origin);

  /// How the line through `place`, parallel to the ray, and all lines within `reach` of it meet the piece: with a
  /// reach of zero that line alone, else `none` and `along` are about all of these lines. An extent of `enough`
  /// is not narrowed further where errors leave the place itself no narrower.
  [[nodiscard]] LinePieceCrossing crossing(const Offset2& place, double reach, double enough = 0) const;
  /// Upper bound of how far the limit surface is from the quadratic, a length, rounding included.
  [[nodiscard]] double error() const { return error_; }
  /// Does the ray's line lie in the piece, as far as some points of `along` tell? Seldom wrong, no proof, and only of pieces whose
  /// quadratics are known to a millionth. `along`: what it may have in common with the piece.
  [[nodiscard]] bool seems_to_hold_line(const Extent& along) const;
  /// Upper bound of how far `along` of a bent piece is too long at either end, but for the reach.
  [[nodiscard]] double bend() const;
  /// Does the line through `place` pass the side from corner k to the next one with more than `reach`?
  [[nodiscard]] bool passes_side(std::size_t k, const Offset2& place, double reach) const;
  /// Width of the narrowest strip along a side, or between sides, that the piece is seen in.
  [[nodiscard]] double width() const;

 private:
  // Holds the part of the piece within `reach` of the line, by the triangle of its corners; empty where there is none.
  [[nodiscard]] Extent chord(const Offset2& place, double reach) const;

  // Bezier points as (across, across, along): corners, then middles of the edges 01, 12, 20.
  std::array<Vector3, 6> net_;
  double error_ = INFINITY;
  // The quadratic is net_[0] + u along_u_ + v along_v_ + u^2 uu_ + u v uv_ + v^2 vv_.
  Vector3 along_u_, along_v_, uu_, uv_, vv_;
};

/// Holds the part of a ray's line within `reach` of a convex quad whose corners are off by at most `error` a coordinate, if the line
/// lies in its plane up to roundings; nothing if it does not.
[[nodiscard]] std::optional<Extent> chord_in_plane(const RayFrame& ray, const std::array<Point3, 4>& quad,
                                                   double error, double reach);

}  // namespace snug
