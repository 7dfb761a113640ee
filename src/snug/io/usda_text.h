#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace snug {

/// A token of USD's text format.
struct UsdaToken {
  enum class Kind : std::uint8_t {
    end,
    word,   ///< a number, a name with its namespaces and suffix, a keyword
    text,   ///< between quotes, escapes as they are
    asset,  ///< between @ or @@@
    path,   ///< between < and >
    mark,   ///< one of ( ) [ ] { } = , ; or another lone character
  };
  Kind kind = Kind::end;
  std::string_view text;

  [[nodiscard]] bool is(char mark) const { return kind == Kind::mark && text.front() == mark; }
  [[nodiscard]] bool is(std::string_view word) const { return kind == Kind::word && text == word; }
};

/// Walks over the tokens of a USD text, and knows the line for messages. Blanks, line ends and comments
/// (`#`, `//` and `/* */`) separate tokens.
///
/// Guarantee: nothing recurses: values may be nested as deeply as the text is long.
/// Requires:  the text and the name outlive the cursor; the text outlives the tokens.
/// Errors:    InputError (unreadable) "name:line: message": a string, path or comment that does not end, and
///            those of each function.
/// Cost:      linear in the text.
class UsdaText {
 public:
  /// Stands behind the first line, which is the header of the format.
  UsdaText(std::string_view text, const std::string& name);

  [[nodiscard]] const UsdaToken& peek() const { return next_; }
  UsdaToken take();
  /// Takes the next token if it is this one.
  bool take_if(char mark);
  bool take_if(std::string_view word);
  /// Takes this mark; fails on another token. `where` ends the message: "in the metadata".
  void expect(char mark, const std::string& where);
  /// Of the next token; of the last one at the end.
  [[nodiscard]] std::size_t line() const { return next_line_; }

  /// Takes a value of any type: a string, word, path, or what brackets enclose. Fails on anything else, and
  /// where brackets do not match.
  void skip_value();
  /// Takes what is left of a group whose opening bracket has been taken.
  void skip_group(char opening);

  /// A finite number. `what` begins messages: "points".
  [[nodiscard]] double real(std::string_view what);
  /// The numbers of a value, in any tuples: at most `most`.
  [[nodiscard]] std::vector<double> reals(std::string_view what, std::size_t most);
  /// Calls item() for the items of a list in square brackets, which takes each.
  template <class Item>
  void list(std::string_view what, const Item& item) {
    expect('[', "before the values of " + std::string(what));
    while (!take_if(']')) {
      item();
      if (!peek().is(']')) expect(',', "between the values of " + std::string(what));
    }
  }

  [[noreturn]] void fail(const std::string& message) const { fail_at(next_line_, message); }
  [[noreturn]] void fail_at(std::size_t line, const std::string& message) const;

 private:
  void advance();
  void skip_blanks();
  void skip_comment(std::string_view end);
  void count_lines(const char* begin, const char* end);
  [[nodiscard]] std::string_view take_quoted(std::size_t quote_size, std::string_view quote, bool one_line,
                                             const char* what);

  const char* here_;  // behind the next token
  const char* end_;
  const std::string& name_;
  UsdaToken next_;
  std::size_t next_line_ = 1, line_ = 1;  // of the next token; of here_
};

/// The token in single quotes, for messages; "the end of the file" if it is that.
[[nodiscard]] std::string named(const UsdaToken& token);

}  // namespace snug
