#pragma once

#include <atomic>
#include <cstddef>
#include <functional>
#include <optional>

namespace snug {

/// Hands out ranges that cover [0, count) once, to the threads that share a loop: long ones first, so that
/// few are needed, short ones at the end, so that all threads end together.
class SharedRanges {
 public:
  struct Range {
    std::size_t begin, end;
  };
  /// `parts`: how many threads ask.
  SharedRanges(std::size_t count, std::size_t parts) : count_(count), divisor_(8 * parts) {}

  /// The next range; nothing when all are handed out, or after end().
  [[nodiscard]] std::optional<Range> next() noexcept;
  /// No more ranges for anybody.
  void end() noexcept { ended_.store(true, std::memory_order_relaxed); }

 private:
  std::size_t count_, divisor_;
  std::atomic<std::size_t> first_{0};
  std::atomic<bool> ended_{false};
};

/// Calls work(ranges) on at most `threads` threads (0: all cores), this one among them; each takes its share.
///
/// Guarantee: returns when all calls have. An exception of one ends the handing out, and is thrown again
///            here. Where the system refuses a thread (limits of processes or memory) the others do its
///            share, threads_were_refused() reports it, and results are the same.
/// Cost:      some 20 microseconds a thread. No more are started than there are cores, but up to four anyway.
void share_ranges(std::size_t count, int threads, const std::function<void(SharedRanges&)>& work);

/// Calls body(begin, end) on ranges that cover [0, count), on at most `threads` threads (0: all cores). Each
/// index is in exactly one range; ranges depend on scheduling: results must not.
void parallel_for(std::size_t count, int threads, const std::function<void(std::size_t, std::size_t)>& body);

/// Calls body(state, begin, end) likewise, where `state` is what make() returned on this thread: scratch
/// memory that is expensive to make. Results must not depend on its contents.
template <class Make, class Body>
void parallel_for_with(std::size_t count, int threads, const Make& make, const Body& body) {
  share_ranges(count, threads, [&](SharedRanges& ranges) {
    auto range = ranges.next();
    if (!range) return;
    auto state = make();
    for (; range; range = ranges.next()) body(state, range->begin, range->end);
  });
}

/// The number of threads that 0 means.
[[nodiscard]] int hardware_threads();

/// Has the system refused to start a thread since the process began?
[[nodiscard]] bool threads_were_refused() noexcept;

}  // namespace snug
