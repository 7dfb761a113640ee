#pragma once

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <functional>
#include <thread>
#include <vector>

#include <support/parallel.h>

namespace snug {

/// Threads with a state each, such as a Workspace, which is kept from one loop to the next. That of the thread which
/// made this is given, and may last longer.
template <class State>
class Workers {
 public:
  /// `threads`: 0 for all cores.
  Workers(State& own, int threads) : Workers(own, threads, nullptr) {}
  /// The other threads' states come from `kept` and go back there in the end: a loop within this one makes its own.
  Workers(State& own, int threads, std::vector<State>* kept) : own_(own), kept_(kept) {
    if (kept_ != nullptr) others_.swap(*kept_);
    // No more threads than these are ever started.
    const int most = std::max(hardware_threads(), 4);
    threads_ = static_cast<std::size_t>(threads > 0 ? std::min(threads, most) : hardware_threads());
    if (others_.size() + 1 < threads_) others_.resize(threads_ - 1);
  }
  Workers(const Workers&) = delete;
  Workers& operator=(const Workers&) = delete;
  ~Workers() {
    if (kept_ != nullptr) kept_->swap(others_);
  }

  /// Calls work(state) on all threads, each with its own.
  /// Errors:    what `work` throws is thrown again once all have ended, of several one.
  void run(const std::function<void(State&)>& work) {
    share(threads(), [&](SharedRanges&, State& state) { work(state); });
  }
  /// Calls answer(state, i) for each i in [0, count), no two at once with the same state.
  /// Errors:    what `answer` throws ends the loop and is thrown again, of several one.
  void for_each(std::size_t count, const std::function<void(State&, std::size_t)>& answer) {
    for_each_range(count, [&](State& state, std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) answer(state, i);
    });
  }
  /// The same for ranges, which depend on scheduling.
  void for_each_range(std::size_t count,
                      const std::function<void(State&, std::size_t, std::size_t)>& answer) {
    share(count, [&](SharedRanges& ranges, State& state) {
      while (const auto range = ranges.next()) answer(state, range->begin, range->end);
    });
  }
  [[nodiscard]] std::size_t threads() const { return threads_; }

 private:
  void share(std::size_t count, const std::function<void(SharedRanges&, State&)>& work) {
    const std::thread::id caller = std::this_thread::get_id();
    std::atomic<std::size_t> taken{0};
    share_ranges(count, static_cast<int>(threads()), [&](SharedRanges& ranges) {
      const bool own = std::this_thread::get_id() == caller;
      work(ranges, own ? own_ : others_[taken++]);
    });
  }

  State& own_;
  std::vector<State>* kept_;
  std::vector<State> others_;
  std::size_t threads_ = 1;
};

}  // namespace snug
