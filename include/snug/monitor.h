#pragma once

#include <atomic>
#include <functional>

#include <snug/error.h>

namespace snug {

/// How long-running work reports progress and is stopped. Both members are optional.
struct WorkMonitor {
  /// Called with the fraction done, in [0, 1], at most a few thousand times, by several threads at once.
  std::function<void(double)> on_progress;
  /// Set from elsewhere, such as a signal handler, to stop the work.
  const std::atomic<bool>* stop = nullptr;

  /// Throws Interrupted if a stop was requested.
  /// Cost:      one load.
  void checkpoint() const {
    if (stop && stop->load(std::memory_order_relaxed)) throw Interrupted();
  }
  void report(double done) const {
    checkpoint();
    if (on_progress) on_progress(done);
  }
};

}  // namespace snug
