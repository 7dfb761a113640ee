#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include <snug/enclose/triangle_distance.h>
#include <snug/query/query_model.h>

namespace snug {

/// What a query did.
struct QueryStats {
  std::uint64_t box_tests = 0;       ///< of sets in trees
  std::uint64_t triangle_tests = 0;  ///< of base triangles
  std::uint64_t evaluations = 0;     ///< of limit points, pairs of them
  std::uint64_t splits = 0;          ///< of pieces, each time one is opened
};

/// Two nodes, of A and of B.
struct NodePair {
  std::array<Node, 2> nodes;
  std::array<float, 2> sizes;  ///< upper bounds of the nodes' sizes, placed
  /// Lower bound of their distance where positive, in the search's units, and not below that of what they are parts of; else
  /// the more negative the deeper they overlap.
  float gap;
};

/// Lower bound, in mesh units, of the distance of two placed models, by balls and boxes around them: cheap. Not positive
/// where none shows, or where doubles do not reach.
/// Requires:  rigid placements.
[[nodiscard]] double outer_gap(const PlacedModel& a, const PlacedModel& b);

/// What queries between two placed models share: frames, comparisons of nodes and of pieces, limit points. Lengths are in
/// units of its own, powers of two away from mesh units, in which both placed models are at most about 2 large and far.
class PairSearch {
 public:
  /// Requires:  rigid placements (require_rigid), models with the same sort of volume, two scratches.
  PairSearch(const PlacedModel& a, const PlacedModel& b);

  /// From mesh units; a lower bound and an upper bound of the exact length.
  [[nodiscard]] double length_down(double mesh_units) const;
  [[nodiscard]] double length_up(double mesh_units) const;
  [[nodiscard]] PowerOfTwo to_mesh_units() const { return world_.inverse(); }

  /// The whole models.
  [[nodiscard]] NodePair roots();

  [[nodiscard]] bool pieces(const NodePair& pair) const { return pair.nodes[0].piece && pair.nodes[1].piece; }
  /// The side whose node is larger among those that can be opened; nothing if neither can.
  [[nodiscard]] std::optional<std::size_t> side_to_open(const NodePair& pair) const;
  /// What the node of one side opens to, against the other side's node: pairs with a gap of at most `most`, the smallest
  /// gap last, are added to `out`.
  /// Returns:   the smallest gap of the others; infinite if there are none.
  float open(const NodePair& pair, std::size_t side, double most, std::vector<NodePair>& out);

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
  /// The same of their limit corners, in double precision: about the most that hull_gap() can find, and cheap.
  [[nodiscard]] double corner_gap(const NodePair& pair, const Vector3& direction) const;

  /// Limit points, placed, and an upper bound of the distance of the exact ones.
  struct Witness {
    std::array<Point3, 2> points;
    double error = 0;  ///< upper bound, a coordinate, of |point - exact point|
    double distance = INFINITY;
  };
  /// At the parameters where the base triangles are nearest.
  [[nodiscard]] Witness witness(const Pieces& pieces);

  /// Is it proved that the two pieces, or smaller ones around where their base triangles are nearest, cross each other?
  /// Source:    derivations/contact.md.
  [[nodiscard]] bool certainly_cross(const Pieces& pieces);

  [[nodiscard]] QueryScratch& scratch(std::size_t side) const { return *scratch_[side]; }
  [[nodiscard]] const PlacedFrame& frame(std::size_t side) const { return frame_[side]; }
  /// How the other side is seen from the frame of `side`.
  [[nodiscard]] const RelativeFrame& seen_from(std::size_t side) { return view(side).frame; }
  QueryStats stats;

 private:
  [[nodiscard]] Point3 placed(std::size_t side, const Point3& p, double& error) const;

  std::array<QueryScratch*, 2> scratch_;
  void find_gaps(std::size_t side, std::uint32_t block, const Blocks& blocks, Node other, double most,
                 Blocks::Distances& out);
  [[nodiscard]] const View& view(std::size_t side) {
    if (!view_[side]) view_[side].emplace(volume_, frame_[side], frame_[1 - side]);
    return *view_[side];
  }

  PowerOfTwo world_;
  std::array<PlacedFrame, 2> frame_;
  std::array<float, 2> scale_{};
  Volume volume_;
  std::array<std::optional<View>, 2> view_;  // made on first use
};

}  // namespace snug
