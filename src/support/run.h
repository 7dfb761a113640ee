#pragma once

#include <snug/run.h>

namespace snug {

/// The monitor of a run, or one that does nothing.
[[nodiscard]] inline const WorkMonitor& monitor_of(const Run& run) {
  static const WorkMonitor none;
  return run.monitor != nullptr ? *run.monitor : none;
}

/// For parts of a work that reports progress as a whole: stops with it.
[[nodiscard]] inline WorkMonitor stop_only(const Run& run) {
  return {.on_progress = {}, .stop = run.monitor != nullptr ? run.monitor->stop : nullptr};
}

/// `complete` or else why not.
[[nodiscard]] inline Outcome outcome_of(bool complete, bool budget_spent) {
  return complete ? Outcome::complete : budget_spent ? Outcome::budget_spent : Outcome::at_rounding;
}

/// The worse of two: a spent budget counts most.
[[nodiscard]] inline Outcome worse(Outcome a, Outcome b) {
  if (a == Outcome::budget_spent || b == Outcome::budget_spent) return Outcome::budget_spent;
  return a == Outcome::complete ? b : a;
}

}  // namespace snug
