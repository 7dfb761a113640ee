#include "messages.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <cerrno>
#include <cstddef>
#include <cstdint>
#include <new>

#include <support/atomic_file.h>
#include <support/system_files.h>

namespace snug::command {
namespace {

std::atomic<const char*> name_of_program = "snug";  // read by handlers of signals

struct Character {
  std::size_t bytes = 1;  // how many it has in the text
  bool valid = false;
  std::uint32_t code = 0;
};

// The character that a text begins with: a byte alone where it is no UTF-8 (RFC 3629).
Character first_character(std::string_view text) {
  const auto byte = [&](std::size_t i) { return static_cast<unsigned char>(text[i]); };
  const unsigned lead = byte(0);
  if (lead < 0x80) return {1, true, lead};
  const std::size_t bytes = lead >= 0xf0 ? 4u : lead >= 0xe0 ? 3u : 2u;
  if (lead < 0xc2 || lead > 0xf4 || text.size() < bytes) return {};
  std::uint32_t code = lead & (0x7fu >> bytes);
  for (std::size_t i = 1; i < bytes; ++i) {
    if ((byte(i) & 0xc0u) != 0x80) return {};
    code = code << 6 | (byte(i) & 0x3fu);
  }
  constexpr std::array<std::uint32_t, 5> least{0, 0, 0x80, 0x800, 0x10000};
  if (code < least[bytes] || code > 0x10ffff || (code >= 0xd800 && code < 0xe000)) return {};
  return {bytes, true, code};
}

// Characters that end a line, move the cursor or turn the writing direction.
bool disturbs(std::uint32_t code) {
  return code < 0x20 || (code >= 0x7f && code < 0xa0) || code == 0x2028 || code == 0x2029 ||
         (code >= 0x202a && code <= 0x202e) || (code >= 0x2066 && code <= 0x2069);
}

void append_escape(std::string& out, char sort, std::uint32_t code, unsigned digits) {
  constexpr char hexadecimal[] = "0123456789abcdef";
  out += '\\';
  out += sort;
  for (unsigned i = digits; i-- > 0;) out += hexadecimal[code >> (4 * i) & 15u];
}

bool plain(std::string_view text) {
  return std::all_of(text.begin(), text.end(), [](char c) { return c >= ' ' && c < 0x7f; });
}

}  // namespace

std::string one_line(std::string_view text) {
  if (plain(text)) return std::string(text);
  std::string out;
  while (!text.empty()) {
    const Character c = first_character(text);
    if (!c.valid) {
      append_escape(out, 'x', static_cast<unsigned char>(text[0]), 2);
    } else if (c.code == '\n') {
      out += "\\n";
    } else if (c.code == '\t') {
      out += "\\t";
    } else if (c.code == '\r') {
      out += "\\r";
    } else if (disturbs(c.code)) {
      c.code < 0x80 ? append_escape(out, 'x', c.code, 2) : append_escape(out, 'u', c.code, 4);
    } else {
      out += text.substr(0, c.bytes);
    }
    text.remove_prefix(c.bytes);
  }
  return out;
}

std::string as_utf8(std::string_view text) {
  if (plain(text)) return std::string(text);
  std::string out;
  while (!text.empty()) {
    const Character c = first_character(text);
    out += c.valid ? text.substr(0, c.bytes) : "\xef\xbf\xbd";
    text.remove_prefix(c.bytes);
  }
  return out;
}

void to_standard_error(std::string_view text) noexcept {
  while (!text.empty()) {
    const std::ptrdiff_t count = system_files::write(system_files::standard_error, text.data(), text.size());
    if (count >= 0) {
      text.remove_prefix(static_cast<std::size_t>(count));
    } else if (errno != EINTR) {
      return;
    }
  }
}

void print_message(std::string_view text) noexcept {
  try {
    // At once, so that lines of others stay whole.
    to_standard_error(std::string(program_name()) + ": " + one_line(text) + "\n");
  } catch (const std::bad_alloc&) {
    to_standard_error(program_name());
    to_standard_error(": out of memory\n");
  }
}

void set_program_name(const char* name) noexcept { name_of_program = name; }
const char* program_name() noexcept { return name_of_program; }

void write_output(std::string_view text) {
  AtomicFile output("-");
  output.write(text);
  output.commit();
}

}  // namespace snug::command
