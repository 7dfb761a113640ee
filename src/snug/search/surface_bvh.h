#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include <snug/base/lazy.h>
#include <snug/monitor.h>
#include <snug/search/solid.h>

namespace snug {

struct SurfaceBvhOptions {
  BoundMethod method = BoundMethod::rows;  ///< of pieces
  /// Bound all patches when the model is made, some microseconds each: a tighter tree, for models that are
  /// asked thousands of times. Otherwise the tree is over the control net alone.
  bool tight = false;
  int threads = 0;  ///< that make it
};

/// A surface made ready for queries: a tree over its control net. Patches are bounded, and split, where and
/// when a query comes near them (SurfaceWorkspace). Immutable; may be read by many threads.
/// Cost:      about 0.3 microseconds and 15 bytes a patch; see bench/results/collide.txt.
class SurfaceBvh {
 public:
  /// Requires:  the surface outlives the model.
  /// Errors:    InputError (refused) if no face has a patch.
  explicit SurfaceBvh(const LimitSurface& surface, const SurfaceBvhOptions& options = {},
                      const WorkMonitor& monitor = {});

  [[nodiscard]] const LimitSurface& surface() const { return *surface_; }
  [[nodiscard]] BoundMethod method() const { return method_; }
  [[nodiscard]] const WideBvh& tree() const { return tree_; }
  /// The patch that the tree calls item i.
  [[nodiscard]] PatchId patch(std::uint32_t item) const { return patches_[item]; }
  /// Around the surface, in mesh units; infinite where that does not fit a double.
  [[nodiscard]] const Ball& ball() const { return ball_; }
  /// The solid that the surface bounds, made on first use.
  /// Errors:    InputError (refused) for a surface that is not closed.
  [[nodiscard]] const Solid& solid() const;
  /// Without the surface.
  [[nodiscard]] std::size_t bytes() const;

 private:
  const LimitSurface* surface_;
  BoundMethod method_;
  std::vector<PatchId> patches_;
  WideBvh tree_;
  Ball ball_;
  std::unique_ptr<Lazy<Solid>> solid_;
};

}  // namespace snug
