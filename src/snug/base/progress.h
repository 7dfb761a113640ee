#pragma once

#include <atomic>
#include <functional>

#include <snug/base/error.h>

namespace snug {

/// How long work reports itself and is stopped. All members are optional; a default one is silent and never
/// stops. Thread-safe as far as the callback is.
struct WorkMonitor {
  /// Called with the share that is done, in [0, 1], a few thousand times at most.
  std::function<void(double)> on_progress;
  /// Set by somebody else, for instance a signal handler, to end the work.
  const std::atomic<bool>* stop = nullptr;

  /// Throws Interrupted if a stop was asked for.
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
