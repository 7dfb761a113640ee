#include <algorithm>
#include <array>
#include <utility>

#include <fmt/core.h>
#include <support/names.h>

#include "command_line.h"

namespace snug::command {
namespace {

constexpr std::size_t page_width = 96, widest_name = 22;

// Breaks a text into lines that begin at `indent`; the first one is already there.
std::string wrapped(const std::string& text, std::size_t indent) {
  std::string result;
  std::size_t column = indent;
  for (std::size_t at = 0; at < text.size();) {
    const std::size_t end = std::min(text.find(' ', at), text.size());
    const std::size_t length = end - at;
    if (column > indent && column + 1 + length > page_width) {
      result += "\n" + std::string(indent, ' ');
      column = indent;
    }
    if (column > indent) {
      result += ' ';
      ++column;
    }
    result += text.substr(at, length);
    column += length;
    at = end + 1;
  }
  return result + "\n";
}

// "  NAME   text", where the text of all lines of a list begins in one column.
std::string entry(const std::string& name, const std::string& text, std::size_t width) {
  const std::size_t indent = width + 4;
  std::string line = fmt::format("  {:<{}}  ", name, width);
  if (name.size() > width) line = "  " + name + "\n" + std::string(indent, ' ');
  return line + wrapped(text, indent);
}

std::string name_in_help(const Option& option) {
  return option.value.empty() ? option.name : option.name + " " + option.value;
}

std::string text_in_help(const Option& option) {
  std::string text = option.help;
  if (!option.choices.empty()) text += ". One of " + listed(option.choices, "or");
  const std::string value = option.text();
  const bool stands_for_none = option.range && option.range->first > 0 && value == "0";
  return value.empty() || stands_for_none ? text : text + " (default " + value + ")";
}

constexpr std::array topics{
    std::pair{Topic::two_surfaces, "Two surfaces"},
    std::pair{Topic::one_surface, "One surface, or curves"},
    std::pair{Topic::files, "Meshes and pictures"},
    std::pair{Topic::functions, "Nodal functions"},
    std::pair{Topic::tables, "Tables and figures of the dissertation"},
    std::pair{Topic::comparisons, "Alternatives that were not adopted"},
};

constexpr std::array groups{
    std::pair{Group::own, "Options"},   std::pair{Group::placement, "Poses"},
    std::pair{Group::mesh, "Meshes"},   std::pair{Group::output, "Output"},
    std::pair{Group::effort, "Effort"}, std::pair{Group::research, "For research"},
};

constexpr const char* statuses =
    "0 answered, 2 usage, 3 unreadable file, 4 refused mesh, 5 not as narrow or as fine as requested, "
    "130 interrupted.";

}  // namespace

// Headings stand alone on their lines, and what is below them is indented: manual pages are made of it.
std::string help_of(const Program& program) {
  std::string text =
      fmt::format("{}\n\nUsage: {} COMMAND [OPTIONS] MESH...\n\n", program.summary, program.name);
  text += fmt::format("{0} COMMAND --help lists the options of a command; {0} --version names the version.\n",
                      program.name);
  for (const auto& [topic, heading] : topics) {
    std::string list;
    for (const Command& command : program.commands) {
      if (command.topic == topic) list += entry(command.name, command.summary, 12);
    }
    if (!list.empty()) text += fmt::format("\n{}:\n{}", heading, list);
  }
  if (program.see_also) text += "\nResearch:\n  " + wrapped(program.see_also, 2);
  text += "\nExit status:\n  " + wrapped(statuses, 2);
  return text + fmt::format("\nExamples:\n  {}\n  {}\n", program.question, program.example);
}

std::string help_of(const Program& program, const Command& command) {
  std::string usage = fmt::format("Usage: {} {}", program.name, command.name);
  std::size_t width = 0;
  for (const Option& option : command.options.all()) {
    if (option.is_argument()) usage += " " + (option.must ? option.name : "[" + option.name + "]");
    if (option.is_argument() && option.is_list()) usage += "...";
    width = std::max(width, std::min(name_in_help(option).size(), widest_name));
  }
  std::string text(command.summary);
  if (!text.ends_with('?')) text += '.';
  text += "\n\n" + usage + " [OPTIONS]\n";
  for (const Option& option : command.options.all()) {
    if (option.is_argument()) text += entry(option.name, text_in_help(option), width);
  }
  for (const auto& [group, heading] : groups) {
    std::string list;
    for (const Option& option : command.options.all()) {
      if (option.group == group && !option.is_argument()) {
        list += entry(name_in_help(option), text_in_help(option), width);
      }
    }
    if (!list.empty()) text += fmt::format("\n{}:\n{}", heading, list);
  }
  text += "\nExamples:\n";
  for (const std::string& example : command.examples) text += "  " + example + "\n";
  return text;
}

}  // namespace snug::command
