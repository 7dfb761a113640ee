#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include <snug/search/pair_walk.h>

namespace snug {

/// The pairs of patches of two placed surfaces that may be within a distance, one after another: depth first, what overlaps
/// most deeply first. A loop of its own beside PairWalk, which it goes before: nodes are placed in single precision, pairs on
/// its stack are two names, and the next pair stays in registers.
///
/// Guarantee: pairs that it does not hand out are farther apart than the distance, and at least others() apart.
/// Source:    derivations/boxes.md, "A walk in single precision".
class NearPairs {
 public:
  /// `distance` in the query's units.
  NearPairs(PairFrames& frames, SearchStats& stats, double distance);

  /// False where single precision says too little: for surfaces of very different sizes, or far from their origins.
  [[nodiscard]] bool usable() const { return usable_; }
  /// The next pair; false at the end.
  [[nodiscard]] bool next(NodePair& pair);
  /// Lower bound, in the query's units, of the distance of the pairs that were passed over.
  [[nodiscard]] double others() const { return others_; }

 private:
  // A box of a node: its place, and the leaf if it is a patch.
  struct Name {
    const WideNode* boxes;
    std::uint32_t place;
    std::uint32_t leaf;
    [[nodiscard]] bool is_patch() const { return leaf != none; }
    [[nodiscard]] float size() const { return boxes->size_of(place); }
    [[nodiscard]] Node node() const {
      return {boxes, static_cast<std::uint8_t>(place), is_patch() ? Node::Kind::patch : Node::Kind::tree,
              is_patch() ? leaf : 0};
    }
  };
  using Names = std::array<Name, 2>;
  static constexpr std::uint32_t none = UINT32_MAX;

  // Opens a box; its most deeply overlapping child takes its place, the others go on the stack. False if none is near.
  bool open(Names& pair, std::size_t side);
  void push(const Names& pair) {
    if (waiting_ < stack_.size()) {
      stack_[waiting_++] = pair;
    } else {
      push_beyond(pair);
    }
  }
  void push_beyond(const Names& pair);
  Names pop();

  SearchStats& stats_;
  std::array<const SurfaceBvh*, 2> model_;
  std::array<TreeView, 2> view_;
  std::array<float, 2> distance_{}, to_query_{};
  float ratio_ = 1;
  float others_ = INFINITY;
  bool usable_ = true;
  // Seven children a level of either tree wait at most; more than these only in trees that are far from balanced.
  std::array<Names, 160> stack_;
  std::vector<Names> more_;
  std::size_t waiting_ = 0;
};

}  // namespace snug
