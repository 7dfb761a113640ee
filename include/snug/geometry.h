#pragma once

#include <array>
#include <cstddef>
#include <limits>

#include <snug/run.h>

/// Points, sets and rigid transforms as plain values. Arithmetic on them is private to the library, since its error bounds depend on how it
/// is compiled. Comparisons are inlined: the library never uses those of a program built with other flags.
namespace snug {

/// A displacement. Points and vectors are different types: two points cannot be added by accident.
struct Vector3 {
  double x = 0, y = 0, z = 0;
  [[nodiscard]] constexpr double operator[](std::size_t axis) const {
    return axis == 0 ? x : axis == 1 ? y : z;
  }
  constexpr double& operator[](std::size_t axis) { return axis == 0 ? x : axis == 1 ? y : z; }
  [[gnu::always_inline]] friend constexpr bool operator==(const Vector3&, const Vector3&) = default;
};

/// A position.
struct Point3 {
  double x = 0, y = 0, z = 0;
  [[nodiscard]] constexpr double operator[](std::size_t axis) const {
    return axis == 0 ? x : axis == 1 ? y : z;
  }
  constexpr double& operator[](std::size_t axis) { return axis == 0 ? x : axis == 1 ? y : z; }
  [[gnu::always_inline]] friend constexpr bool operator==(const Point3&, const Point3&) = default;
};

using Segment = std::array<Point3, 2>;
using Triangle = std::array<Point3, 3>;

/// Closed axis-aligned box; empty while lower > upper.
struct Box3 {
  static constexpr double infinity = std::numeric_limits<double>::infinity();

  Point3 lower{infinity, infinity, infinity};
  Point3 upper{-infinity, -infinity, -infinity};
  [[gnu::always_inline]] friend constexpr bool operator==(const Box3&, const Box3&) = default;

  [[gnu::always_inline]] constexpr void add(Point3 p) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      if (p[axis] < lower[axis]) lower[axis] = p[axis];
      if (p[axis] > upper[axis]) upper[axis] = p[axis];
    }
  }
  [[gnu::always_inline]] constexpr void add(const Box3& box) {  // an empty one adds nothing
    for (std::size_t axis = 0; axis < 3; ++axis) {
      if (box.lower[axis] < lower[axis]) lower[axis] = box.lower[axis];
      if (box.upper[axis] > upper[axis]) upper[axis] = box.upper[axis];
    }
  }
  [[nodiscard, gnu::always_inline]] constexpr bool empty() const { return lower.x > upper.x; }
};

/// All points within `radius` of a triangle or a segment; also called a triangle-swept or line-swept sphere.
template <std::size_t N>
struct OffsetSimplex {
  std::array<Point3, N> base;
  double radius = 0;
  double rounding = 0;  ///< the part of the radius that is due to rounding; splitting does not reduce it
};
using OffsetTriangle = OffsetSimplex<3>;
using OffsetSegment = OffsetSimplex<2>;

/// The convex hull of N boxes, one for each corner of a triangle or end of a segment.
template <std::size_t N>
struct IntervalSimplex {
  std::array<Box3, N> corner;
};
using IntervalTriangle = IntervalSimplex<3>;
using IntervalSegment = IntervalSimplex<2>;

/// A closed interval of real numbers that contains the exact value.
struct Interval {
  double lower = 0, upper = 0;

  constexpr Interval() = default;
  constexpr Interval(double exact) : lower(exact), upper(exact) {}  // NOLINT: a number is an interval
  constexpr Interval(double low, double high) : lower(low), upper(high) {}
  [[nodiscard, gnu::always_inline]] constexpr bool contains(double x) const {
    return lower <= x && x <= upper;
  }
  [[gnu::always_inline]] friend constexpr bool operator==(const Interval&, const Interval&) = default;
};

