#pragma once

#include <functional>
#include <memory>
#include <span>
#include <vector>

#include <snug/query/collide.h>
#include <snug/query/distance.h>

/// Many poses of one pair of models: what each thread has found out about pieces is of use for its next pose.
namespace snug {

/// Scratch memory of two models, one pair a thread.
class PairWorkspaces {
 public:
  /// `threads`: 0 for all cores.
  /// Requires:  the models outlive it.
  PairWorkspaces(const SurfaceBvh& a, const SurfaceBvh& b, int threads = 0);

  [[nodiscard]] std::size_t bytes() const;

  /// Asks about one pose of the two models.
  using Ask = std::function<void(SurfaceWorkspace& a, SurfaceWorkspace& b, std::size_t pose)>;
  /// Calls `ask` for each number in [0, count), on the threads, no two at once with the same pair of workspaces.
  ///
  /// Errors:    what `ask` throws ends the loop and is thrown again, of several one.
  void for_each(std::size_t count, const Ask& ask, const WorkMonitor& monitor = {});

 private:
  struct Pair {
    Pair(const SurfaceBvh& in_a, const SurfaceBvh& in_b) : a(in_a), b(in_b) {}
    SurfaceWorkspace a, b;
  };
  std::vector<std::unique_ptr<Pair>> pairs_;
};

/// What collide() answers for each pose, in their order.
///
/// Guarantee: the same bits as from collide() alone, for any number of threads.
/// Requires, Errors: those of collide().
/// Cost:      that of collide(), shared by the threads (bench/poses.cpp).
[[nodiscard]] std::vector<Collision> collide_poses(PairWorkspaces& scratches, std::span<const PosePair> poses,
                                                   const CollideOptions& options,
                                                   const WorkMonitor& monitor = {});

/// What distance() answers for each pose, in their order.
///
/// Guarantee: the same bits as from distance() alone, for any number of threads.
/// Requires, Errors: those of distance().
/// Cost:      that of distance(), shared by the threads.
[[nodiscard]] std::vector<Distance> distance_poses(PairWorkspaces& scratches, std::span<const PosePair> poses,
                                                   const DistanceOptions& options,
                                                   const WorkMonitor& monitor = {});

}  // namespace snug
