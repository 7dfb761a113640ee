#pragma once

namespace snug::command {

/// Exit status of the command; scripts rely on these numbers (docs/command.md).
enum class ExitStatus : int {
  answered = 0,
  usage = 2,
  unreadable = 3,
  refused = 4,
  not_reached = 5,
  within = 10,        // with --exit-code
  intersecting = 11,  // with --exit-code
  undecided = 12,     // with --exit-code
  exceeds = 13,       // with --exit-code
  interrupted = 130,
};

}  // namespace snug::command
