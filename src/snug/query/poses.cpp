#include <snug/query/poses.h>

#include <algorithm>
#include <atomic>

#include <snug/base/parallel.h>

namespace snug {
namespace {

// A query takes from 0.1 microseconds to milliseconds: so many at a time, that the shared counter costs nothing and threads
// end together.
constexpr std::size_t most_at_a_time = 32;

template <class Answer, class Query>
std::vector<Answer> answers(PairWorkspaces& scratches, std::span<const PosePair> poses,
                            const WorkMonitor& monitor, const Query& query) {
  std::vector<Answer> result(poses.size());
  const WorkMonitor stop_only{.on_progress = {}, .stop = monitor.stop};
  scratches.for_each(
      poses.size(),
      [&](SurfaceWorkspace& a, SurfaceWorkspace& b, std::size_t i) {
        result[i] = query({a.model(), a, poses[i].a}, {b.model(), b, poses[i].b}, stop_only);
      },
      monitor);
  return result;
}

}  // namespace

PairWorkspaces::PairWorkspaces(const SurfaceBvh& a, const SurfaceBvh& b, int threads) {
  const int count = threads > 0 ? threads : hardware_threads();
  for (int i = 0; i < count; ++i) pairs_.push_back(std::make_unique<Pair>(a, b));
}

std::size_t PairWorkspaces::bytes() const {
  std::size_t sum = 0;
  for (const auto& pair : pairs_) sum += pair->a.bytes() + pair->b.bytes();
  return sum;
}

void PairWorkspaces::for_each(std::size_t count, const Ask& ask, const WorkMonitor& monitor) {
  const std::size_t threads = std::min(pairs_.size(), count);
  if (threads == 0) return;
  const std::size_t step = std::clamp<std::size_t>(count / (threads * 16), 1, most_at_a_time);
  std::atomic<std::size_t> next{0};
  const auto work = [&](Pair& pair) {
    for (;;) {
      const std::size_t begin = next.fetch_add(step, std::memory_order_relaxed);
      if (begin >= count) return;
      monitor.report(static_cast<double>(begin) / static_cast<double>(count));
      for (std::size_t i = begin; i < std::min(begin + step, count); ++i) ask(pair.a, pair.b, i);
    }
  };
  const auto work_or_end_all = [&](Pair& pair) {
    try {
      work(pair);
    } catch (...) {
      next.store(count, std::memory_order_relaxed);
      throw;
    }
  };
  parallel_for(threads, static_cast<int>(threads), [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) work_or_end_all(*pairs_[i]);
  });
}

std::vector<Collision> collide_poses(PairWorkspaces& scratches, std::span<const PosePair> poses,
                                     const CollideOptions& options, const WorkMonitor& monitor) {
  return answers<Collision>(scratches, poses, monitor,
                            [&](const PlacedBvh& a, const PlacedBvh& b, const WorkMonitor& stop) {
                              return collide(a, b, options, stop);
                            });
}

std::vector<Distance> distance_poses(PairWorkspaces& scratches, std::span<const PosePair> poses,
                                     const DistanceOptions& options, const WorkMonitor& monitor) {
  return answers<Distance>(scratches, poses, monitor,
                           [&](const PlacedBvh& a, const PlacedBvh& b, const WorkMonitor& stop) {
                             return distance(a, b, options, stop);
                           });
}

}  // namespace snug
