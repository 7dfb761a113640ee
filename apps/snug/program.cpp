#include "program.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <cstdlib>
#include <exception>
#include <new>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include <snug/inspect.h>
#include <support/error.h>

#include "common.h"
#include "length.h"
#include "messages.h"
#include "process.h"
#include "progress_bar.h"
#include "version.h"

namespace snug::command {
namespace {

constexpr const char* out_of_memory = "out of memory: the mesh or the answer is too large for this machine";

// Memory for the way out, a part for each failure: without it unwinding, and what the C library allocates
// meanwhile, would end the process. Parts are small enough to come from the heap.
std::array<std::atomic<void*>, 64> reserve;

void release_a_part() {
  for (std::atomic<void*>& part : reserve) {
    if (void* const memory = part.exchange(nullptr)) {
      std::free(memory);
      break;
    }
  }
  throw std::bad_alloc();
}

void prepare_for_lack_of_memory() {
  for (std::atomic<void*>& part : reserve) part = std::malloc(std::size_t{8} << 10);
  std::set_new_handler(release_a_part);
  process::load_what_unwinds();
}

int fail(ExitStatus status, std::string_view message) {
  print_message(message);
  return static_cast<int>(status);
}

int answer(const Program& program, const std::vector<std::string>& words) {
  set_program_name(program.name);
  const std::string version = std::string(program.name) + version_head + std::string(instruction_set()) + ")";
  const Invocation wanted = read_command_line(program, words, version);
  if (wanted.command == nullptr) {
    wanted.status == ExitStatus::answered ? write_output(wanted.text) : to_standard_error(wanted.text);
    return static_cast<int>(wanted.status);
  }
  for (const Option& option : wanted.command->options.all()) {
    if (option.name == "-o") require_output(wanted.command->name, option.text());
  }
  stopped_by_interrupts().checkpoint();
  return static_cast<int>(wanted.command->run());
}

int interruption() {
  report_interrupted();
  return static_cast<int>(ExitStatus::interrupted);
}

}  // namespace

// Nothing that comes from outside ends the process without a message and a status.
int run(int argc, char** argv, const std::function<Program()>& program) {
  process::hold_standard_descriptors();
  prepare_for_lack_of_memory();
  try {
    return answer(program(), process::arguments(argc, argv));
  } catch (const Interrupted&) {
    return interruption();
  } catch (const UsageError& error) {
    return fail(ExitStatus::usage, error.what());
  } catch (const InputError& error) {
    // A wait for a file that a signal ended.
    if (stop_requested.load()) return interruption();
    return fail(error.problem() == InputProblem::unreadable ? ExitStatus::unreadable : ExitStatus::refused,
                error.what());
  } catch (const std::bad_alloc&) {
    return fail(ExitStatus::refused, out_of_memory);
  } catch (const std::length_error&) {
    return fail(ExitStatus::refused, out_of_memory);
  } catch (const std::exception& error) {
    return fail(ExitStatus::refused, error.what());
  }
}

}  // namespace snug::command
