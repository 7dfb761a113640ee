#include <support/parallel.h>

#include <algorithm>
#include <exception>
#include <mutex>
#include <new>
#include <system_error>
#include <thread>
#include <utility>
#include <vector>

namespace snug {
namespace {

#if defined(__MINGW32__) && defined(__GNUC__) && !defined(__clang__)
// GCC keeps a thread's own objects under one key of winpthreads, which frees their memory when the thread ends, and their destructors
// under another. Keys end in the order in which they were made, and the memory's would come first: here the other one is made.
extern "C" int __cxa_thread_atexit(void (*)(void*), void*, void*) noexcept;
[[gnu::constructor(101)]] void make_key_of_destructors() {
  __cxa_thread_atexit([](void*) {}, nullptr, nullptr);
}
#endif

std::atomic<bool> refused{false};

// Threads that pay: more than there are cores only wait for one another.
std::size_t useful_threads(std::size_t count, int threads) {
  constexpr int always = 4;
  const int cores = hardware_threads();
  const int wanted = threads > 0 ? std::min(threads, std::max(cores, always)) : cores;
  return std::min(count, static_cast<std::size_t>(wanted));
}

// Starts a thread that calls run(); false where the system has none to give. The C library ends the process
// where it has no memory for the destructors of a thread's own objects, which are made in its first steps:
// without some room to begin with there is an exception instead.
template <class Run>
bool start(std::vector<std::thread>& helpers, const Run& run) {
  const auto run_with_headroom = [&run]() noexcept {
    try {
      constexpr std::size_t headroom = std::size_t{64} << 10;
      ::operator delete(::operator new(headroom));
    } catch (const std::bad_alloc&) {
      return;  // the others do its share
    }
    run();
  };
  try {
    helpers.emplace_back(run_with_headroom);
    return true;
  } catch (const std::system_error&) {
  } catch (const std::bad_alloc&) {
  }
  refused.store(true);
  return false;
}

}  // namespace

std::optional<SharedRanges::Range> SharedRanges::next() noexcept {
  std::size_t begin = first_.load(std::memory_order_relaxed), end = 0;
  do {
    if (begin >= count_ || ended_.load(std::memory_order_relaxed)) return {};
    end = begin + std::max<std::size_t>(1, (count_ - begin) / divisor_);
  } while (!first_.compare_exchange_weak(begin, end, std::memory_order_relaxed));
  return Range{begin, end};
}

int hardware_threads() {
  const unsigned cores = std::thread::hardware_concurrency();
  return cores ? static_cast<int>(cores) : 1;
}

bool threads_were_refused() noexcept { return refused.load(); }

void share_ranges(std::size_t count, int threads, const std::function<void(SharedRanges&)>& work) {
  if (count == 0) return;
  const std::size_t parts = useful_threads(count, threads);
  SharedRanges ranges(count, parts);
  if (parts == 1) return work(ranges);
  std::mutex mutex;
  std::exception_ptr failure;  // the first one
  const auto run = [&]() noexcept {
    try {
      work(ranges);
    } catch (...) {
      ranges.end();
      const std::lock_guard lock(mutex);
      if (!failure) failure = std::current_exception();
    }
  };
  std::vector<std::thread> helpers;
  helpers.reserve(parts - 1);
  while (helpers.size() + 1 < parts && start(helpers, run)) {
  }
  run();
  for (std::thread& helper : helpers) helper.join();
  if (failure) std::rethrow_exception(std::move(failure));
}

void parallel_for(std::size_t count, int threads, const std::function<void(std::size_t, std::size_t)>& body) {
  share_ranges(count, threads, [&](SharedRanges& ranges) {
    while (const auto range = ranges.next()) body(range->begin, range->end);
  });
}

}  // namespace snug
