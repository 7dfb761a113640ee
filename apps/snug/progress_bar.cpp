#include "progress_bar.h"

#include <sys/time.h>
#include <unistd.h>
#include <cerrno>
#include <csignal>

#include <fmt/core.h>
#include <support/atomic_file.h>

#include "exit_status.h"
#include "messages.h"

namespace snug::command {

std::atomic<bool> stop_requested{false};

namespace {

constexpr std::string_view clear_line = "\r\033[K";
constexpr suseconds_t grace = 300'000;  // microseconds

std::atomic<bool> drawn{false};  // is there a bar on the terminal?
std::atomic<bool> reported{false};

[[noreturn]] void end_at_once() {
  remove_unfinished_files();
  if (drawn.exchange(false)) to_standard_error(clear_line);
  report_interrupted();
  _exit(static_cast<int>(ExitStatus::interrupted));
}

void note_interrupt(int signal) {
  const int before = errno;
  if (signal == SIGALRM || stop_requested.exchange(true)) end_at_once();
  // A plain system call on Linux, and so safe here.
  const itimerval until_the_end{{0, 0}, {0, grace}};
  setitimer(ITIMER_REAL, &until_the_end, nullptr);
  errno = before;
}

// Before the constructors of static objects and before main: as early as a program can.
[[gnu::constructor(101)]] void install_handlers() {
  struct sigaction action {};
  action.sa_handler = note_interrupt;
  sigfillset(&action.sa_mask);
  action.sa_flags = 0;  // no SA_RESTART: a read that waits for input ends
  for (const int signal : {SIGINT, SIGTERM, SIGALRM}) sigaction(signal, &action, nullptr);
  // nohup means it.
  struct sigaction hangup {};
  if (sigaction(SIGHUP, nullptr, &hangup) == 0 && hangup.sa_handler != SIG_IGN) {
    sigaction(SIGHUP, &action, nullptr);
  }
  // A closed pipe and a file that may grow no more are errors of write().
  action.sa_handler = SIG_IGN;
  for (const int signal : {SIGPIPE, SIGXFSZ}) sigaction(signal, &action, nullptr);
}

}  // namespace

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
      visible_(!quiet && isatty(STDERR_FILENO) != 0),
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
