#pragma once

#include <functional>
#include <string>
#include <vector>

#include "exit_status.h"
#include "options.h"

namespace snug::command {

/// Subjects of commands; --help of the program groups commands by them, in this order.
enum class Topic { two_surfaces, one_surface, files, functions, tables, comparisons };

/// A command: what --help says of it, its options, and what runs when it is chosen.
struct Command {
  const char* name;
  Topic topic;
  const char* summary;  ///< a sentence without its full stop
  std::vector<std::string> examples;
  OptionList options;
  std::function<ExitStatus()> run;
  const char* former = nullptr;  ///< the name that it had in the version before
};

/// A command of another program, or an option that is one.
struct Elsewhere {
  const char* command;
  const char* option;  ///< empty, or the option of `command`
  const char* there;   ///< "a command of PROGRAM (package PACKAGE)" and the like
};

/// A program of commands, and what its --help says.
struct Program {
  const char* name;
  const char* summary;   ///< a sentence
  const char* question;  ///< that the example answers
  const char* example;
  std::vector<Command> commands;
  const char* see_also = nullptr;  ///< a sentence about other programs
  std::vector<Elsewhere> elsewhere = {};
};

/// A parsed command line.
struct Invocation {
  const Command* command = nullptr;          ///< to run, if not null
  std::string text = {};                     ///< else to print,
  ExitStatus status = ExitStatus::answered;  ///< and to end with; on standard error if that is not `answered`
};

/// Reads the words after the program's name and fills the options of the command that they name.
///
/// Errors:    UsageError, one line that names the word and the next step.
[[nodiscard]] Invocation read_command_line(const Program& program, const std::vector<std::string>& words,
                                           const std::string& version);

/// Text of --help, of the program and of one of its commands.
[[nodiscard]] std::string help_of(const Program& program);
[[nodiscard]] std::string help_of(const Program& program, const Command& command);

}  // namespace snug::command