/// A rigid transform x -> R x + t, given by exactly the twelve doubles of numbers(): row-major 3x4 (R | t).
///
/// Guarantee: all numbers are finite, R'R differs from the identity by at most 1e-9 in each entry, and det R
///            > 0. Motions made from a translation, an axis and an angle, or a quaternion have a defect() of
///            at most 2^-48.
/// Errors:    all ways to make one throw InputError (pose) for numbers that are not finite or not a rigid
///            transform. The message says how far off they are; see nearest_rigid().
class SNUG_API Motion {
 public:
  /// The identity.
  Motion() = default;
  /// Row-major (R | t), taken without change.
  [[nodiscard]] static Motion from_3x4(const std::array<double, 12>& matrix);
  /// Row-major, acting on columns (x, 1); the last row is 0 0 0 1.
  [[nodiscard]] static Motion from_4x4(const std::array<double, 16>& matrix);
  [[nodiscard]] static Motion translation(const Vector3& by);
  /// Rotates about an axis through the origin, counterclockwise when the axis points at the viewer.
  /// Requires:  an axis of any positive length.
  [[nodiscard]] static Motion rotation(const Vector3& axis, double radians);
  /// The same in degrees. Multiples of 90 about x, y or z give a matrix of 0, 1 and -1.
  [[nodiscard]] static Motion rotation_degrees(const Vector3& axis, double degrees);
  /// Rotates by q / |q|, where q = (w, x, y, z) has any positive length, then translates.
  [[nodiscard]] static Motion from_quaternion(const std::array<double, 4>& wxyz,
                                              const Vector3& translation = {});

  [[nodiscard]] const std::array<double, 12>& numbers() const { return numbers_; }
  /// Row i of R.
  [[nodiscard]] Vector3 row(std::size_t i) const {
    return {numbers_[4 * i], numbers_[4 * i + 1], numbers_[4 * i + 2]};
  }
  /// t.
  [[nodiscard]] Vector3 offset() const { return {numbers_[3], numbers_[7], numbers_[11]}; }
  /// The same rotation with another t.
  [[nodiscard]] Motion with_offset(const Vector3& offset) const;
  /// Upper bound of the largest entry of |R'R - I|; at most 1e-9.
  [[nodiscard]] double defect() const { return defect_; }
  /// R v in double precision.
  [[nodiscard]] Vector3 rotate(const Vector3& v) const;
  /// R x + t in double precision.
  [[nodiscard]] Point3 apply(const Point3& p) const;

  /// x -> a(b(x)), with its twelve numbers rounded. A product that drifted beyond the tolerance is replaced
  /// by the nearest rigid transform, so chains of any length stay rigid.
  /// Errors:    InputError (pose) if t does not fit a double.
  SNUG_API friend Motion operator*(const Motion& a, const Motion& b);
  /// Up to a few roundings, or up to 2 defect() if the exact inverse is not rigid within the tolerance.
  [[nodiscard]] Motion inverse() const;

  [[gnu::always_inline]] friend bool operator==(const Motion&, const Motion&) = default;

 private:
  Motion(const std::array<double, 12>& numbers, double defect) : numbers_(numbers), defect_(defect) {}
  static Motion made_rigid(const std::array<double, 12>& numbers);

  std::array<double, 12> numbers_{1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0};
  double defect_ = 0x1p-50;
};

/// The poses of two surfaces.
struct PosePair {
  Motion a, b;
};

/// The motion nearest to a matrix, and how far the matrix was from rigid.
struct NearestRigid {
  Motion motion;
  double defect = 0;  ///< upper bound of the largest entry of |R'R - I| of the matrix
  double change = 0;  ///< the largest change of an entry of R
};

/// The motion with the same t whose R is the orthogonal polar factor of the matrix, which is nearest in the Frobenius
/// norm, up to a few roundings divided by the sum of its two smallest singular values.
///
/// Errors:    InputError (pose) for numbers that are not finite, and for a matrix that mirrors or is
///            singular, with its smallest singular value below 1e-12 of the largest.
/// Source:    [Higham86]; differs: one-sided Jacobi rotations [Hestenes58], then one Newton-Schulz step.
[[nodiscard]] SNUG_API NearestRigid nearest_rigid(const std::array<double, 12>& matrix);

}  // namespace snug
