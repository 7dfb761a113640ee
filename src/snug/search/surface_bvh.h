#pragma once

#include <atomic>
#include <cstdint>
#include <memory>
#include <mutex>
#include <vector>

#include <snug/bvh/wide_bvh.h>
#include <snug/run.h>
#include <snug/search/piece_leaf.h>
#include <snug/search/refit_plan.h>
#include <snug/search/solid.h>
#include <support/lazy.h>

namespace snug {

struct SurfaceBvhOptions {
  BoundMethod method = BoundMethod::rows;  ///< of pieces
  /// Bound all patches when the model is made, some microseconds each: a tighter tree, for models that are
  /// asked thousands of times. Otherwise the tree is over the control net, and patches are bounded where
  /// queries come.
  bool tight = false;
  int threads = 0;  ///< that make it
  /// A tree over the control net of so many patches or more is itself made where queries come, in parts of so
  /// many levels; one of fewer takes some milliseconds.
  std::size_t min_lazy = 8192;
  unsigned part_level = 2;
  /// A surface that moves gets another plan where boxes are so many times as large for their patches as they
  /// were where the plan was made.
  double max_looser = 1.5;
};

/// A surface made ready for queries: a tree down to its patches, parts and leaves of which are made where
/// they are not yet. Nothing else ever changes, but by refit(); may be read by many threads.
/// Cost:      about 0.6 microseconds and 15 bytes a patch, and 200 bytes a patch that a query came near; of
///            large models 0.1 and 40, and 0.6 a patch that a query came near. See bench/results/bars.txt.
class SurfaceBvh {
 public:
  /// Requires:  the surface outlives the model.
  /// Errors:    InputError (refused) if no face has a patch.
  explicit SurfaceBvh(const LimitSurface& surface, const SurfaceBvhOptions& options = {},
                      const WorkMonitor& monitor = {});
  /// The same for a surface that moves: by the plan that its frames share, made anew if need be.
  SurfaceBvh(const LimitSurface& surface, const SurfaceBvhOptions& options, SharedPlan& plan);
  /// After the surface has moved. Keeps its memory. Nobody else may use the model meanwhile.
  void refit(SharedPlan& plan);

  [[nodiscard]] const LimitSurface& surface() const { return *surface_; }
  [[nodiscard]] BoundMethod method() const { return options_.method; }
  [[nodiscard]] const WideBvh& tree() const { return tree_; }
  /// Bounds of the patches of a leaf, made on first use.
  [[nodiscard]] const LeafNode& leaf(std::uint32_t i) const {
    const LeafNode* const ready = leaves_->find(i);
    return ready != nullptr ? *ready : make_leaf(i);
  }
  /// The tree for a walk, seen from nowhere yet.
  [[nodiscard]] kernels::WalkedTree walked() const {
    kernels::WalkedTree tree = tree_.walked();
    tree.leaves = leaves_->nodes();
    return tree;
  }
  /// The patch at a place in a leaf.
  [[nodiscard]] PatchId patch(std::uint32_t leaf, std::size_t place) const {
    return patches_[tree_.leaf(leaf)[place]];
  }
  /// Around the surface, in mesh units; infinite where that does not fit a double.
  [[nodiscard]] const Ball& ball() const { return ball_; }
  /// A box around it, likewise.
  [[nodiscard]] const Obb& box() const { return box_; }
  /// The solid that the surface bounds, made on first use.
  /// Errors:    InputError (refused) for a surface that is not closed.
  [[nodiscard]] const Solid& solid() const;
  /// Without the surface.
  [[nodiscard]] std::size_t bytes() const;

 private:
  // A node for each leaf of the tree, null where not made.
  class Leaves {
   public:
    explicit Leaves(std::size_t leaf_count) : nodes_(leaf_count) {}
    ~Leaves();
    [[nodiscard]] const LeafNode* find(std::uint32_t i) const {
      return static_cast<const LeafNode*>(nodes_[i].load(std::memory_order_acquire));
    }
    [[nodiscard]] const std::atomic<kernels::NodeBoxes*>* nodes() const { return nodes_.data(); }
    const LeafNode& keep(std::uint32_t i, std::span<const PieceBuild> pieces);
    // Back to none; keeps their memory.
    void clear();
    [[nodiscard]] std::size_t bytes() const;

   private:
    [[nodiscard]] LeafNode* unused();

    std::vector<std::atomic<kernels::NodeBoxes*>> nodes_;
    mutable std::mutex mutex_;
    std::vector<std::unique_ptr<LeafNode>> unused_;
    std::size_t count_ = 0;  // of those made, be they in use or not
  };
  [[nodiscard]] std::span<const PieceBuild> piece_builds(std::span<const std::uint32_t> items) const;
  [[nodiscard]] WideBvh make_tree(const WorkMonitor& monitor);
  [[nodiscard]] WideBvh make_tight_tree(const WorkMonitor& monitor);
  const LeafNode& make_leaf(std::uint32_t i) const;
  void find_extents();

  const LimitSurface* surface_;
  SurfaceBvhOptions options_;
  std::shared_ptr<const RefitPlan> plan_;  // that tree_ has its order from; null where it was built
  std::vector<PatchId> patches_;
  std::unique_ptr<Leaves> leaves_;
  WideBvh tree_;
  Ball ball_;
  Obb box_;
  std::unique_ptr<Lazy<Solid>> solid_;
};

}  // namespace snug
