#pragma once

#include <string>

#include "command_line.h"

namespace snug::command {

/// A script that makes bash complete the program's commands, their options and values, and file names; made of the
/// tables that the command line is read by.
[[nodiscard]] std::string bash_completion(const Program& program);

}  // namespace snug::command
