#include <snug/io/utf8.h>

namespace snug {

std::u32string code_points(std::string_view utf8) {
  std::u32string points;
  for (std::size_t i = 0; i < utf8.size();) {
    const auto lead = static_cast<unsigned char>(utf8[i]);
    const std::size_t more = lead >= 0xf0 ? 3 : lead >= 0xe0 ? 2 : lead >= 0xc0 ? 1 : 0;
    char32_t point = more == 0 ? lead : lead & (0x3fu >> more);
    std::size_t k = 1;
    for (; k <= more && i + k < utf8.size() && (static_cast<unsigned char>(utf8[i + k]) & 0xc0u) == 0x80; ++k)
      point = point << 6 | (static_cast<unsigned char>(utf8[i + k]) & 0x3fu);
    const bool whole = k == more + 1 && lead < 0xf8 && point <= 0x10ffff;
    points += whole ? point : char32_t{lead};
    i += whole ? k : 1;
  }
  return points;
}

void append_utf8(std::string& text, std::uint32_t code) {
  const auto byte = [&](std::uint32_t bits) { text += static_cast<char>(bits); };
  if (code < 0x80) {
    byte(code);
  } else if (code < 0x800) {
    byte(0xc0 | code >> 6);
    byte(0x80 | (code & 0x3f));
  } else if (code < 0x10000) {
    byte(0xe0 | code >> 12);
    byte(0x80 | (code >> 6 & 0x3f));
    byte(0x80 | (code & 0x3f));
  } else {
    byte(0xf0 | code >> 18);
    byte(0x80 | (code >> 12 & 0x3f));
    byte(0x80 | (code >> 6 & 0x3f));
    byte(0x80 | (code & 0x3f));
  }
}

}  // namespace snug
