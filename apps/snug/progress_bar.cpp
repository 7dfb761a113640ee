#include "progress_bar.h"

#include <fmt/core.h>
#include <support/atomic_file.h>
#include <support/system_files.h>

#include "exit_status.h"
#include "messages.h"
#include "process.h"

namespace snug::command {

std::atomic<bool> stop_requested{false};

namespace {

constexpr std::string_view clear_line = "\r\033[K";

std::atomic<bool> drawn{false};  // is there a bar on the terminal?
std::atomic<bool> reported{false};

}  // namespace

void end_interrupted() noexcept {
  remove_unfinished_files();
  if (drawn.exchange(false)) to_standard_error(clear_line);
  report_interrupted();
  process::end(static_cast<int>(ExitStatus::interrupted));
}

void report_interrupted() noexcept {
  if (reported.exchange(true)) return;
  to_standard_error(program_name());
  to_standard_error(": interrupted\n");
}

void leave_interruption_to_others() noexcept { reported = true; }

WorkMonitor stopped_by_interrupts() {
  WorkMonitor result;
  result.stop = &stop_requested;
  return result;
}

ProgressBar::ProgressBar(std::string_view what, bool quiet)
    : what_(one_line(what)),
      visible_(!quiet && process::is_terminal(system_files::standard_error)),
      start_(std::chrono::steady_clock::now()),
      last_(start_) {}

ProgressBar::~ProgressBar() {
  if (drawn.exchange(false)) to_standard_error(clear_line);
}

WorkMonitor ProgressBar::monitor() {
  WorkMonitor result = stopped_by_interrupts();
  if (visible_) result.on_progress = [this](double done) { show(done); };
  return result;
}

void ProgressBar::show(double done) {
  using namespace std::chrono;
  const std::lock_guard lock(mutex_);
  const auto now = steady_clock::now();
  if (now - last_ < milliseconds(100)) return;
  last_ = now;
  const double spent = duration<double>(now - start_).count();
  const double left = done > 0 ? spent * (1 - done) / done : 0;
  drawn = true;
  to_standard_error(fmt::format("{}{} {:3.0f} %, {:.0f} s left", clear_line, what_, 100 * done, left));
}

}  // namespace snug::command
