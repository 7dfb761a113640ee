#pragma once

#include <functional>

#include "command_line.h"

namespace snug::command {

/// All of main(): reads the command line, runs the command that it names, and turns whatever ends it into a
/// message and an exit status. `program` makes the program; it is called once failures are caught.
[[nodiscard]] int run(int argc, char** argv, const std::function<Program()>& program);

}  // namespace snug::command
