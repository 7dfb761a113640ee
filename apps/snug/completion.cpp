#include "completion.h"

#include <algorithm>

#include <fmt/core.h>

namespace snug::command {
namespace {

// Offers of bash, by a table with these keys:
//
//   "@commands"         the commands
//   "COMMAND"           its options
//   "COMMAND OPTION"    the option's values, or @file, or @none for those that cannot be listed; no key: a flag
//   "COMMAND @mesh"     is there if the command takes meshes
constexpr std::string_view script = R"bash(# bash completion of %NAME%; %NAME% --completion bash prints it.

declare -gA _%FUNCTION%_words=(
%TABLE%)

# File names: of meshes, if $1 is @mesh, else all. The package bash-completion understands quotes and ~, too.
_%FUNCTION%_files() {
  local extensions="@(obj|off|ply|stl)" file
  if declare -F _filedir > /dev/null; then
    if [[ $1 == @mesh ]]; then _filedir "$extensions"; else _filedir; fi
    return
  fi
  compopt -o filenames 2> /dev/null
  while IFS= read -r file; do
    if [[ $1 == @file || -d $file || ${file,,} == *.$extensions ]]; then COMPREPLY+=("$file"); fi
  done < <(compgen -f -- "$cur")
}

# The words of $1 that begin like the one at the cursor.
_%FUNCTION%_words_from() { mapfile -t COMPREPLY < <(compgen -W "$1" -- "$cur"); }

_%FUNCTION%() {
  COMPREPLY=()
  local cur=${COMP_WORDS[COMP_CWORD]} command=${COMP_WORDS[1]} option=${COMP_WORDS[COMP_CWORD - 1]} values=
  if ((COMP_CWORD == 1)); then
    _%FUNCTION%_words_from "${_%FUNCTION%_words[@commands]} --help --version"
    return
  fi
  # --option=value is three words.
  if [[ $cur == "=" ]]; then
    cur=
  elif [[ $option == "=" ]]; then
    option=${COMP_WORDS[COMP_CWORD - 2]}
  fi
  [[ $option == -* ]] && values=${_%FUNCTION%_words[$command $option]-}
  case $values in
    @none) ;;
    @file) _%FUNCTION%_files @file ;;
    "")
      if [[ $cur == -* || -z ${_%FUNCTION%_words[$command @mesh]-} ]]; then
        _%FUNCTION%_words_from "${_%FUNCTION%_words[$command]-} --help"
      else
        _%FUNCTION%_files @mesh
      fi
      ;;
    *) _%FUNCTION%_words_from "$values" ;;
  esac
}

complete -F _%FUNCTION% %NAME%
)bash";

void replace_all(std::string& text, std::string_view what, std::string_view by) {
  for (std::size_t at = text.find(what); at != std::string::npos; at = text.find(what, at + by.size())) {
    text.replace(at, what.size(), by);
  }
}

void append_word(std::string& words, const std::string& word) { words += (words.empty() ? "" : " ") + word; }

std::string values_of(const Option& option) {
  std::string words;
  for (const std::string& choice : option.choices) append_word(words, choice);
  if (!words.empty()) return words;
  return option.value == "FILE" ? "@file" : "@none";
}

// The rows of the table that are about one command.
std::string rows_of(const Command& command) {
  std::string options, rows;
  bool takes_meshes = false;
  for (const Option& option : command.options.all()) {
    if (option.is_argument()) {
      takes_meshes = true;
      continue;
    }
    append_word(options, option.name);
    if (option.is_flag()) continue;
    rows += fmt::format("  [\"{} {}\"]=\"{}\"\n", command.name, option.name, values_of(option));
  }
  if (takes_meshes) rows += fmt::format("  [\"{} @mesh\"]=\"@mesh\"\n", command.name);
  return fmt::format("  [\"{}\"]=\"{}\"\n", command.name, options) + rows;
}

}  // namespace

std::string bash_completion(const Program& program) {
  std::string names, rows;
  for (const Command& command : program.commands) {
    append_word(names, command.name);
    rows += rows_of(command);
  }
  rows = fmt::format("  [\"@commands\"]=\"{}\"\n", names) + rows;
  std::string function = program.name;
  std::replace(function.begin(), function.end(), '-', '_');
  std::string text(script);
  replace_all(text, "%FUNCTION%", function);
  replace_all(text, "%NAME%", program.name);
  replace_all(text, "%TABLE%", rows);
  return text;
}

}  // namespace snug::command
