#include <algorithm>
#include <cstdio>
#include <exception>
#include <new>
#include <string>
#include <vector>

#include <fmt/core.h>
#include <snug/base/error.h>
#include <snug/enclose/fit_kernels.h>
#include <CLI/CLI.hpp>

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

int run(const std::vector<Command>& commands) {
  try {
    const auto chosen =
        std::find_if(commands.begin(), commands.end(), [](const Command& c) { return c.app->parsed(); });
    return chosen == commands.end() ? static_cast<int>(ExitStatus::usage) : static_cast<int>(chosen->run());
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
  CLI::App app{"Tight, proved bounds for the limit surfaces of subdivision meshes, and answers about them.",
               "snug"};
  app.set_version_flag("--version", version_head + std::string(snug::kernels::instruction_set()) + ")");
  app.require_subcommand(1);
  app.footer(
      "Exit status: 0 answered, 2 usage, 3 unreadable file, 4 refused mesh, 5 tolerance or budget not "
      "reached, "
      "130 interrupted.");
  const std::vector<Command> commands{add_info(app),      add_bound(app),   add_eval(app),
                                      add_subdivide(app), add_collide(app), add_distance(app),
                                      add_closest(app),   add_render(app),  add_experiment(app)};
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    if (error.get_exit_code() == 0) return app.exit(error);
    return fail(ExitStatus::usage, (std::string(error.what()) + "; see snug --help").c_str());
  }
  return run(commands);
}
