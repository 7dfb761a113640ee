#pragma once

#include <array>
#include <cstddef>
#include <limits>

/// Points and sets as plain values. Arithmetic on them is private to the library, since its error bounds depend on how it
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

/// A position that was computed, and how far it is from the exact one.
struct BoundedPoint {
  Point3 position;
  double error = 0;  ///< upper bound, per coordinate, of |position - exact|, rounding included
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
  [[gnu::always_inline]] constexpr void add(const Box3& box) {
    add(box.lower);
    add(box.upper);
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

}  // namespace snug
