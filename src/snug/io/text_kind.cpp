#include <snug/io/text_kind.h>

#include <algorithm>
#include <array>

#include <snug/base/error.h>

namespace snug {
namespace {

using namespace std::string_view_literals;

struct Signature {
  std::string_view front;
  std::string_view sentence;
};

constexpr std::array signatures{
    Signature{"\xFF\xFE"sv, "this is UTF-16 text: save it as UTF-8"},
    Signature{"\xFE\xFF"sv, "this is UTF-16 text: save it as UTF-8"},
    Signature{"\x1F\x8B"sv, "this is a gzip file: unpack it first"},
    Signature{"PK\x03\x04"sv, "this is a zip archive: unpack it first"},
    Signature{"BZh"sv, "this is a bzip2 file: unpack it first"},
    Signature{"\xFD"
              "7zXZ"sv,
              "this is an xz file: unpack it first"},
    Signature{"\x28\xB5\x2F\xFD"sv, "this is a Zstandard file: unpack it first"},
    Signature{
        "glTF"sv,
        "this is a binary glTF file, which is written but not read: convert it to OBJ, OFF, PLY or STL"},
    Signature{"ply\n"sv, "this is a PLY file: give it a name that ends in .ply"},
    Signature{"ply\r"sv, "this is a PLY file: give it a name that ends in .ply"},
};

bool begins_with_binary_off(std::string_view bytes) {
  const std::string_view line = bytes.substr(0, bytes.find_first_of("\r\n"));
  const std::size_t at = line.find("OFF BINARY");
  return at != std::string_view::npos && at <= 5;
}

bool is_text_character(char c) {
  const auto byte = static_cast<unsigned char>(c);
  return byte >= 0x20 ? byte != 0x7f : byte >= '\t' && byte <= '\r';
}

/// A NUL beside each of the first characters: UTF-16 without a byte order mark.
bool looks_like_utf16(std::string_view bytes) {
  const std::string_view front = bytes.substr(0, 64);
  const std::size_t nuls = static_cast<std::size_t>(std::count(front.begin(), front.end(), '\0'));
  const bool alternating = front.size() >= 2 && (front[0] == '\0') != (front[1] == '\0');
  return alternating && nuls == front.size() / 2;
}

[[noreturn]] void fail(const std::string& name, std::string_view sentence) {
  throw InputError(InputProblem::unreadable, name + ": " + std::string(sentence));
}

}  // namespace

void refuse_other_formats(std::string_view bytes, const std::string& name) {
  if (bytes.empty()) fail(name, "the file is empty");
  for (const Signature& signature : signatures) {
    if (bytes.starts_with(signature.front)) fail(name, signature.sentence);
  }
  if (begins_with_binary_off(bytes))
    fail(name, "this is a binary OFF file: convert it to the text form of OFF");
}

std::string_view plain_text(std::string_view bytes, const std::string& name) {
  if (bytes.starts_with("\xEF\xBB\xBF")) bytes.remove_prefix(3);
  if (bytes.ends_with('\x1A')) bytes.remove_suffix(1);
  refuse_other_formats(bytes, name);
  if (bytes.find('\0') != std::string_view::npos) {
    fail(name, looks_like_utf16(bytes) ? "this is UTF-16 text: save it as UTF-8"
                                       : "this is not a text file: it contains NUL bytes");
  }
  const std::string_view front = bytes.substr(0, 4096);
  if (!std::all_of(front.begin(), front.end(), is_text_character)) {
    fail(name, "this is not a text file: it contains control characters");
  }
  return bytes;
}

}  // namespace snug
