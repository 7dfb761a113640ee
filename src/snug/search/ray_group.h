#pragma once

#include <algorithm>
#include <array>
#include <optional>
#include <span>

#include <snug/bvh/ray_kernel.h>
#include <snug/search/piece_cache.h>
#include <snug/search/ray_crossing.h>
#include <snug/search/ray_task.h>

namespace snug {

/// Splits after which a ray that meets no border should have been decided. Those that are left of the budget are for the others,
/// however few were needed to know that: a ray in company, of which some boxes are ruled out together, may need fewer.
[[nodiscard]] inline std::uint64_t quick_splits(const RayTask& task) {
  return std::min<std::uint64_t>(256, task.budget / 2);
}
/// Share of a tube's radius that pieces in it may be off by.
inline constexpr double tube_share = 0x1p-5;

/// A ray of a group, and what became of it.
struct GroupedRay {
  const RayTask* task;
  NearPart near;
  FoundHits* found;
  std::optional<RayFrame> frame{};  ///< once a piece is seen
  double end = near.upper;          ///< nothing behind it matters
  double failed = INFINITY;         ///< where a piece begins that proves nothing, at the earliest
  std::uint64_t splits = 0;

  [[nodiscard]] bool decided() const {
    return task->query == RayQuery::any && !found->hits.empty() ? true : !(failed <= end);
  }
};

/// Finds the hits of rays that lie close together, as far as pieces prove them each by itself. They go down the tree as one thick
/// ray, and where that meets a box each by itself.
///
/// Guarantee: the hits of rays that are decided() are all that their queries ask for. But for the choice of `any` they are those of
///            each ray alone.
/// Requires:  at most kernels::ray_width rays, parts of which are near; one query and one precision.
/// Source:    derivations/rays.md, "Rays together".
class RayGroup {
 public:
  RayGroup(PieceCache& cache, std::span<GroupedRay> rays, const WorkMonitor& monitor);
  void run();

  // For search().
  [[nodiscard]] Verb look_at(const NodeRays& at);
  void open(const NodeRays& at);

 private:
  [[nodiscard]] bool is_to_be_opened(const NodeRays& at, std::size_t ray, bool in_vain);
  void set_limit(std::size_t ray);

  PieceCache& cache_;
  std::span<GroupedRay> rays_;
  const WorkMonitor& monitor_;
  kernels::SegmentPlaces places_{};  // of the rays
  kernels::SeenSegments segments_{},
      beam_{};  // the rays; and the middle one, as wide as all of them, in lane 0
  std::array<float, kernels::ray_width>
      limits_{};            // nothing of a ray behind it matters, relative to its middle
  std::uint32_t left_ = 0;  // the rays that want the node at hand opened
};

/// Is each point of the near part of one this close to one of the other's?
[[nodiscard]] bool lie_close(const GroupedRay& a, const GroupedRay& b, double distance);

}  // namespace snug
