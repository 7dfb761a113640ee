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
  /// Lower bound of their distance where positive, in the query's units, and not below that of what they are
  /// parts of; else the more negative the deeper they overlap.
  float gap;

  /// Are both patches, or pieces of patches?
  [[nodiscard]] bool bounded() const { return nodes[0].bounded() && nodes[1].bounded(); }
};

/// The way down the trees of two placed surfaces: which node of a pair is opened, and what it opens to.
class PairWalk {
 public:
  PairWalk(PairFrames& frames, SearchStats& stats, WideNode::Gaps gaps);

  /// The whole surfaces, which are not compared.
  [[nodiscard]] NodePair roots() const;
  /// Upper bound of the size of a node, placed.
  [[nodiscard]] float size(const NodePair& pair, std::size_t side) const {
    return scale_[side] * pair.nodes[side].size();
  }

  /// The side to be opened next: the larger one, of a tree or of pieces, so that no large piece is compared
  /// with many small ones.
  enum class Opening : std::uint8_t { none, a, b };
  /// none: neither can be opened.
  [[nodiscard]] Opening opening(const NodePair& pair) const;
  /// May a query with this budget of splits open this node? Not if its memory is full, either.
  [[nodiscard]] bool may_open(const NodePair& pair, Opening opening, std::uint64_t budget) const {
    const Node& node = pair.nodes[opening == Opening::a ? 0 : 1];
    return !node.bounded() ||
           (stats_.splits < budget && !frames_.workspace(0).full() && !frames_.workspace(1).full());
  }
  /// Opens one node of a pair: child pairs with a gap of at most `prune_distance` are added to `out`, the one with
  /// the smallest gap last. Returns the smallest gap of the others; infinite if there are none.
  /// Requires:  an opening that is not none.
  float open(const NodePair& pair, Opening opening, double prune_distance, std::vector<NodePair>& out);

 private:
  PairFrames& frames_;
  SearchStats& stats_;
  WideNode::Gaps gaps_;
  std::array<float, 2> scale_;
};

}  // namespace snug
