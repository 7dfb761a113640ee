#pragma once

#include <array>
#include <optional>

#include <snug/geometry/rounding.h>
#include <snug/patch/patch.h>

namespace snug {

/// A point of the limit surface, or of a limit curve.
struct RelativePoint {
  Vector3 relative;  ///< to the patch's origin
  double error;      ///< upper bound, a coordinate, of |relative - exact|

  /// The point itself; its error covers the rounding of the sum.
  [[nodiscard]] BoundedPoint from(const Point3& origin) const {
    const Point3 point = origin + relative;
    return {point, error + unit_roundoff * max_abs(point - Point3{})};
  }
};

/// A limit point with what the surface does there.
struct LimitFrame {
  RelativePoint point;
  /// Derivatives along u and v where they exist; elsewhere two limit tangents, counter-clockwise, of any
  /// length.
  std::array<Vector3, 2> tangents;
  bool differentiable;            ///< tangents are derivatives in (u, v)
  std::optional<Vector3> normal;  ///< of length 1; absent where the tangents are parallel or vanish
  /// Upper bound, a coordinate, of |tangent - exact derivative|, where derivatives are those of a polynomial.
  std::optional<double> tangent_error{};
  /// Upper bound of |normal - exact normal|, where tangents have one that is small enough.
  std::optional<double> normal_error{};
};

/// Limit point at any parameter, extraordinary corners included.
/// Guarantee: |relative - exact| <= error a coordinate, at exactly these doubles.
/// Errors:    InputError (value) unless u >= 0, v >= 0, u + v <= 1 in doubles. Where the exact sum is above 1
///            all the same, the smaller of the two is lowered to the far edge: that point is meant.
/// Cost:      regular: 45 ns; near an extraordinary corner a split a level, at most 60.
[[nodiscard]] RelativePoint limit_point(const Patch& patch, TriangleParameter at);

/// The same with tangents and normal.
[[nodiscard]] LimitFrame limit_frame(const Patch& patch, TriangleParameter at);
/// Sets normal and normal_error from the tangents and their error.
/// Source:    derivations/rounding.md, "Normals".
void add_normal(LimitFrame& frame);

/// Limit position of corner 0, 1 or 2 of the patch: one row.
[[nodiscard]] RelativePoint corner_point(const Patch& patch, std::size_t corner);
/// Limit positions of all three.
[[nodiscard]] std::array<Vector3, 3> limit_corners(const Patch& patch);

}  // namespace snug
