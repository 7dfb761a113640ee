#include <atomic>

#include <snug/query/pair_queries.h>
#include <support/parallel.h>

namespace snug {

PairWorkspaces::PairWorkspaces(const SurfaceBvh& a, const SurfaceBvh& b, int threads) {
  const int count = threads > 0 ? threads : hardware_threads();
  for (int i = 0; i < count; ++i) pairs_.push_back(std::make_unique<Pair>(a, b));
}

void PairWorkspaces::for_each(std::size_t count, const Ask& ask, const WorkMonitor& monitor) {
  std::atomic<std::size_t> taken{0};
  share_ranges(count, static_cast<int>(pairs_.size()), [&](SharedRanges& ranges) {
    Pair& pair = *pairs_[taken++];
    while (const auto range = ranges.next()) {
      monitor.report(static_cast<double>(range->begin) / static_cast<double>(count));
      for (std::size_t i = range->begin; i < range->end; ++i) ask(pair.a, pair.b, i);
    }
  });
}

}  // namespace snug
