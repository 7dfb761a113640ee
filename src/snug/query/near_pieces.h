#pragma once

#include <algorithm>
#include <atomic>
#include <optional>
#include <span>
#include <vector>

#include <snug/search/piece_set.h>
#include <support/parallel.h>
#include <support/run.h>

namespace snug {

/// The quadratics that facets are kept off. All together would take a third of the memory: they are made where they are looked at, for
/// a few patches that lie together at a time.
class NearPieces {
 public:
  /// Errors are at most `error`, in scaled units, where refine() does not make them less.
  /// Requires:  surface and `run` outlive it.
  NearPieces(const LimitSurface& surface, double error, const Run& run);

  /// Calls visit(set, box) for sets of pieces in boxes for which is_near(box): on several threads, and not for all of them if
  /// there are too many; then it is false.
  template <class IsNear, class Visit>
  [[nodiscard]] bool visit(const IsNear& is_near, const Visit& visit) {
    std::atomic<std::uint64_t> count{0};
    parallel_for(boxes_.size(), run_.threads, [&](std::size_t begin, std::size_t end) {
      for (std::size_t b = begin; b < end; ++b) {
        run_.monitor->checkpoint();
        if ((boxes_[b] && !is_near(*boxes_[b])) || count.load(std::memory_order_relaxed) > max_) continue;
        const std::size_t first = b * patches_.size() / boxes_.size(),
                          last = (b + 1) * patches_.size() / boxes_.size();
        PieceSet set(surface_, std::span(patches_).subspan(first, last - first), error_, finer_, 1,
                     *run_.monitor, max_);
        count.fetch_add(set.size() > 0 ? set.size() : max_ + 1, std::memory_order_relaxed);
        if (set.size() == 0) continue;
        set.prepare(1);
        boxes_[b] = set.box();
        if (is_near(*boxes_[b])) visit(set, *boxes_[b]);
      }
    });
    return count.load() <= max_;
  }
  /// To be made finer. Those that are marked, each once, in their order.
  void mark(const std::vector<PieceName>& pieces);
  [[nodiscard]] const std::vector<PieceName>& marked();
  void refine(double error);

 private:
  static constexpr std::size_t max_blocks = 16;

  const LimitSurface& surface_;
  double error_;
  const Run& run_;
  std::uint64_t max_;
  std::vector<PatchId> patches_;            // block by block
  std::vector<std::optional<Box3>> boxes_;  // of the blocks, once they are known
  PieceSet::FinerPieces finer_;
  std::vector<PieceName> marked_;
};

}  // namespace snug
