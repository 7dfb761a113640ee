#ifndef _WIN32

#include <dlfcn.h>
#include <fcntl.h>
#include <poll.h>
#include <sys/time.h>
#include <unistd.h>
#if __has_include(<execinfo.h>)
#include <execinfo.h>
#endif

#include <algorithm>
#include <cerrno>
#include <csignal>

#include "process.h"
#include "progress_bar.h"

namespace snug::command::process {
namespace {

constexpr suseconds_t grace = 300'000;  // microseconds

void note_interrupt(int signal) {
  const int before = errno;
  if (signal == SIGALRM || stop_requested.exchange(true)) end_interrupted();
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

std::vector<std::string> arguments(int argc, char** argv) { return {argv + std::min(argc, 1), argv + argc}; }

std::filesystem::path folder() {
  std::error_code ignored;
  return std::filesystem::read_symlink("/proc/self/exe", ignored).parent_path();
}

bool is_terminal(int descriptor) { return ::isatty(descriptor) != 0; }

bool can_read_now(int descriptor) {
  pollfd watched{descriptor, POLLIN, 0};
  return ::poll(&watched, 1, 0) == 1 && (watched.revents & POLLIN) != 0;
}

void end(int status) noexcept { ::_exit(status); }

void hold_standard_descriptors() noexcept {
  for (const int descriptor : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO}) {
    if (::fcntl(descriptor, F_GETFD) >= 0) continue;
    // The lowest one that is free is the one that is meant. Opened the wrong way round: to use it fails.
    static_cast<void>(::open("/dev/null", descriptor == STDIN_FILENO ? O_WRONLY : O_RDONLY));
  }
}

void load_what_unwinds() noexcept {
#if __has_include(<execinfo.h>)
  void* frame = nullptr;
  static_cast<void>(::backtrace(&frame, 1));
#endif
}

void* load_library(const std::filesystem::path& file) {
  return ::dlopen(file.c_str(), RTLD_NOW | RTLD_GLOBAL);
}
void* symbol_of(void* library, const char* name) { return ::dlsym(library, name); }

}  // namespace snug::command::process

#endif
