#include "options.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <type_traits>

#include <fmt/core.h>
#include <support/names.h>

#include "length.h"
#include "nearest.h"

namespace snug::command {
namespace {

// The choice that the word names.
std::string choose(const Option& option, const std::string& word) {
  const std::string spelling = spelling_of(word);
  for (const std::string& choice : option.choices) {
    if (spelling_of(choice) == spelling) return choice;
  }
  if (const auto alias = option.aliases.find(spelling); alias != option.aliases.end()) return alias->second;
  throw UsageError(fmt::format("{}: '{}' is not {}{}", option.name, word, listed(option.choices, "or"),
                               did_you_mean(word, option.choices)));
}

// The word as a number of this type within the option's range.
template <class Number>
Number number_of(const Option& option, const std::string& word) {
  Number number{};
  const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), number);
  const bool whole = std::is_integral_v<Number>;
  const bool read = error == std::errc() && end == word.data() + word.size() && !word.empty() &&
                    (whole || std::isfinite(static_cast<double>(number)));
  const auto value = static_cast<double>(number);
  if (read && (!option.range || (option.range->first <= value && value <= option.range->second))) {
    return number;
  }
  std::string wanted = whole ? "a whole number" : "a finite number";
  if (option.range) {
    const bool both_whole = std::trunc(option.range->first) == option.range->first &&
                            std::trunc(option.range->second) == option.range->second;
    wanted += both_whole ? fmt::format(" from {:.0f} to {:.0f}", option.range->first, option.range->second)
                         : fmt::format(" from {} to {}", option.range->first, option.range->second);
  } else if (std::is_unsigned_v<Number>) {
    wanted += " from 0";
  }
  throw UsageError(fmt::format("{}: '{}' is not {}", option.name, word, wanted));
}

// Puts the words of one option into its target.
struct Assign {
  const Option& option;
  const std::vector<std::string>& words;

  void operator()(bool* target) const { *target = words.back() == "true"; }
  void operator()(std::string* target) const {
    *target = option.choices.empty() ? words.back() : choose(option, words.back());
  }
  void operator()(std::vector<std::string>* target) const { *target = words; }
  template <class Number>
  void operator()(std::optional<Number>* target) const {
    *target = number_of<Number>(option, words.back());
  }
  template <class Number>
  void operator()(Number* target) const {
    // Numbers with choices, such as degrees, are listed as words.
    *target = number_of<Number>(option, option.choices.empty() ? words.back() : choose(option, words.back()));
  }
};

struct TextOf {
  std::string operator()(const bool*) const { return {}; }
  std::string operator()(const std::string* value) const { return *value; }
  std::string operator()(const std::vector<std::string>*) const { return {}; }
  template <class Number>
  std::string operator()(const std::optional<Number>* value) const {
    return *value ? fmt::format("{}", **value) : "";
  }
  template <class Number>
  std::string operator()(const Number* value) const {
    return fmt::format("{}", *value);
  }
};

}  // namespace

std::string spelling_of(const std::string& word) {
  std::string spelling;
  for (const char c : word) {
    if (c == '-' || c == '_') continue;
    spelling += 'A' <= c && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
  }
  return spelling;
}

Option& Option::one_of(std::vector<std::string> words) {
  choices = std::move(words);
  return *this;
}

Option& Option::alias(const std::string& word, const std::string& choice) {
  aliases[spelling_of(word)] = choice;
  return *this;
}

Option& Option::between(double low, double high) {
  range = {low, high};
  return *this;
}

Option& Option::excludes(const std::string& other) {
  excluded.push_back(other);
  return *this;
}

Option& Option::needs(const std::string& other) {
  needed.push_back(other);
  return *this;
}

Option& Option::required() {
  must = true;
  return *this;
}

Option& Option::formerly(const std::string& old_name) {
  former = old_name;
  return *this;
}

Option& Option::unless(const std::string& other) {
  replacement = other;
  return excludes(other);
}

std::string Option::text() const { return std::visit(TextOf{}, target); }

Option& OptionList::add(Group group, const std::string& usage, Target target, const std::string& help) {
  const auto blank = usage.find(' ');
  options_.push_back({group, usage.substr(0, blank),
                      blank == std::string::npos ? "" : usage.substr(blank + 1), help, target});
  Option& option = options_.back();
  if (option.is_argument()) option.required();
  return option;
}

Option& OptionList::at(const std::string& name) {
  return *std::find_if(options_.begin(), options_.end(),
                       [&](const Option& option) { return option.name == name; });
}

void OptionList::assign(const std::map<std::string, std::vector<std::string>>& given) const {
  for (const Option& option : options_) {
    const auto words = given.find(option.name);
    if (words == given.end()) {
      if (option.must && !given.contains(option.replacement)) {
        throw UsageError(option.name + " is missing");
      }
      continue;
    }
    for (const std::string& other : option.excluded) {
      if (given.contains(other)) throw UsageError(option.name + " and " + other + " exclude each other");
    }
    for (const std::string& other : option.needed) {
      if (!given.contains(other)) throw UsageError(option.name + " needs " + other);
    }
    if (!option.is_list() && !option.is_flag() && words->second.size() > 1) {
      throw UsageError(option.name + " is given twice");
    }
    std::visit(Assign{option, words->second}, option.target);
  }
}

}  // namespace snug::command
