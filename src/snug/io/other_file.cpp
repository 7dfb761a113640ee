#include <snug/io/other_file.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <charconv>
#include <cstddef>
#include <cstdint>

#include <support/text_cursor.h>

namespace snug {
namespace {

constexpr std::string_view digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";

std::string unescaped(std::string_view uri) {
  std::string text;
  for (std::size_t i = 0; i < uri.size(); ++i) {
    unsigned code = 0;
    const bool escape = uri[i] == '%' && i + 2 < uri.size() &&
                        std::from_chars(&uri[i + 1], &uri[i + 1] + 2, code, 16).ptr == &uri[i + 1] + 2;
    text += escape ? static_cast<char>(code) : uri[i];
    if (escape) i += 2;
  }
  return text;
}

bool leads_outside(std::string_view path) {
  std::ptrdiff_t depth = 0;
  for (std::size_t begin = 0; begin <= path.size();) {
    const std::size_t end = std::min(path.find('/', begin), path.size());
    const std::string_view step = path.substr(begin, end - begin);
    if (step == "..") {
      if (--depth < 0) return true;
    } else if (!step.empty() && step != ".") {
      ++depth;
    }
    begin = end + 1;
  }
  return depth <= 0;
}

}  // namespace

std::string path_inside(std::string_view uri, const std::string& name, const std::string& what) {
  const std::string path = unescaped(uri);
  const auto fail = [&](const char* why) { fail_in_file(name, what + ": " + in_quotes(uri) + ' ' + why); };
  if (path.empty() || path.find('\0') != std::string::npos) fail("is not the name of a file");
  if (path.find("://") != std::string::npos)
    fail("is an address, which is not followed: give a file beside this one");
  const bool drive = path.size() > 1 && path[1] == ':' && std::isalpha(static_cast<unsigned char>(path[0]));
  if (path[0] == '/' || path.find('\\') != std::string::npos || drive || leads_outside(path))
    fail("leads out of the file's folder: give a path that stays in it, with /");
  return path;
}

std::string data_of_uri(std::string_view uri, const std::string& name, const std::string& what) {
  const std::size_t comma = uri.find(',');
  if (comma == std::string_view::npos || !uri.substr(0, comma).ends_with(";base64"))
    fail_in_file(name, what + ": a data URI that is not base64");
  std::string_view text = uri.substr(comma + 1);
  if (text.size() % 4 == 0) {
    for (int padding = 0; padding < 2 && text.ends_with('='); ++padding) text.remove_suffix(1);
  }
  std::array<std::uint8_t, 256> values;
  values.fill(64);
  for (std::size_t i = 0; i < digits.size(); ++i)
    values[static_cast<unsigned char>(digits[i])] = static_cast<std::uint8_t>(i);
  if (text.size() % 4 == 1) fail_in_file(name, what + ": the data URI is truncated");
  std::string bytes;
  bytes.reserve(text.size() / 4 * 3 + 2);
  std::uint32_t bits = 0, count = 0;
  for (const char c : text) {
    const std::uint8_t value = values[static_cast<unsigned char>(c)];
    if (value == 64) fail_in_file(name, what + ": " + in_quotes({&c, 1}) + " in a data URI is not base64");
    bits = bits << 6 | value;
    count += 6;
    if (count < 8) continue;
    count -= 8;
    bytes += static_cast<char>(bits >> count & 0xff);
  }
  return bytes;
}

void append_base64(std::string& text, std::string_view bytes) {
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    std::uint32_t bits = 0;
    for (std::size_t k = 0; k < 3; ++k)
      bits = bits << 8 | (i + k < bytes.size() ? static_cast<unsigned char>(bytes[i + k]) : 0u);
    for (std::size_t k = 0; k < 4; ++k)
      text += i + k > bytes.size() ? '=' : digits[bits >> (18 - 6 * k) & 63];
  }
}

}  // namespace snug
