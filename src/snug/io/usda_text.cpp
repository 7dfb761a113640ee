#include <snug/io/usda_text.h>

#include <algorithm>

#include <support/number.h>
#include <support/text_cursor.h>

namespace snug {
namespace {

bool is_line_end(char c) { return c == '\n' || c == '\r'; }
bool is_blank(char c) { return c == ' ' || (c >= '\t' && c <= '\r'); }

/// Of numbers, keywords and names; bytes beyond ASCII are letters.
bool is_word_character(char c) {
  return (c >= '0' && c <= '9') || (c >= 'A' && c <= 'Z') || (c >= 'a' && c <= 'z') || c == '_' || c == ':' ||
         c == '.' || c == '+' || c == '-' || c == '!' || c == '|' || static_cast<unsigned char>(c) >= 0x80;
}

char closing(char opening) { return opening == '(' ? ')' : opening == '[' ? ']' : '}'; }

}  // namespace

std::string named(const UsdaToken& token) {
  if (token.kind == UsdaToken::Kind::end) return "the end of the file";
  return in_quotes(token.text);
}

UsdaText::UsdaText(std::string_view text, const std::string& name)
    : here_(text.data()), end_(text.data() + text.size()), name_(name) {
  here_ = std::find_if(here_, end_, is_line_end);
  advance();
}

void UsdaText::fail_at(std::size_t line, const std::string& message) const {
  fail_in_file(name_ + ':' + std::to_string(line), message);
}

void UsdaText::count_lines(const char* begin, const char* end) {
  for (const char* c = begin; c != end; ++c) {
    if (*c == '\n' || (*c == '\r' && !(c + 1 != end_ && c[1] == '\n'))) ++line_;
  }
}

void UsdaText::skip_comment(std::string_view end) {
  const std::string_view rest(here_, static_cast<std::size_t>(end_ - here_));
  const std::size_t found = rest.find(end, 2);
  if (found == std::string_view::npos) fail_at(line_, "a comment that begins here does not end");
  count_lines(here_, here_ + found);
  here_ += found + end.size();
}

void UsdaText::skip_blanks() {
  while (here_ != end_) {
    const char* const begin = here_;
    if (is_blank(*here_)) {
      here_ = std::find_if_not(here_, end_, is_blank);
      count_lines(begin, here_);
    } else if (*here_ == '#' || (*here_ == '/' && end_ - here_ > 1 && here_[1] == '/')) {
      here_ = std::find_if(here_, end_, is_line_end);
    } else if (*here_ == '/' && end_ - here_ > 1 && here_[1] == '*') {
      skip_comment("*/");
    } else {
      return;
    }
  }
}

std::string_view UsdaText::take_quoted(std::size_t quote_size, std::string_view quote, bool one_line,
                                       const char* what) {
  here_ += quote_size;
  const char* const begin = here_;
  for (; end_ - here_ >= static_cast<std::ptrdiff_t>(quote.size()); ++here_) {
    if (one_line && is_line_end(*here_)) break;
    if (std::string_view(here_, quote.size()) == quote) {
      const std::string_view taken(begin, static_cast<std::size_t>(here_ - begin));
      here_ += quote.size();
      count_lines(begin, here_);
      return taken;
    }
    const bool escapes = *here_ == '\\' && (quote.front() == '"' || quote.front() == '\'');
    if (escapes && end_ - here_ > 1) ++here_;
  }
  fail_at(next_line_, std::string(what) + " that begins here does not end");
}

void UsdaText::advance() {
  skip_blanks();
  next_line_ = line_;
  if (here_ == end_) {
    next_ = {};
    return;
  }
  const char first = *here_;
  const std::string_view rest(here_, static_cast<std::size_t>(end_ - here_));
  const std::string_view once = rest.substr(0, 1), thrice = rest.substr(0, 3);
  const bool is_triple = thrice.size() == 3 && thrice[1] == first && thrice[2] == first;
  using Kind = UsdaToken::Kind;
  if (first == '"' || first == '\'') {
    next_ = {Kind::text, take_quoted(is_triple ? 3 : 1, is_triple ? thrice : once, !is_triple, "a string")};
  } else if (first == '@') {
    next_ = {Kind::asset, take_quoted(is_triple ? 3 : 1, is_triple ? thrice : once, true, "an asset")};
  } else if (first == '<') {
    next_ = {Kind::path, take_quoted(1, ">", true, "a path")};
  } else if (is_word_character(first)) {
    here_ = std::find_if_not(here_, end_, is_word_character);
    next_ = {Kind::word, rest.substr(0, static_cast<std::size_t>(here_ - rest.data()))};
  } else {
    ++here_;
    next_ = {Kind::mark, once};
  }
}

UsdaToken UsdaText::take() {
  const UsdaToken taken = next_;
  if (taken.kind != UsdaToken::Kind::end) advance();
  return taken;
}

bool UsdaText::take_if(char mark) {
  const bool there = next_.is(mark);
  if (there) advance();
  return there;
}

bool UsdaText::take_if(std::string_view word) {
  const bool there = next_.is(word);
  if (there) advance();
  return there;
}

void UsdaText::expect(char mark, const std::string& where) {
  if (!take_if(mark)) {
    fail(named(next_) + " found where " + in_quotes({&mark, 1}) + " is expected, " + where);
  }
}

void UsdaText::skip_group(char opening) {
  const std::size_t begin = next_line_;
  std::string open{opening};
  while (!open.empty()) {
    const UsdaToken& token = next_;
    if (token.kind == UsdaToken::Kind::end) {
      fail(in_quotes({&open.back(), 1}) +
           " is not closed: the file is truncated, or a bracket is missing, in "
           "line " +
           std::to_string(begin) + " or below");
    }
    if (token.is('(') || token.is('[') || token.is('{')) {
      open += token.text.front();
    } else if (token.is(')') || token.is(']') || token.is('}')) {
      if (token.text.front() != closing(open.back())) {
        fail(named(token) + " does not close " + in_quotes({&open.back(), 1}));
      }
      open.pop_back();
    }
    advance();
  }
}

void UsdaText::skip_value() {
  if (next_.kind == UsdaToken::Kind::mark) {
    const char opening = next_.text.front();
    if (opening != '(' && opening != '[' && opening != '{')
      fail(named(next_) + " found where a value is expected");
    advance();
    skip_group(opening);
    return;
  }
  const UsdaToken taken = take();
  if (taken.kind == UsdaToken::Kind::end) fail("the file ends where a value is expected: it is truncated");
  if (taken.kind == UsdaToken::Kind::asset && next_.kind == UsdaToken::Kind::path) advance();
}

double UsdaText::real(std::string_view what) {
  const ParsedReal parsed = parse_real(next_.kind == UsdaToken::Kind::word ? next_.text : std::string_view());
  if (next_.kind != UsdaToken::Kind::word || !parsed.fault.empty()) {
    fail(std::string(what) + ": " + named(next_) + ' ' +
         std::string(next_.kind == UsdaToken::Kind::word ? parsed.fault : "is not a number"));
  }
  advance();
  return parsed.value;
}

std::vector<double> UsdaText::reals(std::string_view what, std::size_t most) {
  std::vector<double> numbers;
  std::size_t depth = 0;
  do {
    if (take_if('(')) {
      ++depth;
    } else if (depth > 0 && take_if(')')) {
      --depth;
    } else if (depth == 0 || !take_if(',')) {
      if (numbers.size() == most)
        fail(std::string(what) + ": more than " + std::to_string(most) + " numbers");
      numbers.push_back(real(what));
    }
  } while (depth > 0);
  return numbers;
}

}  // namespace snug
