#include <support/text_cursor.h>

#include <utility>

#include <support/error.h>
#include <support/number.h>

namespace snug {
namespace {

bool is_blank(char c) { return c == ' ' || c == '\t' || c == '\v' || c == '\f'; }
bool is_line_end(char c) { return c == '\n' || c == '\r'; }

}  // namespace

TextCursor::TextCursor(std::string_view text, std::string name, std::size_t line)
    : here_(text.data()), end_(text.data() + text.size()), name_(std::move(name)), line_(line) {}

void TextCursor::skip_line_end() {
  const bool carriage_return = *here_ == '\r';
  ++here_;
  if (carriage_return && here_ != end_ && *here_ == '\n') ++here_;
  ++line_;
}

bool TextCursor::next_line() {
  if (line_ == 0) {
    line_ = 1;
    return here_ != end_;
  }
  while (here_ != end_ && !is_line_end(*here_)) ++here_;
  if (here_ == end_) return false;
  skip_line_end();
  if (here_ != end_) return true;
  --line_;  // messages about the end name the last line
  return false;
}

void TextCursor::skip_blanks() {
  for (;;) {
    while (here_ != end_ && is_blank(*here_)) ++here_;
    const bool joins = end_ - here_ >= 2 && here_[0] == '\\' && is_line_end(here_[1]);
    if (!joins) return;
    ++here_;
    skip_line_end();
  }
}

std::string_view TextCursor::word() {
  skip_blanks();
  const char* const begin = here_;
  if (here_ != end_ && *here_ == '#') return {};
  while (here_ != end_ && !is_blank(*here_) && !is_line_end(*here_)) {
    if (*here_ == '\\' && end_ - here_ >= 2 && is_line_end(here_[1])) break;
    ++here_;
  }
  return {begin, static_cast<std::size_t>(here_ - begin)};
}

std::string_view TextCursor::word_across_lines() {
  if (line_ == 0) next_line();
  std::string_view found = word();
  while (found.empty() && next_line()) found = word();
  return found;
}

bool TextCursor::more_in_line() const {
  TextCursor ahead = *this;
  return !ahead.word().empty();
}

std::size_t TextCursor::count_lines_with_words() const {
  TextCursor ahead = *this;
  std::size_t count = 0;
  do {
    if (!ahead.word().empty()) ++count;
  } while (ahead.next_line());
  return count;
}

std::string TextCursor::located(const std::string& message) const {
  return name_ + ':' + std::to_string(line_) + ": " + message;
}

void TextCursor::fail(const std::string& message) const { fail_at(line_, message); }

void TextCursor::fail_at(std::size_t line, const std::string& message) const {
  fail_in_file(name_ + ':' + std::to_string(line), message);
}

void TextCursor::fail_everywhere(const std::string& message) const { fail_in_file(name_, message); }

std::string in_quotes(std::string_view word) {
  constexpr std::size_t longest = 40;
  constexpr std::string_view hex = "0123456789abcdef";
  std::string result = "'";
  for (const char c : word.substr(0, longest)) {
    const auto byte = static_cast<unsigned char>(c);
    if (byte >= 0x20 && byte < 0x7f) {
      result += c;
    } else {
      result += {'\\', 'x', hex[byte >> 4], hex[byte & 15]};
    }
  }
  return result += word.size() > longest ? "...'" : "'";
}

void fail_in_file(const std::string& name, const std::string& message) {
  throw InputError(InputProblem::unreadable, name + ": " + message);
}

double read_coordinate(const TextCursor& at, std::size_t vertex, std::string_view word) {
  const ParsedReal real = parse_real(word);
  if (!real.fault.empty()) {
    const std::string vertex_name = "vertex " + std::to_string(vertex);
    if (word.empty()) at.fail(vertex_name + " has fewer than three coordinates");
    at.fail(vertex_name + ": " + in_quotes(word) + ' ' + std::string(real.fault));
  }
  return real.value;
}

void expect_room(const TextCursor& at, std::size_t count, const char* what) {
  if (count >= max_elements) {
    at.fail("more than " + std::to_string(max_elements) + ' ' + what + ": split the mesh");
  }
}

void expect_elements(const TextCursor& at, std::size_t vertices, std::size_t faces) {
  if (vertices == 0) at.fail_everywhere("the file has no vertices");
  if (faces == 0) at.fail_everywhere("the file has no faces");
}

}  // namespace snug
