#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <span>

#include <snug/bounds/quadratic.h>
#include <snug/patch/piece_path.h>

namespace snug {

/// A triangle of the result: corners as they will be written, and their parameters on the root patch.
struct FlatTriangle {
  std::array<Point3, 3> corner;
  std::array<TriangleParameter, 3> at;
};

/// How far a surface is from a flat triangle, parameter by parameter.
struct Flatness {
  double error;       ///< |patch(t) - triangle(t)| <= error over the triangle; infinite if not finite
  double corner_gap;  ///< largest distance of the quadratic at a corner from that of the triangle
};

/// A quadratic near a piece as a polynomial in the piece's parameters.
class PieceQuadratic {
 public:
  PieceQuadratic() = default;
  /// Requires:  finite points.
  PieceQuadratic(const QuadraticTriangle& near, const PiecePath& path);

  [[nodiscard]] double error() const { return static_cast<double>(error_); }
  [[nodiscard]] unsigned level() const { return static_cast<unsigned>(std::ilogb(scale_)); }
  /// Upper bound of the distance of a flat triangle on this piece.
  ///
  /// Guarantee: Flatness::error, rounding included, for exactly these corners; it covers every point of the patch
  ///            over the triangle and every point of the triangle.
  /// Requires:  parameters that are multiples of 2^-50 on the piece, exact.
  /// Source:    derivations/tessellation.md.
  [[nodiscard]] Flatness flatness(const FlatTriangle& triangle) const;
  /// The same of up to eight triangles at once, each on the piece of the same number, to the bit on every instruction set.
  static constexpr std::size_t max_lanes = 8;
  static void flatness(std::span<const PieceQuadratic* const> pieces, std::span<const FlatTriangle> triangles,
                       std::span<Flatness> out);
  /// Middle of a chord less the curve, between two parameters of the patch, rounded.
  [[nodiscard]] Vector3 bow(TriangleParameter a, TriangleParameter b) const;

 private:
  using Single = std::array<float, 3>;
  [[nodiscard]] TriangleParameter local(TriangleParameter p) const;
  [[nodiscard]] Vector3 from_origin(TriangleParameter local) const;

  // Millions are kept at once. The second order, which is what a triangle's error is made of, is single precision: its roundings
  // are a millionth of the error.
  TriangleParameter first_;  // corner 0 in its patch
  Point3 origin_;
  Vector3 u_, v_;
  Single uu_{}, uv_{}, vv_{};
  float error_ = 0;  // from the polynomial as it is rounded
  float scale_ =
      1;  // from parameters of the patch to those of the piece: 2^level, less than 0 where it is turned
};

}  // namespace snug
