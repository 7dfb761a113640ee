#include "command_line.h"

#include <algorithm>
#include <deque>
#include <map>

#include <fmt/core.h>

#include "completion.h"
#include "length.h"
#include "messages.h"
#include "nearest.h"

namespace snug::command {
namespace {

// Values of a command line, by the names of options and arguments.
using Given = std::map<std::string, std::vector<std::string>>;

std::vector<std::string> names_of(const std::vector<Command>& commands) {
  std::vector<std::string> names;
  for (const Command& command : commands) names.emplace_back(command.name);
  return names;
}

bool is_option(const std::string& word) { return word.size() > 1 && word.front() == '-'; }

const Option* find_option(const Command& command, const std::string& name) {
  for (const Option& option : command.options.all()) {
    if (!option.is_argument() && (option.name == name || option.former == name)) return &option;
  }
  return nullptr;
}

std::string see_help(const Program& program, const Command& command) {
  return fmt::format("; see {} {} --help", program.name, command.name);
}

[[noreturn]] void refuse_option(const Command& command, const std::string& name) {
  std::vector<std::string> names{"--help"};
  for (const Option& option : command.options.all()) {
    if (!option.is_argument()) names.push_back(option.name);
  }
  throw UsageError("unknown option '" + name + "'" + did_you_mean(name, names));
}

// Of a command line that another program answers.
void refuse_elsewhere(const Program& program, const std::vector<std::string>& words) {
  for (const auto& [command, option, there] : program.elsewhere) {
    if (words.front() != command) continue;
    if (*option == '\0') throw UsageError(fmt::format("{} is {}", command, there));
    if (std::find(words.begin(), words.end(), option) != words.end()) {
      throw UsageError(fmt::format("{} {} is {}", command, option, there));
    }
  }
}

// Old names work for one version.
void note_former(const std::vector<std::string>& words, const std::string& old_name,
                 const std::string& name) {
  if (std::find(words.begin(), words.end(), "--quiet") != words.end()) return;
  print_message(fmt::format("note: {} is now {}; the old name leaves with the next version", old_name, name));
}

// Takes the option that words[i] names, and its value, from there: --name value, --name=value, -n value or -nvalue.
// Returns the place of the last word taken.
std::size_t take_option(const Command& command, const std::vector<std::string>& words, std::size_t i,
                        Given& given) {
  const std::string& word = words[i];
  const bool is_long = word.starts_with("--");
  const std::size_t end = is_long ? std::min(word.find('='), word.size()) : 2;
  const Option* option = find_option(command, word.substr(0, end));
  if (option == nullptr) refuse_option(command, is_long ? word.substr(0, end) : word);
  if (option->former == word.substr(0, end)) note_former(words, option->former, option->name);
  std::vector<std::string>& values = given[option->name];
  const bool joined = end < word.size();
  if (option->is_flag()) {
    if (joined) throw UsageError(option->name + " takes no value");
    values = {"true"};
    return i;
  }
  if (joined) {
    values.push_back(word.substr(end + (is_long ? 1 : 0)));
    return i;
  }
  if (i + 1 == words.size()) throw UsageError(option->name + " needs a value: " + option->value);
  values.push_back(words[i + 1]);
  return i + 1;
}

Given sort_words(const Command& command, const std::vector<std::string>& words) {
  Given given;
  std::deque<std::string> arguments;
  bool options_end = false;  // after "--"
  for (std::size_t i = 0; i < words.size(); ++i) {
    if (options_end || !is_option(words[i])) {
      arguments.push_back(words[i]);
    } else if (words[i] == "--") {
      options_end = true;
    } else {
      i = take_option(command, words, i, given);
    }
  }
  for (const Option& option : command.options.all()) {
    if (!option.is_argument()) continue;
    while (!arguments.empty() && (option.is_list() || !given.contains(option.name))) {
      given[option.name].push_back(arguments.front());
      arguments.pop_front();
    }
  }
  if (!arguments.empty()) throw UsageError("unexpected argument '" + arguments.front() + "'");
  return given;
}

void fill_options(const Program& program, const Command& command, const std::vector<std::string>& words) {
  try {
    if (std::find(words.begin(), words.end(), "%") != words.end()) {
      throw UsageError("'%' is separate; join it to its number (1%), or put quotes around both (\"1 %\")");
    }
    command.options.assign(sort_words(command, words));
  } catch (const UsageError& error) {
    const std::string message = command.name + (": " + std::string(error.what()));
    throw UsageError(message.ends_with('?') ? message : message + see_help(program, command));
  }
}

}  // namespace

Invocation read_command_line(const Program& program, const std::vector<std::string>& words,
                             const std::string& version) {
  const std::vector<Command>& commands = program.commands;
  if (words.empty()) return {nullptr, help_of(program), ExitStatus::usage};
  const std::string& first = words.front();
  if (first == "--completion") {
    if (words.size() != 2 || words[1] != "bash")
      throw UsageError("--completion needs the name of a shell: bash");
    return {nullptr, bash_completion(program)};
  }
  refuse_elsewhere(program, words);
  const auto command = std::find_if(commands.begin(), commands.end(), [&](const Command& candidate) {
    return first == candidate.name || (candidate.former != nullptr && first == candidate.former);
  });
  const bool known = command != commands.end();
  if (known && first != command->name) note_former(words, first, command->name);
  if (!known && !is_option(first)) {
    const std::string guess = did_you_mean(first, names_of(commands));
    throw UsageError("unknown command '" + first + "'" +
                     (guess.empty() ? fmt::format("; see {} --help", program.name) : guess));
  }
  for (const std::string& word : words) {
    if (word == "--help" || word == "-h")
      return {nullptr, known ? help_of(program, *command) : help_of(program)};
    if (word == "--version") return {nullptr, version + "\n"};
  }
  if (!known)
    throw UsageError(
        fmt::format("'{}' comes before the command; write {} COMMAND {}", first, program.name, first));
  fill_options(program, *command, {words.begin() + 1, words.end()});
  return {&*command};
}

}  // namespace snug::command
