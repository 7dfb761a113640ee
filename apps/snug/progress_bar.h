#pragma once

#include <atomic>
#include <chrono>
#include <mutex>
#include <string>
#include <string_view>

#include <snug/run.h>

namespace snug::command {

/// A line on standard error with the share done and the time left, if that is a terminal; ten times a second
/// at most. Gone when the object is.
class ProgressBar {
 public:
  /// `quiet` shows nothing, ever.
  ProgressBar(std::string_view what, bool quiet);
  ~ProgressBar();
  ProgressBar(const ProgressBar&) = delete;
  ProgressBar& operator=(const ProgressBar&) = delete;

  /// A monitor that feeds this bar and stops at an interrupt.
  /// Requires:  the bar outlives it.
  [[nodiscard]] WorkMonitor monitor();

 private:
  void show(double done);

  std::string what_;
  bool visible_;
  std::mutex mutex_;
  std::chrono::steady_clock::time_point start_, last_;
};

/// Set by SIGINT, SIGTERM and SIGHUP, from before main on.
///
/// Guarantee: work that does not end by itself within 0.3 s of the first signal is ended then, or at a second
///            signal: temporary files removed, standard output as far as it was written, status 130.
extern std::atomic<bool> stop_requested;
/// Ends the process as such: temporary files removed, status 130. Async-signal-safe.
[[noreturn]] void end_interrupted() noexcept;
/// A monitor that stops at an interrupt and shows nothing.
[[nodiscard]] WorkMonitor stopped_by_interrupts();
/// "snug: interrupted" on standard error, once a process. Async-signal-safe.
void report_interrupted() noexcept;
/// From here on another process reports it: of several ranks one does.
void leave_interruption_to_others() noexcept;

}  // namespace snug::command
