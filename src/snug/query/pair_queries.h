#pragma once

#include <functional>
#include <memory>
#include <span>
#include <vector>

#include <snug/distance.h>
#include <snug/search/workspace.h>
#include <support/run.h>

/// The questions of collide.h and distance.h about surfaces whose trees and workspaces are at hand.
namespace snug {

/// Both trees are opened from their roots on, deepest overlap first. A pair of patches or pieces is (a)
/// dropped once sets around them are farther apart than the margin; (b) a witness if their quadratics at the
/// nearest parameters of their base triangles, or the limit points there, are near enough, or a proof that
/// one crosses the other; (c) else its larger one is split, below half the tolerance too.
[[nodiscard]] Collision collide(const PlacedBvh& a, const PlacedBvh& b, const CollideOptions& options,
                                const Run& run = {});

/// Limit points where quadratics are nearest bound the distance from above; two planes across the direction of
/// the nearest ones, and where pieces lie beyond these, pairs of nodes, the nearest first, from below. Where
/// pieces cut each other, contact is proved as in collide().
[[nodiscard]] Distance distance(const PlacedBvh& a, const PlacedBvh& b, const DistanceOptions& options,
                                const Run& run = {});

/// Two placed surfaces with their trees and their parts of a workspace.
struct PlacedPair {
  PlacedPair(const PlacedSurface& in_a, const PlacedSurface& in_b, Workspace& workspace)
      : PlacedPair(in_a, in_b, workspace.pieces().of(in_a.surface(), in_b.surface())) {}
  PlacedBvh a, b;

 private:
  PlacedPair(const PlacedSurface& in_a, const PlacedSurface& in_b, const Workspace::Pieces::Pair& pieces)
      : a{pieces.a.model(), pieces.a, in_a.pose()}, b{pieces.b.model(), pieces.b, in_b.pose()} {}
};

/// Workspaces of two models for many poses, one pair a thread: what a thread has found out about pieces is of
/// use for its next pose.
class PairWorkspaces {
 public:
  /// `threads`: 0 for all cores.
  /// Requires:  the models outlive it.
  PairWorkspaces(const SurfaceBvh& a, const SurfaceBvh& b, int threads = 0);

  /// Calls ask(a, b, pose) for each pose in [0, count), on the threads, no two at once with the same pair of
  /// workspaces.
  /// Errors:    what `ask` throws ends the loop and is thrown again, of several one.
  using Ask = std::function<void(SurfaceWorkspace& a, SurfaceWorkspace& b, std::size_t pose)>;
  void for_each(std::size_t count, const Ask& ask, const WorkMonitor& monitor);

  /// Answers of query(a, b, options, run), such as collide(), for each pose in order.
  /// Guarantee: the same bits as one by one, for any number of threads.
  template <class Answer, class Options>
  [[nodiscard]] std::vector<Answer> answers(Answer (*query)(const PlacedBvh&, const PlacedBvh&,
                                                            const Options&, const Run&),
                                            std::span<const PosePair> poses, const Options& options,
                                            const Run& run = {}) {
    std::vector<Answer> result(poses.size());
    const WorkMonitor quiet = stop_only(run);
    const Run each{.monitor = &quiet, .max_splits = run.max_splits};
    for_each(
        poses.size(),
        [&](SurfaceWorkspace& a, SurfaceWorkspace& b, std::size_t i) {
          result[i] = query({a.model(), a, poses[i].a}, {b.model(), b, poses[i].b}, options, each);
        },
        monitor_of(run));
    return result;
  }

 private:
  struct Pair {
    Pair(const SurfaceBvh& in_a, const SurfaceBvh& in_b) : a(in_a), b(in_b) {}
    SurfaceWorkspace a, b;
  };
  std::vector<std::unique_ptr<Pair>> pairs_;
};

}  // namespace snug
