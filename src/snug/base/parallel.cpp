#include <snug/base/parallel.h>

#include <atomic>
#include <exception>
#include <thread>
#include <utility>

#ifdef SNUG_WITH_TBB
#include <oneapi/tbb/blocked_range.h>
#include <oneapi/tbb/parallel_for.h>
#include <oneapi/tbb/task_arena.h>
#endif

namespace snug {

int hardware_threads() {
  const unsigned cores = std::thread::hardware_concurrency();
  return cores ? static_cast<int>(cores) : 1;
}

void parallel_for(std::size_t count, int threads, const std::function<void(std::size_t, std::size_t)>& body) {
  if (count == 0) return;
#ifdef SNUG_WITH_TBB
  if (threads != 1 && count > 1) {
    oneapi::tbb::task_arena arena(threads > 0 ? threads : hardware_threads());
    // The flags say what oneTBB guarantees anyway, in terms that the thread sanitizer sees: what came before
    // the loop happens before every body, and every body before what comes after. Exceptions too are handed
    // over here, since oneTBB's own way of doing so is hidden from it.
    std::atomic<bool> started{false}, finished{false}, failed{false};
    std::exception_ptr failure;
    oneapi::tbb::task_group_context group;
    started.store(true, std::memory_order_release);
    arena.execute([&] {
      oneapi::tbb::parallel_for(
          oneapi::tbb::blocked_range<std::size_t>(0, count),
          [&](const auto& range) {
            static_cast<void>(started.load(std::memory_order_acquire));
            try {
              body(range.begin(), range.end());
            } catch (...) {
              if (!failed.exchange(true, std::memory_order_acq_rel)) failure = std::current_exception();
              group.cancel_group_execution();
            }
            finished.exchange(true, std::memory_order_acq_rel);
          },
          group);
    });
    static_cast<void>(finished.load(std::memory_order_acquire));
    if (failure) std::rethrow_exception(std::move(failure));
    return;
  }
#else
  static_cast<void>(threads);
#endif
  body(0, count);
}

}  // namespace snug
