#pragma once

#include <functional>
#include <optional>
#include <vector>

#include <snug/scene.h>
#include <support/parallel.h>

namespace snug {

/// Workspaces of some threads, kept from one batch of pairs to the next; one of them is that of the thread which made this,
/// Workspace::of_this_thread(), which lasts longer.
class SceneWorkers {
 public:
  /// `threads`: 0 for all cores.
  explicit SceneWorkers(int threads);

  /// Calls work(workspace) on all threads, each with its own.
  /// Errors:    what `work` throws is thrown again once all have ended, of several one.
  void run(const std::function<void(Workspace&)>& work);
  /// Calls answer(workspace, i) for each i in [0, count), no two at once with the same workspace.
  /// Errors:    what `answer` throws ends the loop and is thrown again, of several one.
  void for_each(std::size_t count, const std::function<void(Workspace&, std::size_t)>& answer);
  [[nodiscard]] std::size_t threads() const { return others_.size() + 1; }

 private:
  void share(std::size_t count, const std::function<void(SharedRanges&, Workspace&)>& work);

  Workspace& own_;
  std::vector<Workspace> others_;
};

/// Pairs of a scene that are answered between two calls of the broad phase.
inline constexpr std::size_t pairs_of_a_batch = 16384;

/// Calls what a monitor has for a part of the work that takes it from `from` to `to`.
void report_part(const WorkMonitor& monitor, double from, double to, std::size_t done, std::size_t count);

/// collide() of one pair. Errors name the parts.
[[nodiscard]] Collision collide_pair(const Scene& scene, const ScenePair& pair, CollideOptions options,
                                     const WorkMonitor& monitor, Workspace& workspace);
/// distance() of one pair; nothing if it is farther apart than pair.margin. Likewise.
[[nodiscard]] std::optional<Distance> distance_of_pair(const Scene& scene, const ScenePair& pair,
                                                       const DistanceOptions& options,
                                                       const WorkMonitor& monitor, Workspace& workspace);

}  // namespace snug
