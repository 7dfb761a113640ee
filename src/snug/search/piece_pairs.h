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
  std::array<PieceId, 2> ids;
  std::array<Triangle, 2> base;
  std::array<double, 2> radii;
  NearestTriangles near;
  double gap;  ///< lower bound of their distance, zero if none shows
  /// From the nearest point of A's base triangle to that of B's.
  [[nodiscard]] Vector3 direction() const;
};

/// Limit points of A and of B, placed, and an upper bound of the distance of the exact ones.
struct Witness {
  std::array<Point3, 2> points;
  double error = 0;  ///< upper bound, a coordinate, of |point - exact point|
  double distance = INFINITY;
  std::array<PieceId, 2> pieces;        ///< that they lie on
  std::array<TriangleParameter, 2> at;  ///< and where there
};

/// Pieces of two placed surfaces against each other: their base triangles, their hulls, their limit points.
class PiecePairs {
 public:
  PiecePairs(PairFrames& frames, SearchStats& stats) : frames_(frames), stats_(stats) {}

  /// Sum of the two radii, placed.
  /// Requires:  pair.of_pieces(), here and below.
  [[nodiscard]] double radii(const NodePair& pair) const;
  [[nodiscard]] PiecePair nearest(const NodePair& pair);

  /// Lower bound of the distance of two pieces: that of the planes across `direction` that hold their hulls
  /// apart. The best direction is that from the nearest point of A to that of B.
  [[nodiscard]] double hull_gap(const NodePair& pair, const Vector3& direction);
  /// A direction from A to B, that both the walk and gap_along() look along from now on.
  void look_along(const Vector3& direction);
  /// hull_gap() along the direction of look_along(), where the extents of hulls are kept; zero without one.
  [[nodiscard]] double gap_along(const NodePair& pair);

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
  [[nodiscard]] PieceId piece(const NodePair& pair, std::size_t side) const {
    return frames_.workspace(side).piece(pair.nodes[side]);
  }
  // An upper bound of w . x in a piece of A, a lower bound in one of B, placed.
  [[nodiscard]] double placed_extent(std::size_t side, PieceId piece, const Vector3& w);

  PairFrames& frames_;
  SearchStats& stats_;
  Vector3 along_;
};

}  // namespace snug
