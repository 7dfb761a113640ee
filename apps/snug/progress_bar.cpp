#include "progress_bar.h"

#include <unistd.h>
#include <csignal>
#include <cstdio>

#include <fmt/core.h>

namespace snug::command {

std::atomic<bool> interrupted{false};

namespace {

// A second signal ends the process at once: the default action is back.
void note_interrupt(int signal) {
  interrupted.store(true);
  std::signal(signal, SIG_DFL);
}

}  // namespace

void install_interrupt_handler() {
  struct sigaction action {};
  action.sa_handler = note_interrupt;
  sigemptyset(&action.sa_mask);
  action.sa_flags = 0;  // no SA_RESTART: a read that waits for input ends
  sigaction(SIGINT, &action, nullptr);
  sigaction(SIGTERM, &action, nullptr);
}

ProgressBar::ProgressBar(std::string what, bool quiet)
    : what_(std::move(what)),
      visible_(!quiet && isatty(STDERR_FILENO) != 0),
      start_(std::chrono::steady_clock::now()),
      last_(start_) {}

ProgressBar::~ProgressBar() {
  if (drawn_) std::fputs("\r\033[K", stderr);
}

WorkMonitor ProgressBar::monitor() {
  WorkMonitor result;
  result.stop = &interrupted;
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
  fmt::print(stderr, "\r\033[K{} {:3.0f} %, {:.0f} s left", what_, 100 * done, left);
  std::fflush(stderr);
  drawn_ = true;
}

}  // namespace snug::command
