#pragma once

#include <array>
#include <cstdint>

#include <snug/collide.h>
#include <snug/search/pair_frames.h>

namespace snug {

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

  /// Whether a query with this budget of splits may open a pair.
  enum class May : std::uint8_t {
    open,
    not_open,  ///< neither node can be opened
    end,       ///< the budget is spent, or the query's memory full
  };
  [[nodiscard]] May may(const NodePair& pair, std::uint64_t budget) const;
  /// Opens the larger node, of a tree or of pieces, so that no large one is compared with many small ones. Child pairs with a gap of
  /// at most `prune_distance` are added to `out`, the one with the smallest gap last. Returns the smallest gap of the others;
  /// infinite if there are none.
  /// Requires:  a node that can be opened.
  float open(const NodePair& pair, double prune_distance, Frontier<NodePair>& out);

 private:
  static constexpr std::size_t neither = 2;
  [[nodiscard]] std::size_t side_to_open(const NodePair& pair) const;

  PairFrames& frames_;
  SearchStats& stats_;
  WideNode::Gaps gaps_;
  std::array<float, 2> scale_;
};

}  // namespace snug
