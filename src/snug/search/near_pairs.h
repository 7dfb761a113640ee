#pragma once

#include <array>
#include <vector>

#include <snug/search/pair_walk.h>

namespace snug {

/// The pairs of patches of two placed surfaces that may be within a distance, one after another: depth first, what overlaps
/// most deeply first. A loop of its own beside PairWalk, which it goes before: it is one function for each instruction set,
/// places nodes in single precision, and keeps the next pair in registers.
///
/// Guarantee: pairs that it does not hand out are farther apart than the distance, and at least others() apart.
/// Source:    derivations/boxes.md, "A walk in single precision".
class NearPairs {
 public:
  /// `distance` in the query's units.
  NearPairs(PairFrames& frames, SearchStats& stats, double distance);
  NearPairs(const NearPairs&) = delete;

  /// False where single precision says too little: for surfaces of very different sizes, or far from their origins.
  [[nodiscard]] bool usable() const { return usable_; }
  /// The next pair; false at the end.
  [[nodiscard]] bool next(NodePair& pair);
  /// Lower bound, in the query's units, of the distance of the pairs that were passed over.
  [[nodiscard]] double others() const { return static_cast<double>(walk_.others); }

 private:
  void make_room();

  SearchStats& stats_;
  std::array<const SurfaceBvh*, 2> model_;
  bool usable_ = true;
  kernels::Walk walk_;
  // Seven children a level of either tree wait at most: enough for all but a few walks.
  std::array<kernels::WalkedPair, 48> waiting_;
  std::vector<kernels::WalkedPair> more_waiting_;
};

}  // namespace snug
