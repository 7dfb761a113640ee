#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include <snug/geometry/triangle_distance.h>
#include <snug/search/surface_bvh.h>
#include <snug/surface/evaluate.h>

namespace snug {

/// What a query did.
struct SearchStats {
  std::uint64_t box_tests = 0;       ///< of sets in trees
  std::uint64_t triangle_tests = 0;  ///< of base triangles
  std::uint64_t evaluations = 0;     ///< of limit points, pairs of them
  std::uint64_t splits = 0;          ///< of pieces, each time one is opened
};

/// Where two witnesses lie on their surfaces, of A and of B; nothing for one that is a point of the other surface alone.
using WitnessPlaces = std::array<std::optional<SurfaceParameter>, 2>;

/// Two nodes, of A and of B.
struct NodePair {
  std::array<Node, 2> nodes;
  std::array<float, 2> sizes;  ///< upper bounds of the nodes' sizes, placed
  /// Lower bound of their distance where positive, in the search's units, and not below that of what they are parts of; else
  /// the more negative the deeper they overlap.
  float gap;
};

/// Of the pairs from the place `from` on, brings the one with the smallest gap to the end.
void nearest_last(std::vector<NodePair>& pairs, std::size_t from);

/// Lower bound, in mesh units, of the distance of two placed models, by balls and boxes around them: cheap. Not positive
/// where none shows, or where doubles do not reach.
[[nodiscard]] double outer_gap(const PlacedBvh& a, const PlacedBvh& b);

/// What queries between two placed models share: frames, comparisons of nodes and of pieces, limit points. Lengths are in
/// units of its own, powers of two away from mesh units, in which both placed models are at most about 2 large and far.
class PairSearch {
 public:
  /// Errors:    InputError (value) unless models have the same sort of volume, and each a scratch of its own.
  PairSearch(const PlacedBvh& a, const PlacedBvh& b);

  /// From mesh units; a lower bound and an upper bound of the exact length.
  [[nodiscard]] double length_down(double mesh_units) const;
  [[nodiscard]] double length_up(double mesh_units) const;
  [[nodiscard]] PowerOfTwo to_mesh_units() const { return world_.inverse(); }

  /// The whole models, which are not compared.
  [[nodiscard]] NodePair roots() const;

  [[nodiscard]] bool pieces(const NodePair& pair) const { return pair.nodes[0].piece && pair.nodes[1].piece; }
  /// Which nodes of a pair are to be opened next: the larger one, or both if they are about as large.
  enum class Opening : std::uint8_t { none, a, b, both };
  /// sparing: a node that opens to pieces, which may have to be bounded first, is opened alone.
  enum class Bounding : std::uint8_t { sparing, eager };
  /// none: neither can be opened.
  [[nodiscard]] Opening opening(const NodePair& pair, Bounding bounding) const;
  /// What nodes open to, against each other: pairs with a gap of at most `most` are added to `out`.
  /// Returns:   the smallest gap of the others; infinite if there are none.
  /// Requires:  not none.
  float open(const NodePair& pair, Opening opening, double most, std::vector<NodePair>& out);

  /// Gaps are looked for along this direction first, from A to B: one that holds much of both apart.
  void look_along(const Vector3& direction);

  /// May a query that may open so many pieces open these nodes? Not if it has taken as much memory as it may, either.
  [[nodiscard]] bool may_open(const NodePair& pair, Opening opening, std::uint64_t budget) const {
    const std::uint64_t pieces = (opening != Opening::b && pair.nodes[0].piece ? 1u : 0u) +
                                 (opening != Opening::a && pair.nodes[1].piece ? 1u : 0u);
    return stats.splits + pieces <= budget && !scratch_[0]->full() && !scratch_[1]->full();
  }

  /// Two pieces, their base triangles as placed.
  struct Pieces {
    std::array<PieceId, 2> ids;
    std::array<Triangle, 2> base;  ///< as placed
    std::array<double, 2> radii;   ///< as placed
    NearestTriangles near;
    double gap;  ///< lower bound of their distance, zero if none shows
    /// From the nearest point of A's base triangle to that of B's.
    [[nodiscard]] Vector3 direction() const;
  };
  [[nodiscard]] PieceId piece(const NodePair& pair, std::size_t side) const {
    return scratch_[side]->piece(pair.nodes[side]);
  }
  /// Sum of the two radii, placed.
  [[nodiscard]] double radii(const NodePair& pair) const;
  [[nodiscard]] Pieces nearest_pieces(const NodePair& pair);

  /// Lower bound of the distance of two pieces: that of the planes across `direction` that hold their hulls apart. Any
  /// direction gives one; the best is that from the nearest point of A to that of B.
  [[nodiscard]] double hull_gap(const NodePair& pair, const Vector3& direction);
  /// The same along the direction of look_along(), where hulls end being kept; zero without one.
  [[nodiscard]] double gap_along(const NodePair& pair);

  /// Limit points, placed, and an upper bound of the distance of the exact ones.
  struct Witness {
    std::array<Point3, 2> points;
    double error = 0;  ///< upper bound, a coordinate, of |point - exact point|
    double distance = INFINITY;
    std::array<PieceId, 2> pieces;        ///< that they lie on
    std::array<TriangleParameter, 2> at;  ///< and where there
  };
  /// Where the points of a witness of this search lie.
  [[nodiscard]] WitnessPlaces places(const Witness& witness) const;
  /// At the parameters where the base triangles are nearest.
  [[nodiscard]] Witness witness(const Pieces& pieces);

  /// Is it proved that the two pieces, or smaller ones around where their base triangles are nearest, cross each other?
  /// Source:    derivations/contact.md.
  [[nodiscard]] bool certainly_cross(const Pieces& pieces);

  [[nodiscard]] SurfaceWorkspace& scratch(std::size_t side) const { return *scratch_[side]; }
  [[nodiscard]] const PlacedFrame& frame(std::size_t side) const { return frame_[side]; }
  /// How the other side is seen from the frame of `side`.
  [[nodiscard]] const RelativeFrame& seen_from(std::size_t side) { return view(side).frame; }
  SearchStats stats;

 private:
  [[nodiscard]] Point3 placed(std::size_t side, const Point3& p, double& error) const;
  // An upper bound of w . x in a piece of A, a lower bound in one of B, placed.
  [[nodiscard]] double end(std::size_t side, PieceId piece, const Vector3& w);
  float open_both(const NodePair& pair, double most, std::vector<NodePair>& out);
  float open_one(const NodePair& pair, std::size_t side, double most, std::vector<NodePair>& out);
  Blocks::Near find_gaps(std::size_t side, std::uint32_t block, const Blocks& blocks, Node other, double most,
                         Blocks::Distances& out);
  [[nodiscard]] const View& view(std::size_t side) {
    if (!viewed_[side]) {
      view_[side] = View(volume_, frame_[side], frame_[1 - side]);
      viewed_[side] = true;
    }
    return view_[side];
  }

  std::array<SurfaceWorkspace*, 2> scratch_;
  PowerOfTwo world_;
  std::array<PlacedFrame, 2> frame_;
  std::array<float, 2> scale_;
  Volume volume_;
  std::array<View, 2> view_;  // made on first use
  std::array<bool, 2> viewed_{};
  Vector3 along_;
};

}  // namespace snug
