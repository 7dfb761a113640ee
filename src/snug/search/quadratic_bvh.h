#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include <snug/bounds/quadratic.h>
#include <snug/bvh/wide_bvh.h>
#include <snug/geometry/triangle.h>

namespace snug {

/// Rounding error of distances below: coordinates are at most about 4, and no
/// result takes more than some hundred roundings.
inline constexpr double distance_rounding = 0x1p-41;

/// The point of a quadratic triangle at a parameter.
[[nodiscard]] Point3 point_of(const QuadraticTriangle& quadratic, TriangleParameter at);
/// Its restriction to a triangle of parameters: the same points, up to rounding, with the same error.
[[nodiscard]] QuadraticTriangle restricted(const QuadraticTriangle& quadratic,
                                           const std::array<TriangleParameter, 3>& corners);
/// A triangle as a quadratic one.
[[nodiscard]] QuadraticTriangle flat_quadratic(const Triangle& triangle);

/// Where a point of a quadratic triangle is that was found near another point.
struct QuadraticFoot {
  std::uint32_t piece = 0;
  TriangleParameter at;
  Point3 point;
  double distance = INFINITY;  ///< from the other point, in double precision
};

/// A tree over quadratic triangles; each stands for all points within its error.
/// Immutable; may be read by many threads.
class QuadraticBvh {
 public:
  /// Requires:  the quadratics outlive it; at least one, coordinates at most about 2, errors finite.
  QuadraticBvh(std::span<const QuadraticTriangle> quadratics, int threads);

  [[nodiscard]] const QuadraticTriangle& operator[](std::uint32_t i) const { return quadratics_[i]; }

  /// A point on one piece near p: exact up to rounding on a flat one, by Newton's method on others.
  [[nodiscard]] QuadraticFoot foot_on(std::uint32_t piece, const Point3& p) const;
  /// The part of a piece whose corners are three feet on it.
  /// Requires:  feet of the same piece.
  [[nodiscard]] QuadraticTriangle below(const std::array<QuadraticFoot, 3>& feet) const;
  /// The nearest of such points on all pieces; `hint` is one that was found before.
  /// No proof rests on its being the nearest one.
  [[nodiscard]] QuadraticFoot nearest(const Point3& p, const QuadraticFoot& hint = {}) const;

  /// A lower bound of the distance of p to the sets of the pieces. Improves `foot` where a nearer one is met.
  /// Tightness: within `gap` of foot.distance less the errors of the pieces near it, unless curvature would
  ///            take too many splits.
  [[nodiscard]] double certain_distance(const Point3& p, double gap, QuadraticFoot& foot) const;

  /// May the set of `part` meet that of a piece? False is proved. Pieces are split
  /// until they are as small as the part and their Bezier points nearly as flat as `flat`.
  [[nodiscard]] bool may_meet(const QuadraticTriangle& part, double flat = INFINITY) const;

  /// Marks pieces whose sets may be within `reach` of a point of the set of `part`; all others are
  /// certainly farther away.
  void mark_near(const QuadraticTriangle& part, double reach, std::span<std::uint8_t> marks) const;

  /// Calls visit(piece) for all whose sets may meet the ball around that of `part`.
  void for_each_near(const QuadraticTriangle& part, const std::function<void(std::uint32_t)>& visit) const;

  [[nodiscard]] std::size_t bytes() const;

 private:
  // Calls visit(piece) for those whose boxes are at most `reach` from p, until it returns true.
  template <class Visit>
  bool any_near(const Point3& p, double reach, const Visit& visit) const;

  std::span<const QuadraticTriangle> quadratics_;
  std::vector<std::uint8_t> curved_;
  mutable std::vector<WideNode> leaves_;  // boxes around the pieces of each leaf
  WideBvh tree_;
};

}  // namespace snug
