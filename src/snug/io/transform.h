#pragma once

#include <array>
#include <span>
#include <string>
#include <string_view>

#include <snug/geometry/interval.h>
#include <support/point.h>

namespace snug {

/// An affine map, each of its numbers enclosed: x -> A x + t.
///
/// Guarantee: inclusion. Zeros, ones and minus ones of the matrix cost no precision: the identity, mirrors
///            and quarter turns are exact.
struct AffineEnclosure {
  std::array<std::array<Interval, 3>, 3> matrix{{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};
  std::array<Interval, 3> shift{};

  [[nodiscard]] std::array<Interval, 3> operator()(const Point3& point) const;
  /// First `inner`, then this one.
  [[nodiscard]] AffineEnclosure after(const AffineEnclosure& inner) const;
  /// 1 or -1: the sign of the determinant; 0 if it is 0 or too near to it.
  [[nodiscard]] int handedness() const;
  [[nodiscard]] bool is_finite() const;
  friend bool operator==(const AffineEnclosure&, const AffineEnclosure&) = default;
};

/// The map of one operation of a file, or why there is none.
struct TransformOperation {
  AffineEnclosure map;
  /// The end of a sentence that begins with the name of the operation. Empty if there is a map.
  std::string fault;
};

/// The map of an operation, or its inverse.
///
///     translate, scale      three numbers; translateX, scaleX and so on: one
///     rotateX, Y, Z         degrees, counter-clockwise where the axis points at the viewer
///     rotateXYZ and so on   degrees about x, y and z; the letters are the order of the turns
///     orient                a quaternion w x y z; its length, within a hundredth of 1, is divided out
///     transform             a matrix, the images of x, y, z and of the origin one after the other, each with
///                           the number 0 or 1 behind it: by rows in USD, by columns in glTF
///
/// Source:    OpenUSD, UsdGeomXformable and UsdGeomXformOp; glTF 2.0, section 3.5.
[[nodiscard]] TransformOperation transform_operation(std::string_view kind, std::span<const double> numbers,
                                                     bool inverse = false);

}  // namespace snug
