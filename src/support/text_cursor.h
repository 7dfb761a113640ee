#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

namespace snug {

/// Walks over the lines and words of a text, and knows the line for messages.
///
/// Lines end with LF, CR LF or CR; the last one may have no end. Words are separated by blanks. A word that
/// would begin with '#' is a comment to the end of its line. A backslash that ends a line continues it on the
/// next one, for words only: what is never asked for as a word (comments, statements that are skipped) is not
/// continued, so a comment that ends in "C:\" does not swallow a vertex.
///
/// Requires:  the text outlives the cursor and the words.
class TextCursor {
 public:
  /// For the rest of a text: stands at the beginning of the line of this number.
  TextCursor(std::string_view text, std::string name, std::size_t line = 0);

  /// Steps to the next line, at first to line 1; false when there is none.
  bool next_line();
  /// The next word of this line; empty at its end.
  std::string_view word();
  /// The next word of this or a later line; empty at the end of the text.
  std::string_view word_across_lines();
  /// Whether the current line holds another word; does not move.
  [[nodiscard]] bool more_in_line() const;

  /// Counts from 1.
  [[nodiscard]] std::size_t line() const noexcept { return line_; }
  [[nodiscard]] std::size_t bytes_left() const noexcept { return static_cast<std::size_t>(end_ - here_); }
  /// The lines from here on that hold a word, this one included.
  [[nodiscard]] std::size_t count_lines_with_words() const;

  /// Throws InputError (unreadable) "name:line: message" for the current line.
  [[noreturn]] void fail(const std::string& message) const;
  /// The same for another line.
  [[noreturn]] void fail_at(std::size_t line, const std::string& message) const;
  /// The same for the text as a whole: "name: message".
  [[noreturn]] void fail_everywhere(const std::string& message) const;
  /// "name:line: message" for the current line.
  [[nodiscard]] std::string located(const std::string& message) const;

 private:
  void skip_blanks();
  void skip_line_end();

  const char* here_;
  const char* end_;
  std::string name_;
  std::size_t line_ = 0;
};

/// The word in single quotes, fit for a message of one line: bytes that are not printable ASCII become \xNN,
/// and of a word longer than 40 bytes the rest becomes "...".
[[nodiscard]] std::string in_quotes(std::string_view word);

/// Throws InputError (unreadable) "name: message".
[[noreturn]] void fail_in_file(const std::string& name, const std::string& message);

/// More vertices, faces or face corners than this do not fit 32-bit ids.
inline constexpr std::uint64_t max_elements = 0xFFFFFFFE;

/// The coordinate of a vertex that a word is. Fails, naming vertex and word, unless it is a finite number.
[[nodiscard]] double read_coordinate(const TextCursor& at, std::size_t vertex, std::string_view word);
/// Fails unless one more element fits; `what` is the plural of its sort.
void expect_room(const TextCursor& at, std::size_t count, const char* what);
/// Fails if there are no vertices or no faces.
void expect_elements(const TextCursor& at, std::size_t vertices, std::size_t faces);

}  // namespace snug
