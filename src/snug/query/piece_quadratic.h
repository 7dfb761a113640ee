#pragma once

#include <array>

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
  std::array<Vector3, 3> bow;  ///< of each side: the middle of the quadratic's chord less its curve, rounded
};

/// A quadratic near a piece as a polynomial in the piece's parameters.
class PieceQuadratic {
 public:
  PieceQuadratic() = default;
  /// Requires:  finite points.
  PieceQuadratic(const QuadraticTriangle& near, const PiecePath& path);

  [[nodiscard]] double error() const { return error_; }
  [[nodiscard]] const PiecePath& path() const { return path_; }
  /// Upper bound of the distance of a flat triangle on this piece.
  ///
  /// Guarantee: Flatness::error, rounding included, for exactly these corners; it covers every point of the patch
  ///            over the triangle and every point of the triangle.
  /// Requires:  parameters that are multiples of 2^-50 on the piece, exact.
  /// Source:    derivations/tessellation.md.
  [[nodiscard]] Flatness flatness(const FlatTriangle& triangle) const;
  /// Middle of a chord less the curve, between two parameters of the patch, rounded.
  [[nodiscard]] Vector3 bow(TriangleParameter a, TriangleParameter b) const;

 private:
  [[nodiscard]] Vector3 from_origin(TriangleParameter local) const;

  PiecePath path_;
  Point3 origin_;
  Vector3 u_, v_, uu_, uv_, vv_;
  double error_ = 0, size_ = 0;  // size_: sum of the largest coordinates of the vectors
};

}  // namespace snug
