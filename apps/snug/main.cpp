#include <algorithm>
#include <cstdio>
#include <exception>
#include <new>
#include <string>
#include <vector>

#include <fmt/core.h>
#include <snug/base/error.h>
#include <snug/enclose/fit_kernels.h>

#include "common.h"
#include "length.h"
#include "progress_bar.h"
#include "version.h"

namespace {

using namespace snug::command;

int fail(ExitStatus status, const char* message) {
  fmt::print(stderr, "snug: {}\n", message);
  return static_cast<int>(status);
}

// Ends with what the command line asks for.
int run(const std::vector<Command>& commands, const std::vector<std::string>& words) {
  try {
    const std::string version = version_head + std::string(snug::kernels::instruction_set()) + ")";
    const Invocation wanted = read_command_line(commands, words, version);
    if (wanted.command != nullptr) return static_cast<int>(wanted.command->run());
    fmt::print(wanted.status == ExitStatus::answered ? stdout : stderr, "{}", wanted.text);
    return static_cast<int>(wanted.status);
  } catch (const UsageError& error) {
    return fail(ExitStatus::usage, error.what());
  } catch (const snug::InputError& error) {
    return fail(
        error.problem() == snug::InputProblem::unreadable ? ExitStatus::unreadable : ExitStatus::refused,
        error.what());
  } catch (const snug::Interrupted&) {
    return fail(ExitStatus::interrupted, "interrupted");
  } catch (const std::bad_alloc&) {
    return fail(ExitStatus::refused, "out of memory: the mesh or the answer is too large for this machine");
  }
}

}  // namespace

int main(int argc, char** argv) {
  install_interrupt_handler();
  const std::vector<Command> commands{collide_command(),   distance_command(), closest_command(),
                                      bound_command(),     eval_command(),     info_command(),
                                      subdivide_command(), render_command(),   experiment_command()};
  return run(commands, {argv + std::min(argc, 1), argv + argc});
}
