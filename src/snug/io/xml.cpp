#include <snug/io/xml.h>

#include <algorithm>
#include <charconv>

#include <snug/io/utf8.h>
#include <support/number.h>
#include <support/text_cursor.h>

namespace snug {
namespace {

constexpr std::string_view xml_blanks = " \t\r\n";

bool ends_name(char c) {
  return xml_blanks.find(c) != std::string_view::npos || c == '=' || c == '/' || c == '>' || c == '<' ||
         c == '"' || c == '\'';
}

}  // namespace

std::string_view XmlReader::prefix_of(std::string_view name) {
  const std::size_t colon = name.find(':');
  return colon == std::string_view::npos ? std::string_view() : name.substr(0, colon);
}

std::string_view XmlReader::local_name_of(std::string_view name) { return name.substr(name.find(':') + 1); }

std::size_t XmlReader::line() const {
  lines_ += static_cast<std::size_t>(std::count(text_.begin() + static_cast<std::ptrdiff_t>(counted_),
                                                text_.begin() + static_cast<std::ptrdiff_t>(tag_), '\n'));
  counted_ = tag_;
  return lines_;
}

void XmlReader::fail(const std::string& message) const {
  fail_in_file(name_ + ':' + std::to_string(line()), message);
}

void XmlReader::skip_blanks() {
  while (at_ < text_.size() && xml_blanks.find(text_[at_]) != std::string_view::npos) ++at_;
}

void XmlReader::skip_past(std::string_view end, const char* what) {
  const std::size_t found = text_.find(end, at_);
  if (found == std::string_view::npos)
    fail(std::string("XML: ") + what + " has no end: the file is truncated");
  at_ = found + end.size();
}

std::string_view XmlReader::take_name() {
  const std::size_t begin = at_;
  while (at_ < text_.size() && !ends_name(text_[at_])) ++at_;
  const std::string_view name = text_.substr(begin, at_ - begin);
  if (name.empty()) fail("XML: a name is missing");
  return name;
}

void XmlReader::read_attributes() {
  attributes_.clear();
  while (true) {
    skip_blanks();
    if (at_ >= text_.size()) fail("XML: a tag has no end: the file is truncated");
    if (text_[at_] == '>' || text_[at_] == '/') return;
    const std::string_view name = take_name();
    skip_blanks();
    if (at_ >= text_.size() || text_[at_] != '=') fail("XML: " + in_quotes(name) + " has no value");
    ++at_;
    skip_blanks();
    const char quote = at_ < text_.size() ? text_[at_] : ' ';
    if (quote != '"' && quote != '\'') fail("XML: the value of " + in_quotes(name) + " is not in quotes");
    const std::size_t begin = ++at_, end = text_.find(quote, begin);
    if (end == std::string_view::npos) fail("XML: the value of " + in_quotes(name) + " has no end");
    at_ = end + 1;
    attributes_.push_back({prefix_of(name), local_name_of(name), text_.substr(begin, end - begin)});
    // Few in all real files: an index would cost more than it saves.
    if (attributes_.size() > 256) fail("XML: more than 256 attributes of one element");
  }
}

XmlReader::Event XmlReader::next() {
  if (pending_end_) {
    pending_end_ = false;
    open_.pop_back();
    return Event::end;
  }
  while (true) {
    const std::size_t tag = text_.find('<', at_);
    if (open_.empty()) {
      const std::string_view between = text_.substr(at_, tag == std::string_view::npos ? tag : tag - at_);
      if (between.find_first_not_of(xml_blanks) != std::string_view::npos)
        fail("XML: text outside of all elements");
    }
    if (tag == std::string_view::npos) {
      if (!open_.empty()) fail("XML: " + in_quotes(open_.back()) + " has no end: the file is truncated");
      if (!any_) fail("XML: no element");
      return Event::done;
    }
    tag_ = tag;
    at_ = tag + 1;
    const std::string_view rest = text_.substr(at_);
    if (rest.starts_with("!--")) {
      at_ += 3;
      skip_past("-->", "a comment");
    } else if (rest.starts_with("![CDATA[")) {
      skip_past("]]>", "a CDATA section");
    } else if (rest.starts_with('?')) {
      skip_past("?>", "an instruction");
    } else if (rest.starts_with('!')) {
      fail("XML: a document type, as in <!DOCTYPE>: entities are not read; take it out");
    } else if (rest.starts_with('/')) {
      ++at_;
      element_ = take_name();
      skip_blanks();
      if (at_ >= text_.size() || text_[at_] != '>')
        fail("XML: the end of " + in_quotes(element_) + " has no '>'");
      ++at_;
      if (open_.empty() || open_.back() != element_) {
        fail("XML: " + in_quotes(element_) + " ends where " +
             (open_.empty() ? std::string("nothing") : in_quotes(open_.back())) + " is open");
      }
      attributes_.clear();
      open_.pop_back();
      return Event::end;
    } else {
      if (open_.empty() && any_) fail("XML: a second element beside the first");
      element_ = take_name();
      read_attributes();
      if (text_[at_] == '/') {
        ++at_;
        pending_end_ = true;
      }
      if (at_ >= text_.size() || text_[at_] != '>')
        fail("XML: the tag " + in_quotes(element_) + " has no '>'");
      ++at_;
      open_.push_back(element_);
      any_ = true;
      return Event::begin;
    }
  }
}

void XmlReader::skip() {
  for (std::size_t open = 1; open > 0;) {
    const Event event = next();
    open += event == Event::begin ? 1 : 0;
    open -= event == Event::end ? 1 : 0;
  }
}

std::string XmlReader::decoded(std::string_view value) const {
  std::string text;
  while (true) {
    const std::size_t mark = value.find('&');
    text += value.substr(0, mark);
    if (mark == std::string_view::npos) return text;
    value.remove_prefix(mark + 1);
    const std::size_t end = value.find(';');
    const std::string_view name = value.substr(0, end);
    std::uint32_t code = 0;
    if (name == "lt") {
      code = '<';
    } else if (name == "gt") {
      code = '>';
    } else if (name == "amp") {
      code = '&';
    } else if (name == "quot") {
      code = '"';
    } else if (name == "apos") {
      code = '\'';
    } else if (name.starts_with('#')) {
      const bool hexadecimal = name.starts_with("#x");
      const std::string_view number = name.substr(hexadecimal ? 2 : 1);
      const auto [last, error] =
          std::from_chars(number.data(), number.data() + number.size(), code, hexadecimal ? 16 : 10);
      if (error != std::errc() || last != number.data() + number.size()) code = 0;
    }
    if (end == std::string_view::npos || code == 0 || code > 0x10ffff || (code >= 0xd800 && code < 0xe000))
      fail("XML: " + in_quotes("&" + std::string(name)) + " is no entity that is read");
    append_utf8(text, code);
    value.remove_prefix(end + 1);
  }
}

std::string_view XmlReader::raw(std::string_view name) const {
  for (const Attribute& own : attributes_) {
    if (own.prefix.empty() && own.name == name) return own.value;
  }
  return {};
}

std::optional<std::string> XmlReader::text(std::string_view name) const {
  for (const Attribute& own : attributes_) {
    if (own.prefix.empty() && own.name == name) return decoded(own.value);
  }
  return {};
}

std::string XmlReader::required_text(std::string_view name) const {
  auto value = text(name);
  if (!value) fail(in_quotes(element()) + " has no " + in_quotes(name));
  return *std::move(value);
}

double XmlReader::number(std::string_view name) const {
  const std::string_view word = raw(name);
  if (word.empty()) fail(in_quotes(element()) + " has no " + in_quotes(name));
  const ParsedReal number = parse_real(word);
  if (!number.fault.empty())
    fail(std::string(name) + ": " + in_quotes(word) + ' ' + std::string(number.fault));
  return number.value;
}

std::uint64_t XmlReader::count(std::string_view name) const {
  const std::string_view word = raw(name);
  if (word.empty()) fail(in_quotes(element()) + " has no " + in_quotes(name));
  const std::optional<std::int64_t> number = parse_integer(word);
  if (!number || *number < 0)
    fail(std::string(name) + ": " + in_quotes(word) + " is not a whole number >= 0");
  return static_cast<std::uint64_t>(*number);
}

std::vector<double> numbers_of(const XmlReader& at, std::string_view attribute, std::string_view text,
                               std::size_t count) {
  std::vector<double> numbers;
  for (std::size_t begin = text.find_first_not_of(xml_blanks); begin != std::string_view::npos;) {
    const std::size_t end = std::min(text.find_first_of(xml_blanks, begin), text.size());
    const std::string_view word = text.substr(begin, end - begin);
    const ParsedReal number = parse_real(word);
    if (!number.fault.empty())
      at.fail(std::string(attribute) + ": " + in_quotes(word) + ' ' + std::string(number.fault));
    numbers.push_back(number.value);
    begin = text.find_first_not_of(xml_blanks, end);
  }
  if (numbers.size() != count) {
    at.fail(std::string(attribute) + " has " + std::to_string(numbers.size()) + " numbers, not " +
            std::to_string(count));
  }
  return numbers;
}

}  // namespace snug
