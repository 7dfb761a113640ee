#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include <snug/geometry/rounding.h>
#include <snug/geometry/triangle_distance.h>
#include <snug/search/pair_walk.h>
#include <snug/surface/evaluate.h>
#include <snug/surface/unscale.h>

namespace snug {

/// Two pieces, of A and of B, and their base triangles as placed.
struct PiecePair {
  std::array<Node, 2> nodes;
  std::array<Triangle, 2> base;
  std::array<double, 2> radii;
  NearestTriangles near;
  double gap;  ///< lower bound of their distance, zero if none shows
  /// Points of the quadratics, at first where the base triangles are nearest, and the vector from A's to B's.
  std::array<TriangleParameter, 2> at;
  std::array<Point3, 2> points;
  Vector3 between;
  /// Upper bounds of the distance of a point from the limit point it stands for, and of the distance of the
  /// limit points.
  double error = 0, near_distance = INFINITY;
};

/// Limit points of A and of B, placed, and an upper bound of the distance of the exact ones.
struct Witness {
  std::array<Point3, 2> points;
  double error = 0;  ///< upper bound, a coordinate, of |point - exact point|
  double distance = INFINITY;
  std::array<Node, 2> nodes;            ///< that they lie on
  std::array<TriangleParameter, 2> at;  ///< and where there
};

/// Pieces of two placed surfaces against each other: their base triangles, their quadratics, their limit
/// points.
class PiecePairs {
 public:
  PiecePairs(PairFrames& frames, SearchStats& stats)
      : frames_(frames),
        stats_(stats),
        placing_error_{frames.frame(0).largest_apply_error(), frames.frame(1).largest_apply_error()} {}

  /// Where the base triangles of two pieces are nearest, with points of their quadratics there.
  /// Requires:  pair.bounded(), here and below.
  [[nodiscard]] PiecePair nearest(const NodePair& pair);
  /// True when single-precision rounding dominates the remaining gap: one piece cannot be split, and the other one
  /// is known as well.
  [[nodiscard]] static bool at_single_precision(const NodePair& pair);
  /// The same as nearest() from offset triangles in double precision, which are made anew, with limit points.
  [[nodiscard]] PiecePair nearest_in_double(const NodePair& pair);
  /// Moves the points on the quadratics to where these are about nearest.
  void approach(PiecePair& pieces) const;
  /// Moves them by a Newton step to where `between`, the vector from A's to B's or that of their limit points, is about zero.
  /// Stays where the pieces are parallel.
  void step_together(PiecePair& pieces, const Vector3& between) const;

  /// Lower bound of the distance of two pieces: that of the planes across `direction` that hold their
  /// quadratics apart, less what these err. The best direction is that from the nearest point of A to that of
  /// B.
  [[nodiscard]] double gap_along(const std::array<Node, 2>& nodes, const Vector3& direction) const;
  /// The same along one direction for many pairs, with extents of pieces cached; zero before look_along(). The walk
  /// uses it, too.
  void look_along(const Vector3& direction);
  [[nodiscard]] double gap_along(const std::array<Node, 2>& nodes);

  /// The limit points at the pair's parameters, or the quadratics' own.
  [[nodiscard]] Witness witness(const PiecePair& pieces);
  [[nodiscard]] static Witness approximate_witness(const PiecePair& pieces);
  /// Writes a witness of this query to a Collision or a Distance, in mesh units.
  template <class Answer>
  void write_to(const Witness& witness, Answer& answer) const {
    answer.witness = limit_points(witness);
  }

 private:
  [[nodiscard]] PiecePair nearest(const NodePair& pair, const std::array<OffsetTriangle, 2>& offsets);
  [[nodiscard]] Point3 quadratic_point(const PiecePair& pieces, std::size_t side, TriangleParameter at) const;
  // Takes points of the quadratics at pieces.at.
  void set_points(PiecePair& pieces) const;
  [[nodiscard]] WitnessPoints limit_points(const Witness& witness) const;
  // An upper bound of w . x in a piece, placed, for |w| <= 1 up to a few roundings.
  [[nodiscard]] double placed_extent(std::size_t side, const Node& node, const Vector3& w) const;

  PairFrames& frames_;
  SearchStats& stats_;
  std::array<double, 2> placing_error_;        // a coordinate, of any point of a surface
  Vector3 along_;                              // of length 1, or zero
  std::array<std::uint64_t, 2> directions_{};  // its numbers in the caches
};

}  // namespace snug
