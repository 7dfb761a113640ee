#include <snug/io/json.h>

#include <algorithm>
#include <cmath>

#include <support/number.h>
#include <support/text_cursor.h>

namespace snug {
namespace {

class JsonReader {
 public:
  JsonReader(std::string_view text, const std::string& name) : text_(text), name_(name) {}

  Json read() {
    Json value = read_value(0);
    if (peek() != '\0' || at_ < text_.size()) fail("more text follows the value");
    return value;
  }

 private:
  [[noreturn]] void fail(const std::string& message) const {
    fail_in_file(name_, "JSON, byte " + std::to_string(at_) + ": " + message);
  }

  /// The next character but blanks; zero at the end.
  char peek() {
    at_ = std::min(text_.find_first_not_of(" \t\r\n", at_), text_.size());
    return at_ < text_.size() ? text_[at_] : '\0';
  }

  bool take(char c) {
    if (at_ == text_.size() || peek() != c) return false;
    ++at_;
    return true;
  }

  void expect(char c) {
    if (!take(c)) fail(in_quotes({&c, 1}) + " is missing");
  }

  bool take_word(std::string_view word) {
    if (!text_.substr(at_).starts_with(word)) return false;
    at_ += word.size();
    return true;
  }

  Json read_value(unsigned depth) {
    constexpr unsigned most_levels = 100;
    if (depth > most_levels) fail("values are nested deeper than " + std::to_string(most_levels));
    Json value;
    const char first = peek();
    if (first == '{') {
      value.kind = Json::Kind::object;
      read_members(value, depth);
    } else if (first == '[') {
      value.kind = Json::Kind::array;
      read_items(value, depth);
    } else if (first == '"') {
      value.kind = Json::Kind::text;
      value.text = read_text();
    } else if (first == '-' || (first >= '0' && first <= '9')) {
      value.kind = Json::Kind::number;
      value.number = read_number();
    } else if (take_word("true")) {
      value.kind = Json::Kind::boolean;
      value.truth = true;
    } else if (take_word("false")) {
      value.kind = Json::Kind::boolean;
    } else if (!take_word("null")) {
      fail("a value is missing");
    }
    return value;
  }

  void read_members(Json& value, unsigned depth) {
    expect('{');
    if (take('}')) return;
    do {
      if (peek() != '"') fail("the name of a member is missing");
      const std::string_view key = read_text();
      expect(':');
      value.names.push_back(key);
      value.items.push_back(read_value(depth + 1));
    } while (take(','));
    expect('}');
  }

  void read_items(Json& value, unsigned depth) {
    expect('[');
    if (take(']')) return;
    do {
      value.items.push_back(read_value(depth + 1));
    } while (take(','));
    expect(']');
  }

  std::string_view read_text() {
    expect('"');
    const std::size_t begin = at_;
    while (at_ < text_.size() && text_[at_] != '"') at_ += text_[at_] == '\\' ? 2 : 1;
    if (at_ >= text_.size()) {
      at_ = text_.size();
      fail("a string does not end");
    }
    return text_.substr(begin, at_++ - begin);
  }

  double read_number() {
    const std::size_t end = std::min(text_.find_first_not_of("+-.0123456789eE", at_), text_.size());
    const std::string_view word = text_.substr(at_, end - at_);
    const ParsedReal real = parse_real(word);
    if (!real.fault.empty()) fail(in_quotes(word) + ' ' + std::string(real.fault));
    at_ = end;
    return real.value;
  }

  std::string_view text_;
  const std::string& name_;
  std::size_t at_ = 0;
};

}  // namespace

const Json* Json::find(std::string_view name) const {
  for (std::size_t i = names.size(); i-- > 0;) {
    if (names[i] == name) return &items[i];
  }
  return nullptr;
}

std::optional<std::uint64_t> Json::integer() const {
  if (kind != Kind::number || !(number >= 0 && number <= 0x1p53) || number != std::floor(number)) return {};
  return static_cast<std::uint64_t>(number);
}

Json parse_json(std::string_view text, const std::string& name) { return JsonReader(text, name).read(); }

}  // namespace snug
