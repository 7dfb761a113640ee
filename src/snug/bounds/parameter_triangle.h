#pragma once

#include <array>
#include <cstddef>

namespace snug {

/// Corners of a piece in the parameters of the patch it is of, as weights of the patch's corners: halves of
/// halves, without rounding for the first 24 levels.
using ParameterTriangle = std::array<std::array<double, 3>, 3>;

inline constexpr ParameterTriangle whole_patch{{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};

/// Child 0 to 2 keeps that corner, in its place; 3 is the middle one, its corner k facing corner k.
[[nodiscard]] ParameterTriangle child_of(const ParameterTriangle& triangle, std::size_t child);
/// The same with corner `first` as corner 0.
[[nodiscard]] ParameterTriangle turned(const ParameterTriangle& triangle, std::size_t first);
/// Part 0 or 1 of those that the line from corner 1 to the middle of the edge 02 makes (scheme/bezier.h).
[[nodiscard]] ParameterTriangle part_of(const ParameterTriangle& triangle, std::size_t part);

/// Weights of the six Bezier points of a quadratic triangle over the patch, corners and then middles of the
/// edges 01, 12, 20.
using QuadraticWeights = std::array<double, 6>;

/// Of these the quadratic over a piece, raised to a higher degree.
class RaisedQuadratic {
 public:
  /// Requires:  degree at least 2.
  RaisedQuadratic(const ParameterTriangle& piece, std::size_t degree);
  /// The Bezier point u^i v^j.
  /// Guarantee: not negative; each is off by at most 16 roundoffs of itself.
  /// Requires:  i + j at most the degree.
  [[nodiscard]] QuadraticWeights point(std::size_t i, std::size_t j) const;

 private:
  std::size_t degree_;
  std::array<QuadraticWeights, 6>
      polar_;  // of each corner twice, and of two corners: 0 and 0, 0 and 1, 1 and 1 ...
};
/// The same of degree 3 in each direction over a parallelogram: (i, j) of 3 from its first corner to the second and
/// to the third.
[[nodiscard]] QuadraticWeights raised_quadratic(const ParameterTriangle& corners, std::size_t i,
                                                std::size_t j);

}  // namespace snug
