#include "number_rows.h"

#include <algorithm>
#include <charconv>
#include <cstdint>
#include <optional>
#include <vector>

#include <support/binary.h>
#include <support/number.h>
#include <support/text_cursor.h>

namespace snug {
namespace {

constexpr std::string_view magic = "\x93NUMPY";

bool is_blank(char c) { return c == ' ' || c == '\t' || c == '\r'; }
bool is_separator(char c) { return c == ',' || c == ';'; }

std::optional<double> number(std::string_view word) {
  if (word.size() > 1 && word.front() == '+' && word[1] != '-') word.remove_prefix(1);
  double value = 0;
  const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
  if (error == std::errc::result_out_of_range) {  // too near to zero is zero
    const ParsedReal real = parse_real(word);
    return real.fault.empty() ? std::optional(real.value) : std::nullopt;
  }
  if (error != std::errc() || end != word.data() + word.size()) return {};
  return value;
}

/// The words of a line; nothing where a separator has none beside it.
std::optional<std::vector<std::string_view>> words_of(std::string_view line) {
  std::vector<std::string_view> words;
  bool separated = true;  // may a word follow a separator, or stand at the begin?
  for (std::size_t at = 0; at < line.size();) {
    if (is_blank(line[at])) {
      ++at;
    } else if (is_separator(line[at])) {
      if (words.empty() || !separated) return {};
      separated = false;
      ++at;
    } else {
      const std::size_t begin = at;
      while (at < line.size() && !is_blank(line[at]) && !is_separator(line[at])) ++at;
      words.push_back(line.substr(begin, at - begin));
      separated = true;
    }
  }
  if (!separated) return {};
  return words;
}

bool is_one_of(std::size_t width, std::initializer_list<std::size_t> widths) {
  return std::ranges::find(widths, width) != widths.end();
}

struct Wanted {
  const std::string& name;
  std::initializer_list<std::size_t> widths;
  const std::string& expected;
  const std::function<bool(std::span<const double>)>& visit;
};

void read_text(std::string_view text, const Wanted& wanted) {
  if (text.starts_with("\xEF\xBB\xBF")) text.remove_prefix(3);
  bool may_be_heads = true;
  std::vector<double> row;
  for (std::size_t line = 1; !text.empty(); ++line) {
    const std::size_t end = std::min(text.find('\n'), text.size());
    const std::string_view own = text.substr(0, end);
    text.remove_prefix(std::min(end + 1, text.size()));
    const std::size_t first = own.find_first_not_of(" \t\r");
    if (first == std::string_view::npos || own[first] == '#') continue;
    const auto words = words_of(own);
    row.clear();
    for (const std::string_view word : words.value_or(std::vector<std::string_view>())) {
      if (const auto value = number(word)) row.push_back(*value);
    }
    const bool heads = may_be_heads && words && row.empty() && is_one_of(words->size(), wanted.widths);
    may_be_heads = false;
    if (heads) continue;
    const bool good = words && row.size() == words->size() && is_one_of(row.size(), wanted.widths);
    if (!good || !wanted.visit(row)) {
      fail_in_file(wanted.name + ':' + std::to_string(line), wanted.expected);
    }
  }
}

/// Contents of the head of an array.
struct ArrayHead {
  bool doubles = false, fortran = false;
  std::endian order = std::endian::little;
  std::uint64_t rows = 0, columns = 0;
};

/// The text after 'key': in a Python dictionary, up to the next key.
std::string_view entry(std::string_view head, std::string_view key) {
  const std::size_t found = head.find("'" + std::string(key) + "'");
  if (found == std::string_view::npos) return {};
  std::string_view rest = head.substr(found + key.size() + 2);
  rest.remove_prefix(std::min(rest.find_first_not_of(" :"), rest.size()));
  return rest;
}

std::optional<ArrayHead> parse_head(std::string_view head) {
  ArrayHead result;
  const std::string_view type = entry(head, "descr"), order = entry(head, "fortran_order"),
                         shape = entry(head, "shape");
  if (type.size() < 5 || type[0] != '\'' || type[4] != '\'' || type[2] != 'f') return {};
  if ((type[1] != '<' && type[1] != '>' && type[1] != '=') || (type[3] != '4' && type[3] != '8')) return {};
  result.doubles = type[3] == '8';
  result.order = type[1] == '>'   ? std::endian::big
                 : type[1] == '<' ? std::endian::little
                                  : std::endian::native;
  result.fortran = order.starts_with("True");
  if (!result.fortran && !order.starts_with("False")) return {};
  // "(n, 3)"
  const std::size_t comma = shape.find(','), close = shape.find(')');
  if (!shape.starts_with('(') || comma == std::string_view::npos || close == std::string_view::npos ||
      close < comma)
    return {};
  const auto count = [](std::string_view text) -> std::optional<std::uint64_t> {
    while (!text.empty() && text.front() == ' ') text.remove_prefix(1);
    const auto value = parse_integer(text);
    if (!value || *value < 0) return {};
    return static_cast<std::uint64_t>(*value);
  };
  const auto rows = count(shape.substr(1, comma - 1)),
             columns = count(shape.substr(comma + 1, close - comma - 1));
  if (!rows || !columns) return {};
  result.rows = *rows;
  result.columns = *columns;
  return result;
}

void read_array(std::string_view bytes, const Wanted& wanted) {
  const auto fail = [&](const std::string& message) { fail_in_file(wanted.name, message); };
  constexpr std::size_t front = 8;  // magic and version
  if (bytes.size() < front + 4) fail("the NumPy array ends within its head: it is truncated");
  const bool is_long = bytes[6] != '\1';
  const std::size_t size = is_long ? load<std::uint32_t>(bytes.data() + front, std::endian::little)
                                   : load<std::uint16_t>(bytes.data() + front, std::endian::little);
  const std::size_t begin = front + (is_long ? 4 : 2);
  if (size > bytes.size() - begin) fail("the NumPy array ends within its head: it is truncated");
  const auto head = parse_head(bytes.substr(begin, size));
  std::string widths;
  for (const std::size_t width : wanted.widths)
    widths += (widths.empty() ? "" : " or ") + std::to_string(width);
  if (!head || !is_one_of(head->columns, wanted.widths)) {
    fail("the NumPy array is not one of float32 or float64 with the shape (n, " + widths +
         "): save it as a.astype(float)");
  }
  const std::string_view values = bytes.substr(begin + size);
  const std::size_t number_size = head->doubles ? 8 : 4, columns = head->columns;
  if (values.size() % (number_size * columns) != 0 || values.size() / (number_size * columns) != head->rows) {
    fail("the NumPy array declares " + std::to_string(head->rows) + " rows of " + std::to_string(columns) +
         " numbers, but has " + std::to_string(values.size()) + " bytes: it is truncated");
  }
  std::vector<double> row(columns);
  for (std::size_t i = 0; i < head->rows; ++i) {
    for (std::size_t k = 0; k < columns; ++k) {
      const std::size_t place = head->fortran ? k * head->rows + i : i * columns + k;
      const char* const at = values.data() + place * number_size;
      row[k] = head->doubles ? load<double>(at, head->order) : double{load<float>(at, head->order)};
    }
    if (!wanted.visit(row)) fail("row " + std::to_string(i) + ": " + wanted.expected);
  }
}

}  // namespace

void for_each_row(std::string_view bytes, const std::string& name, std::initializer_list<std::size_t> widths,
                  const std::string& expected, const std::function<bool(std::span<const double>)>& visit) {
  const Wanted wanted{name, widths, expected, visit};
  bytes.starts_with(magic) ? read_array(bytes, wanted) : read_text(bytes, wanted);
}

}  // namespace snug
