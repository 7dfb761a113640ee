#pragma once

#include <memory>
#include <mutex>
#include <span>
#include <vector>

#include <snug/bvh/carried_axes.h>
#include <snug/bvh/wide_bvh.h>
#include <snug/run.h>
#include <snug/surface/control_nets.h>

namespace snug {

/// How the tree of a surface is made anew when its control points have moved: which patches lie together,
/// what their boxes are fitted to, and which points carry the boxes' axes. Immutable; made from one position
/// of the points, right for all.
/// Cost:      a tree's; some 110 bytes a patch.
class RefitPlan {
 public:
  /// Requires:  one patch or more, all there.
  RefitPlan(const LimitSurface& surface, std::vector<PatchId> patches, int threads,
            const WorkMonitor& monitor = {});

  [[nodiscard]] const std::vector<PatchId>& patches() const { return patches_; }
  /// Which of them lie together; without boxes.
  [[nodiscard]] const WideBvh& order() const { return order_; }

  /// Makes the boxes of a tree in this order anew, around the surface as it is.
  /// Returns how large they are for the patches in them: a ratio that no motion of the whole changes.
  double refit(const LimitSurface& surface, WideBvh& tree) const;
  /// That ratio where the plan was made.
  [[nodiscard]] double looseness() const { return looseness_; }
  [[nodiscard]] std::size_t bytes() const;

 private:
  using Carriers = std::array<VertexId, 3>;
  struct Carried {
    CarriedAxes axes;
    Carriers by;
  };
  [[nodiscard]] static Carried carry(const LimitSurface& surface, const Axes& axes,
                                     std::span<const VertexId> by);
  [[nodiscard]] static Axes axes_of(const LimitSurface& surface, const Carried& carried);

  std::vector<PatchId> patches_;
  WideBvh order_;
  ControlNets nets_;                     // of the leaves
  std::vector<Carried> leaves_, nodes_;  // by number, and by name
  double looseness_ = 0;
};

/// The plan that the frames of one moving surface share, made when the first of them needs a tree, and anew
/// when boxes have become much larger than where it was made. Thread-safe.
class SharedPlan {
 public:
  [[nodiscard]] std::shared_ptr<const RefitPlan> get() const {
    const std::lock_guard lock(mutex_);
    return plan_;
  }
  void set(std::shared_ptr<const RefitPlan> plan) {
    const std::lock_guard lock(mutex_);
    plan_ = std::move(plan);
  }

 private:
  mutable std::mutex mutex_;
  std::shared_ptr<const RefitPlan> plan_;
};

}  // namespace snug
