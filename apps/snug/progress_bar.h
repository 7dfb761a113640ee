#pragma once

#include <atomic>
#include <chrono>
#include <mutex>
#include <string>

#include <snug/base/progress.h>

namespace snug::command {

/// A line on standard error with the share done and the time left, if that is a terminal; ten times a second
/// at most. Gone when the object is.
class ProgressBar {
 public:
  /// `quiet` shows nothing, ever.
  ProgressBar(std::string what, bool quiet);
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
  bool drawn_ = false;
  std::mutex mutex_;
  std::chrono::steady_clock::time_point start_, last_;
};

/// Set by SIGINT and SIGTERM once install_interrupt_handler was called.
extern std::atomic<bool> interrupted;
void install_interrupt_handler();

}  // namespace snug::command
