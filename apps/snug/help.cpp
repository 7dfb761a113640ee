#include <algorithm>
#include <array>
#include <utility>

#include <fmt/core.h>

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
  if (!option.choices.empty()) text += ". One of " + listed(option.choices);
  const std::string value = option.text();
  return value.empty() ? text : text + " (default " + value + ")";
}

constexpr std::array topics{
    std::pair{Topic::two_surfaces, "Two surfaces"},
    std::pair{Topic::one_surface, "One surface, or curves"},
    std::pair{Topic::files, "Meshes and pictures"},
    std::pair{Topic::research, "For research"},
};

constexpr std::array groups{
    std::pair{Group::own, "Options"},   std::pair{Group::placement, "Where the meshes stand"},
    std::pair{Group::mesh, "Meshes"},   std::pair{Group::output, "Output"},
    std::pair{Group::effort, "Effort"}, std::pair{Group::research, "For research"},
};

constexpr const char* statuses =
    "Exit status: 0 answered, 2 usage, 3 unreadable file, 4 refused mesh, 5 tolerance or budget not reached, "
    "130 interrupted.";

}  // namespace

std::string help_of(const std::vector<Command>& commands) {
  std::string text =
      "Tight, proved bounds for the limit surfaces of subdivision meshes, and answers about them.\n\n"
      "Usage: snug COMMAND [OPTIONS] MESH...\n";
  for (const auto& [topic, heading] : topics) {
    text += fmt::format("\n{}:\n", heading);
    for (const Command& command : commands) {
      if (command.topic == topic) text += entry(command.name, command.summary, 10);
    }
  }
  text += "\nExample: do two parts collide, one of them moved by 3 along x?\n";
  text += "  snug collide pawn.obj bust.obj --place-b \"1 0 0 3  0 1 0 0  0 0 1 0\"\n\n";
  text += "snug COMMAND --help lists the options of a command; snug --version names the version.\n";
  return text + wrapped(statuses, 0);
}

std::string help_of(const Command& command) {
  std::string usage = std::string("Usage: snug ") + command.name;
  std::size_t width = 0;
  for (const Option& option : command.options.all()) {
    if (option.is_argument()) usage += " " + (option.must ? option.name : "[" + option.name + "]");
    if (option.is_argument() && option.is_list()) usage += "...";
    width = std::max(width, std::min(name_in_help(option).size(), widest_name));
  }
  std::string text = std::string(command.summary) + ".\n\n" + usage + " [OPTIONS]\n";
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
  text += command.examples.size() > 1 ? "\nExamples:\n" : "\nExample:\n";
  for (const std::string& example : command.examples) text += "  " + example + "\n";
  return text;
}

}  // namespace snug::command
