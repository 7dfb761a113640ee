#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>

#include <snug/search/piece_set.h>

/// Feet on quadratic triangles, and how far the pieces of a set are from points and from other triangles. Sets are prepared.
namespace snug {

/// Rounding error of distances below: coordinates are at most about 4, and no
/// result takes more than some hundred roundings.
inline constexpr double distance_rounding = 0x1p-41;

/// Corners, then middles.
[[nodiscard]] std::array<Point3, 6> points_of(const QuadraticTriangle& quadratic);
/// The point of a quadratic triangle at a parameter.
[[nodiscard]] Point3 point_of(const QuadraticTriangle& quadratic, TriangleParameter at);
/// Its restriction to a triangle of parameters: the same points, up to rounding, with the same error.
[[nodiscard]] QuadraticTriangle restricted(const QuadraticTriangle& quadratic,
                                           const std::array<TriangleParameter, 3>& corners);
/// A triangle as a quadratic one.
[[nodiscard]] QuadraticTriangle flat_quadratic(const Triangle& triangle);
/// Bounds of dot(direction, x) over its set.
[[nodiscard]] Extent extent_of(const QuadraticTriangle& quadratic, const Vector3& direction);

/// Where a point of a quadratic triangle is that was found near another point.
struct QuadraticFoot {
  std::uint32_t piece = 0;
  TriangleParameter at;
  Point3 point;
  double distance = INFINITY;  ///< from the other point, in double precision
};

/// A point on one piece near p: exact up to rounding on a flat one, by Newton's method on others. At an infinite distance where it is
/// farther than `least`, if that is seen sooner.
[[nodiscard]] QuadraticFoot foot_on(const PieceSet& set, std::uint32_t piece, const Point3& p,
                                    double least = INFINITY);
/// The foot of p at a parameter of a piece, as foot_on() has it.
[[nodiscard]] QuadraticFoot foot_at(const PieceSet& set, std::uint32_t piece, TriangleParameter at,
                                    const Point3& p);
/// A point near p on the piece of another point's foot, by Newton's method from that: on the same sheet of a piece that comes back to where it
/// was, if both points are near each other.
[[nodiscard]] QuadraticFoot foot_beside(const PieceSet& set, const QuadraticFoot& foot, const Point3& p);
/// The part of a piece whose corners are three feet on it.
/// Requires:  feet of the same piece.
[[nodiscard]] QuadraticTriangle below(const PieceSet& set, const std::array<QuadraticFoot, 3>& feet);
/// The nearest of such points on all pieces; `hint` is one that was found before.
/// No proof rests on its being the nearest one.
[[nodiscard]] QuadraticFoot nearest_foot(const PieceSet& set, const Point3& p,
                                         const QuadraticFoot& hint = {});

/// An upper bound of the distances of a triangle's points from the piece of a foot, by points of it near the corners; infinite if one of
/// these is farther than `most`.
/// Source:    derivations/envelopes.md, "Proving it".
[[nodiscard]] double farthest_from(const PieceSet& set, const QuadraticFoot& foot, const Triangle& triangle,
                                   double most);

/// A lower bound of the distance of p to the sets of the pieces. Improves `foot` where a nearer one is met.
/// Tightness: within `gap` of foot.distance less the errors of the pieces near it, unless curvature would
///            take too many splits.
[[nodiscard]] double certain_distance(const PieceSet& set, const Point3& p, double gap, QuadraticFoot& foot);

/// A box around its set with an axis along the longest edge of its corners: slim around a narrow one.
[[nodiscard]] Obb slim_box(const QuadraticTriangle& quadratic);

/// May the set of `part` meet that of a piece? False is proved. Pieces are split
/// until they are as small as the part and their Bezier points nearly as flat as `flat`.
[[nodiscard]] bool may_meet(const PieceSet& set, const QuadraticTriangle& part, double flat = INFINITY);

/// Marks pieces whose sets may be within `reach` of a point of the set of `part`; all others are
/// certainly farther away.
void mark_near(const PieceSet& set, const QuadraticTriangle& part, double reach,
               std::span<std::uint8_t> marks);

/// Calls visit(piece) for all whose sets may meet the ball around that of `part`.
void for_each_near(const PieceSet& set, const QuadraticTriangle& part,
                   const std::function<void(std::uint32_t)>& visit);

}  // namespace snug
