#pragma once

#include <atomic>
#include <exception>

#include <pybind11/pybind11.h>
#include <snug/run.h>

namespace snug::python {

namespace py = pybind11;

/// One call of the library: without the GIL, stopped by Ctrl-C and by exceptions of the progress callback.
///
/// On the main thread, where Python's own handler of SIGINT is in place, the first call puts a handler before it that sets
/// the stop flag of the call under way, if any, and then calls Python's. The call ends at its next checkpoint, and Python raises what its handler says.
class Call {
 public:
  /// `run`: threads and splits. `progress`: None or False, True for a bar by tqdm, or callable with the fraction done; from any thread of the library, one at a time.
  explicit Call(const py::object& progress = py::none(), const Run& run = {});
  ~Call();
  Call(const Call&) = delete;
  Call& operator=(const Call&) = delete;

  /// work(const Run&), with a monitor, called without the GIL. It begins again where a handler of SIGINT did not raise.
  template <class Work>
  auto run(const Work& work) {
    for (;;) {
      try {
        const py::gil_scoped_release released;
        return work(run_);
      } catch (const Interrupted&) {
        require_resumed();
      }
    }
  }

  /// Once, as the module is loaded: remembers the main thread and Python's handler.
  static void prepare();

 private:
  void require_resumed();

  WorkMonitor monitor_;
  Run run_;  // with this monitor
  py::object progress_;
  std::exception_ptr fault_;
  std::atomic<bool> stop_{false};
  bool armed_ = false;
};

}  // namespace snug::python
