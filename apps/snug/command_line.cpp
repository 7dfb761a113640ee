#include "command_line.h"

#include <algorithm>
#include <map>
#include <optional>

#include <fmt/core.h>
#include <CLI/CLI.hpp>

#include "length.h"
#include "nearest.h"

namespace snug::command {
namespace {

// The words of each option, and those that belong to none.
struct Sorted {
  std::map<std::string, std::vector<std::string>> given;
  std::vector<std::string> left_over;
  std::string problem = {};  // empty for none
};

// Sorts a command's words; what they mean is for the options to say.
Sorted sort_words(const Command& command, std::vector<std::string> words) {
  CLI::App app;
  app.set_help_flag();
  app.allow_extras();
  std::map<std::string, std::vector<std::string>> values;  // as CLI11 has converted them, which is not wanted
  std::map<std::string, bool> flags;
  for (const Option& option : command.options.all()) {
    if (option.is_flag()) {
      app.add_flag(option.name, flags[option.name]);
      continue;
    }
    CLI::Option* added = app.add_option(option.name, values[option.name]);
    if (option.is_argument() && option.is_list()) continue;
    added->expected(1)->allow_extra_args(false)->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
  }
  Sorted result;
  std::reverse(words.begin(), words.end());  // the order that CLI11 wants
  try {
    app.parse(std::move(words));
  } catch (const CLI::ParseError& error) {
    result.problem = error.what();
  }
  result.left_over = app.remaining();
  for (const auto& [name, set] : flags) {
    if (app.get_option(name)->count() > 0) result.given[name] = {set ? "true" : "false"};
  }
  for (const auto& [name, converted] : values) {
    const std::vector<std::string>& list = app.get_option(name)->results();
    if (!list.empty()) result.given[name] = list;
  }
  return result;
}

std::vector<std::string> names_of(const std::vector<Command>& commands) {
  std::vector<std::string> names;
  for (const Command& command : commands) names.emplace_back(command.name);
  return names;
}

bool is_option(const std::string& word) { return word.size() > 1 && word.front() == '-'; }

// Says what is wrong with a word that no option or argument took.
[[noreturn]] void refuse_word(const Command& command, const std::string& word) {
  const std::string help = std::string("; see snug ") + command.name + " --help";
  if (!is_option(word)) {
    throw UsageError(fmt::format("{}: unexpected argument '{}'{}", command.name, word, help));
  }
  std::vector<std::string> names{"--help"};
  for (const Option& option : command.options.all()) {
    if (!option.is_argument()) names.push_back(option.name);
  }
  const std::string guess = did_you_mean(word.substr(0, word.find('=')), names);
  throw UsageError(
      fmt::format("{}: unknown option '{}'{}", command.name, word, guess.empty() ? help : guess));
}

void fill_options(const Command& command, const std::vector<std::string>& words) {
  if (std::find(words.begin(), words.end(), "%") != words.end()) {
    throw UsageError(std::string(command.name) +
                     ": '%' stands alone; join it to its number (1%), or put quotes around both (\"1 %\")");
  }
  const Sorted sorted = sort_words(command, words);
  const auto unknown = std::find_if(sorted.left_over.begin(), sorted.left_over.end(), is_option);
  if (unknown != sorted.left_over.end()) refuse_word(command, *unknown);
  const std::string help = std::string("; see snug ") + command.name + " --help";
  if (!sorted.problem.empty()) throw UsageError(command.name + (": " + sorted.problem) + help);
  if (!sorted.left_over.empty()) refuse_word(command, sorted.left_over.front());
  try {
    command.options.assign(sorted.given);
  } catch (const UsageError& error) {
    const std::string message = command.name + (": " + std::string(error.what()));
    throw UsageError(message.ends_with('?') ? message : message + help);
  }
}

}  // namespace

Invocation read_command_line(const std::vector<Command>& commands, const std::vector<std::string>& words,
                             const std::string& version) {
  if (words.empty()) return {nullptr, help_of(commands), ExitStatus::usage};
  const std::string& first = words.front();
  const auto command = std::find_if(commands.begin(), commands.end(),
                                    [&](const Command& candidate) { return first == candidate.name; });
  const bool known = command != commands.end();
  if (!known && !is_option(first)) {
    const std::string guess = did_you_mean(first, names_of(commands));
    throw UsageError("unknown command '" + first + "'" + (guess.empty() ? "; see snug --help" : guess));
  }
  for (const std::string& word : words) {
    if (word == "--help" || word == "-h") return {nullptr, known ? help_of(*command) : help_of(commands)};
    if (word == "--version") return {nullptr, version + "\n"};
  }
  if (!known) throw UsageError("'" + first + "' comes before the command; write snug COMMAND " + first);
  fill_options(*command, {words.begin() + 1, words.end()});
  return {&*command};
}

}  // namespace snug::command
