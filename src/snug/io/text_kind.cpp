#include <snug/io/text_kind.h>

#include <algorithm>
#include <array>

#include <snug/io/text_cursor.h>

namespace snug {
namespace {

using namespace std::string_view_literals;

struct Signature {
  std::string_view front;
  const char* sentence;
};

constexpr const char *utf16 = "this is UTF-16 text: save it as UTF-8",
                     *ply = "this is a PLY file: give it a name that ends in .ply",
                     *gltf =
                         "this is a binary glTF file, which is written but not read: "
                         "convert it to OBJ, OFF, PLY or STL";

constexpr std::array<Signature, 10> signatures{
    {{"\xFF\xFE"sv, utf16},
     {"\xFE\xFF"sv, utf16},
     {"\x1F\x8B"sv, "this is a gzip file: unpack it first"},
     {"PK\x03\x04"sv, "this is a zip archive: unpack it first"},
     {"BZh"sv, "this is a bzip2 file: unpack it first"},
     {"\xFD\x37zXZ"sv, "this is an xz file: unpack it first"},
     {"\x28\xB5\x2F\xFD"sv, "this is a Zstandard file: unpack it first"},
     {"glTF"sv, gltf},
     {"ply\n"sv, ply},
     {"ply\r"sv, ply}}};

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

}  // namespace

void refuse_other_formats(std::string_view bytes, const std::string& name) {
  if (bytes.empty()) fail_in_file(name, "the file is empty");
  for (const Signature& signature : signatures) {
    if (bytes.starts_with(signature.front)) fail_in_file(name, signature.sentence);
  }
  if (begins_with_binary_off(bytes))
    fail_in_file(name, "this is a binary OFF file: convert it to the text form of OFF");
}

std::string_view plain_text(std::string_view bytes, const std::string& name) {
  if (bytes.starts_with("\xEF\xBB\xBF")) bytes.remove_prefix(3);
  if (bytes.ends_with('\x1A')) bytes.remove_suffix(1);
  refuse_other_formats(bytes, name);
  if (bytes.find('\0') != std::string_view::npos) {
    fail_in_file(name, looks_like_utf16(bytes) ? utf16 : "this is not a text file: it contains NUL bytes");
  }
  const std::string_view front = bytes.substr(0, 4096);
  if (!std::all_of(front.begin(), front.end(), is_text_character)) {
    fail_in_file(name, "this is not a text file: it contains control characters");
  }
  return bytes;
}

}  // namespace snug
