#pragma once

#include <array>

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
  /// Between the points of the quadratics where the base triangles are nearest, from A to B.
  Vector3 between;
  double near_distance;  ///< upper bound of the distance of the limit points there
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
  PiecePairs(PairFrames& frames, SearchStats& stats) : frames_(frames), stats_(stats) {}

  /// Sum of the two radii, placed.
  /// Requires:  pair.bounded(), here and below.
  [[nodiscard]] double radii(const NodePair& pair) const;
  [[nodiscard]] PiecePair nearest(const NodePair& pair);
  /// Sum of the errors of the two quadratics, placed.
  [[nodiscard]] double errors(const NodePair& pair) const;

  /// Lower bound of the distance of two pieces: that of the planes across `direction` that hold their
  /// quadratics apart, less what these err. The best direction is that from the nearest point of A to that of
  /// B.
  [[nodiscard]] double gap_along(const std::array<Node, 2>& nodes, const Vector3& direction) const;

  /// At the parameters where the base triangles are nearest.
  [[nodiscard]] Witness witness(const PiecePair& pieces);
  /// What a Collision or a Distance says of a witness of this query, in mesh units.
  template <class Answer>
  void tell(const Witness& witness, Answer& answer) const {
    const PowerOfTwo back = frames_.to_mesh_units();
    answer.witness = {require_representable(back.apply(witness.points[0])),
                      require_representable(back.apply(witness.points[1]))};
    answer.witness_error = unscaled_up(witness.error, back) + underflow_error;
    answer.at = places(witness);
  }

 private:
  // Where its points lie.
  [[nodiscard]] WitnessPlaces places(const Witness& witness) const;
  // An upper bound of w . x in a piece, placed, for |w| <= 1 up to a few roundings.
  [[nodiscard]] double placed_extent(std::size_t side, const Node& node, const Vector3& w) const;

  PairFrames& frames_;
  SearchStats& stats_;
};

}  // namespace snug
