// Put before the C library (LD_PRELOAD): the first thing that main does meets a signal.
#include <dlfcn.h>

#include <csignal>

extern "C" int fcntl(int descriptor, int request, ...) {
  static const bool once = (raise(SIGINT), true);
  static_cast<void>(once);
  // main asks for flags, which takes no third argument.
  using Function = int (*)(int, int, ...);
  static const auto next = reinterpret_cast<Function>(dlsym(RTLD_NEXT, "fcntl"));
  return next(descriptor, request);
}
