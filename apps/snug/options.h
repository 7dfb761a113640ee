#pragma once

#include <cstdint>
#include <deque>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <variant>
#include <vector>

/// Options as commands declare them: where --help lists them, and what values they take.
///
///     options.add(Group::own, "--level N", level, "Steps of subdivision").between(0, 12).excludes("--error");
///
/// A bool is a flag, a vector an option that may be given several times; a name without dashes is an argument
/// such as MESH, and must be given.
namespace snug::command {

/// The parts of a command's --help, in this order.
enum class Group { own, placement, mesh, output, effort, research };

/// Where the value goes. What is there when the option is declared is its default.
using Target = std::variant<bool*, std::string*, std::vector<std::string>*, double*, int*, unsigned*,
                            std::uint64_t*, std::optional<std::uint64_t>*>;

/// One option or argument. Each function adds a condition and returns the option.
struct Option {
  Group group;
  std::string name;   ///< "--level", "-o" or "MESH"
  std::string value;  ///< what --help calls the value: "N"; empty for flags and arguments
  std::string help;   ///< one sentence or more, without the choices and the default
  Target target;
  std::vector<std::string> choices{};
  std::map<std::string, std::string> aliases{};  ///< other names of choices, as spelling_of() has them
  std::optional<std::pair<double, double>> range{};
  std::vector<std::string> excluded{}, needed{};
  bool must{};                ///< without it the command cannot run
  std::string replacement{};  ///< or without this other one
  std::string former{};       ///< the name that it had in the version before

  /// The value is one of these words. Neither case nor '-' or '_' inside a word matters: edgeOnly is
  /// edge-only.
  Option& one_of(std::vector<std::string> words);
  /// Another name of a choice.
  Option& alias(const std::string& word, const std::string& choice);
  /// The number is from `low` to `high`.
  Option& between(double low, double high);
  /// Not together with that one.
  Option& excludes(const std::string& other);
  /// Only together with that one.
  Option& needs(const std::string& other);
  Option& required();
  /// Taken under its old name too, with a note.
  Option& formerly(const std::string& old_name);
  /// An argument that must be given unless that option is, and not together with it.
  Option& unless(const std::string& other);

  [[nodiscard]] bool is_argument() const { return !name.starts_with('-'); }
  [[nodiscard]] bool is_flag() const { return std::holds_alternative<bool*>(target); }
  /// May it be given several times?
  [[nodiscard]] bool is_list() const { return std::holds_alternative<std::vector<std::string>*>(target); }
  /// The value now, as text; empty for none.
  [[nodiscard]] std::string text() const;
};

/// Options of one command, in the order in which they were declared.
class OptionList {
 public:
  /// Declares an option. `usage` is its name and, but for flags and arguments, a word for its value: "--level N".
  ///
  /// Requires:  the target outlives the list.
  Option& add(Group group, const std::string& usage, Target target, const std::string& help);
  [[nodiscard]] const std::deque<Option>& all() const { return options_; }
  /// The option of a name.
  /// Requires:  there is one.
  [[nodiscard]] Option& at(const std::string& name);

  /// Puts what the command line gave into the targets: words by the option's name; a flag that is set has one
  /// word.
  ///
  /// Errors:    UsageError that names the option.
  void assign(const std::map<std::string, std::vector<std::string>>& given) const;

 private:
  std::deque<Option> options_;  // references to what add() returned stay good
};

/// Lower case, without '-' and '_'.
[[nodiscard]] std::string spelling_of(const std::string& word);

}  // namespace snug::command
