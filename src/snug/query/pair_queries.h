#pragma once

#include <span>
#include <vector>

#include <snug/distance.h>
#include <snug/search/workspace.h>
#include <support/run.h>

/// The questions of collide.h and distance.h about surfaces whose trees and caches are at hand.
namespace snug {

/// Both trees are opened from their roots on, deepest overlap first. A pair of patches or pieces is (a)
/// dropped once sets around them are farther apart than the margin; (b) a witness if their quadratics at the
/// nearest parameters of their base triangles, or the limit points there, are near enough, or a proof that
/// one crosses the other; (c) else its larger one is split, below half the tolerance too.
[[nodiscard]] Collision collide(const PlacedBvh& a, const PlacedBvh& b, const CollideOptions& options,
                                const Run& run = {});

/// Limit points where quadratics are nearest bound the distance from above, pairs of nodes, the nearest first, from below.
/// Where pieces cut each other, contact is proved as in collide().
[[nodiscard]] Distance distance(const PlacedBvh& a, const PlacedBvh& b, const DistanceOptions& options,
                                const Run& run = {});

/// The question of deviation.h about triangles of some points; none: each three points in a row.
[[nodiscard]] Deviation deviation(const Surface& surface, std::span<const Point3> points,
                                  std::span<const std::array<std::uint32_t, 3>> triangles,
                                  const DeviationOptions& options, const Run& run = {});

/// Two placed surfaces with their trees and their parts of a workspace.
struct PlacedPair {
  PlacedPair(const PlacedSurface& in_a, const PlacedSurface& in_b, Workspace& workspace)
      : PlacedPair(in_a, in_b, workspace.pieces().of(in_a.surface(), in_b.surface())) {}
  PlacedBvh a, b;

 private:
  PlacedPair(const PlacedSurface& in_a, const PlacedSurface& in_b, const Workspace::Pieces::Pair& pieces)
      : a{pieces.a.model(), pieces.a, in_a.pose()}, b{pieces.b.model(), pieces.b, in_b.pose()} {}
};

/// Answers of query(a, b, options, run), such as collide(), for each pose in order. What threads find out about pieces stays in
/// the run's workspace.
/// Guarantee: the same bits as one by one, for any number of threads.
/// Errors:    what `query` throws ends the loop and is thrown again, of several one.
template <class Answer, class Options>
[[nodiscard]] std::vector<Answer> answers_to(
    Answer (*query)(const PlacedBvh&, const PlacedBvh&, const Options&, const Run&), const Surface& a,
    const Surface& b, std::span<const PosePair> poses, const Options& options, const Run& run) {
  std::vector<Answer> result(poses.size());
  const WorkMonitor quiet = stop_only(run);
  const Run each{.monitor = &quiet, .max_splits = run.max_splits};
  const std::size_t step = 1 + poses.size() / 1000;
  workers_of(run).for_each(poses.size(), [&](Workspace& workspace, std::size_t i) {
    if (i % step == 0) monitor_of(run).report(static_cast<double>(i) / static_cast<double>(poses.size()));
    const Workspace::Pieces::Pair pieces = workspace.pieces().of(a, b);
    result[i] = query({pieces.a.model(), pieces.a, poses[i].a}, {pieces.b.model(), pieces.b, poses[i].b},
                      options, each);
  });
  return result;
}

}  // namespace snug
