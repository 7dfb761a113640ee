#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include <snug/collide.h>
#include <snug/search/pair_frames.h>

namespace snug {

/// Two nodes, of A and of B.
struct NodePair {
  std::array<Node, 2> nodes;
  std::array<float, 2> sizes;  ///< upper bounds of the nodes' sizes, placed
  /// Lower bound of their distance where positive, in the query's units, and not below that of what they are
  /// parts of; else the more negative the deeper they overlap.
  float gap;

  [[nodiscard]] bool of_pieces() const { return nodes[0].piece && nodes[1].piece; }
};

/// Of the pairs from the place `from` on, brings the one with the smallest gap to the end.
void nearest_last(std::vector<NodePair>& pairs, std::size_t from);

/// The way down the trees of two placed surfaces: which node of a pair is opened, and what it opens to.
class PairWalk {
 public:
  PairWalk(PairFrames& frames, SearchStats& stats);

  /// The whole surfaces, which are not compared.
  [[nodiscard]] NodePair roots() const;

  /// Which nodes of a pair are to be opened next: the larger one, or both if they are about as large.
  enum class Opening : std::uint8_t { none, a, b, both };
  /// sparing: a node that opens to pieces, which may have to be bounded first, is opened alone.
  enum class Bounding : std::uint8_t { sparing, eager };
  /// none: neither can be opened.
  [[nodiscard]] Opening opening(const NodePair& pair, Bounding bounding) const;
  /// May a query with this budget of pieces open these nodes? Not if its memory is full, either.
  [[nodiscard]] bool may_open(const NodePair& pair, Opening opening, std::uint64_t budget) const {
    const std::uint64_t pieces = (opening != Opening::b && pair.nodes[0].piece ? 1u : 0u) +
                                 (opening != Opening::a && pair.nodes[1].piece ? 1u : 0u);
    return stats_.splits + pieces <= budget && !frames_.workspace(0).full() && !frames_.workspace(1).full();
  }
  /// What nodes open to, against each other: pairs with a gap of at most `prune_distance` are added to `out`.
  /// Returns the smallest gap of the others; infinite if there are none.
  /// Requires:  an opening that is not none.
  float open(const NodePair& pair, Opening opening, double prune_distance, std::vector<NodePair>& out);

 private:
  SurfaceWorkspace::Opened open_node(const NodePair& pair, std::size_t side);
  float open_both(const NodePair& pair, double prune_distance, std::vector<NodePair>& out);
  float open_one(const NodePair& pair, std::size_t side, double prune_distance, std::vector<NodePair>& out);

  PairFrames& frames_;
  SearchStats& stats_;
  std::array<float, 2> scale_;
};

}  // namespace snug
