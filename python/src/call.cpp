#include "call.h"

#include <pthread.h>
#include <signal.h>

#include "arrays.h"

namespace snug::python {
namespace {

using Handler = void (*)(int);

pthread_t main_thread;
Handler pythons_handler = nullptr;  // null: Python left SIGINT to others
std::atomic<std::atomic<bool>*> stop_of_call{nullptr};

void stop_and_pass_on(int signal) {
  if (std::atomic<bool>* const stop = stop_of_call.load()) stop->store(true);
  pythons_handler(signal);
}

bool is_main_thread() { return pthread_equal(pthread_self(), main_thread) != 0; }

// Stands before Python's handler from now on; where the program has put another one, that stays. Not taken away after a
// call: that would be a second system call, a sixth of a quick query.
bool stand_before_pythons() {
  struct sigaction wanted {};
  wanted.sa_handler = stop_and_pass_on;
  wanted.sa_flags = SA_ONSTACK;  // as Python's own
  struct sigaction former {};
  if (sigaction(SIGINT, &wanted, &former) != 0) return false;
  const bool plain = (former.sa_flags & SA_SIGINFO) == 0;
  if (plain && (former.sa_handler == pythons_handler || former.sa_handler == stop_and_pass_on)) return true;
  sigaction(SIGINT, &former, nullptr);
  return false;
}

}  // namespace

void Call::prepare() {
  // A thread of the module threading may load this module; its identifiers are those of pthread.
  main_thread = reinterpret_cast<pthread_t>(  // NOLINT
      py::module_::import("threading").attr("main_thread")().attr("ident").cast<std::uintptr_t>());
  pthread_atfork(nullptr, nullptr, [] { main_thread = pthread_self(); });
  const py::module_ signal = py::module_::import("signal");
  const py::object handler = signal.attr("getsignal")(SIGINT);
  if (PyCallable_Check(handler.ptr()) != 0) pythons_handler = PyOS_getsig(SIGINT);
}

Call::Call(const py::object& progress, const Run& run) : run_(run) {
  run_.monitor = &monitor_;
  monitor_.stop = &stop_;
  if (!progress.is_none() && progress.ptr() != Py_False) {
    progress_ = progress.ptr() == Py_True ? convert("bar")() : progress;
    if (PyCallable_Check(progress_.ptr()) == 0)
      throw py::type_error("progress: give True, or a callable of one number");
    monitor_.on_progress = [this](double done) {
      const py::gil_scoped_acquire acquired;
      if (fault_) return;
      try {
        progress_(done);
      } catch (const py::error_already_set&) {
        fault_ = std::current_exception();
        stop_.store(true);
      }
    };
  }
  if (pythons_handler == nullptr || !is_main_thread()) return;
  std::atomic<bool>* none = nullptr;  // a call within a progress callback leaves it to the outer one
  if (!stop_of_call.compare_exchange_strong(none, &stop_)) return;
  armed_ = stand_before_pythons();
  if (!armed_) stop_of_call.store(nullptr);
}

Call::~Call() {
  if (armed_) stop_of_call.store(nullptr);
}

void Call::require_resumed() {
  if (fault_) std::rethrow_exception(fault_);
  stop_.store(false);
  if (PyErr_CheckSignals() != 0) throw py::error_already_set();
}

}  // namespace snug::python
