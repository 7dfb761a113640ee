#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <span>

#include <snug/bounds/quadratic.h>
#include <snug/bvh/wide_node.h>
#include <snug/geometry/quadratic_distance.h>
#include <snug/search/piece.h>

namespace snug {

/// Bounds of a piece that queries read without its control points: its offset triangle, and a quadratic Bezier
/// triangle near it. Numbers of single precision relative to an origin, which is its node's, read in double.
/// Guarantee: the radius and both errors cover what rounding to single precision moved.
class PieceBounds {
 public:
  PieceBounds() = default;
  /// Radius and error are infinite where a number is not finite.
  PieceBounds(const OffsetTriangle& offset, const QuadraticTriangle& quadratic, const Point3& origin);

  /// The base triangle of the offset triangle.
  [[nodiscard]] Triangle base(const Point3& origin) const;
  /// Of the offset triangle.
  [[nodiscard]] double radius() const { return static_cast<double>(radius_); }

  /// The quadratic at a parameter, relative to the origin.
  /// Guarantee: the piece's point there is within error(), a length; rounding included.
  [[nodiscard]] Vector3 at(TriangleParameter at) const;
  /// Its derivatives by u and v, but for roundings.
  [[nodiscard]] std::array<Vector3, 2> derivatives(TriangleParameter at) const;
  /// Its Bezier points, relative to the origin: corners, then middles of the edges 01, 12, 20.
  [[nodiscard]] Vector3 bezier_point(std::size_t k) const { return wide(net_[k]); }
  /// The same points in single precision, three coordinates each; and at least the sum of the sizes of a point's.
  [[nodiscard]] const float* net() const { return net_[0].data(); }
  [[nodiscard]] float reach() const {
    return std::fabs(net_[0][0]) + std::fabs(net_[0][1]) + std::fabs(net_[0][2]) + spread_;
  }
  /// Upper bound of dot(w, x) over the quadratic, x relative to the origin, up to roundings that both errors cover.
  [[nodiscard]] double extent(const Vector3& w) const;
  [[nodiscard]] double error() const { return static_cast<double>(error_); }
  /// Upper bound of |dot(w, x - q)| for a point x of the piece and the quadratic's point q at its parameter.
  /// Requires:  |w| at most about 1.
  [[nodiscard]] double error_along(const Vector3& w) const {
    return snug::error_along(w, normal(), error(), normal_share_ / 255.0 * error());
  }

  /// Bounds of the distance of a point, relative to the origin, from the quadratic. At the parameter it is no more than the
  /// upper one. They are apart by twice `rounding`, 2^-18 of the point's coordinates, of twice the distance and of sixteen
  /// times the piece's extent, and by what sixteen flat triangles are from the quadratic.
  /// Requires:  a finite radius; coordinates of the point at most 2^42.
  /// Cost:      50 ns.
  /// Source:    derivations/closest.md.
  struct QuadraticDistance {
    double lower, upper;
    TriangleParameter at;
    double rounding;  ///< that each of them is off by
  };
  [[nodiscard]] QuadraticDistance distance(const Vector3& point) const;

 private:
  void keep_normal(const QuadraticTriangle& quadratic, double net_moved);
  [[nodiscard]] Vector3 normal() const {
    return (1.0 / 127) * Vector3{static_cast<double>(normal_[0]), static_cast<double>(normal_[1]),
                                 static_cast<double>(normal_[2])};
  }
  using Single3 = std::array<float, 3>;
  [[nodiscard]] static Vector3 wide(const Single3& v) {
    return {static_cast<double>(v[0]), static_cast<double>(v[1]), static_cast<double>(v[2])};
  }

  std::array<Single3, 3> base_{};
  std::array<Single3, 6> net_{};  // of the quadratic: corners, then middles of the edges 01, 12, 20
  float radius_ = 0, error_ = 0;
  // Across the quadratic, times 127, or zero; and a share of the error, times 255, that covers the error along it.
  std::array<std::int8_t, 3> normal_{};
  std::uint8_t normal_share_ = 0;
  // Upper bounds of |quadratic - triangles| and, twice, of |x|_1 for differences of Bezier points from the first.
  float flattening_ = 0, spread_ = 0;
};

/// Bounds of a piece before its node, and so the origin they are relative to, is made.
struct PieceBuild {
  Obb box;
  OffsetTriangle offset;
  QuadraticTriangle quadratic;
  bool can_split;
};
[[nodiscard]] PieceBuild build_piece(BoundsCache& library, const Patch& patch, BoundMethod method);
/// Many at once, which takes a small part of the time where kinds come again: see fit_pieces(). A piece does not depend on the
/// others.
void build_pieces(BoundsCache& library, std::span<const Patch> patches, BoundMethod method,
                  std::span<PieceBuild> out);
/// The same as fit_sorted_pieces() fits them.
void build_sorted_pieces(BoundsCache& library, std::span<const Patch> patches, BoundMethod method,
                         std::span<PieceBuild> out);

/// The piece, for boxes above its own.
[[nodiscard]] FittedSet fitted_set(const PieceBuild& piece);

/// A node of pieces: boxes around up to N of them, whose names are 1 where a piece can be split, else 0; and their records.
template <std::size_t N>
struct PieceLeaf : WideNode {
  PieceLeaf() = default;
  /// Requires:  1 to N pieces.
  explicit PieceLeaf(std::span<const PieceBuild> pieces);
  std::array<PieceBounds, N> bounds;
};
/// The patches of a leaf of a tree.
using LeafNode = PieceLeaf<WideNode::width>;
/// The pieces that a piece is split into.
using SplitNode = PieceLeaf<4>;

}  // namespace snug
