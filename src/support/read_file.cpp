#include <support/read_file.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstdint>
#include <system_error>

#include <support/error.h>
#include <support/system_files.h>
#include <support/text_cursor.h>

namespace snug {
namespace {

[[noreturn]] void fail_with_reason(const std::string& name, int reason) {
  fail_in_file(name, "cannot be read: " + std::generic_category().message(reason));
}

// Windows opens none.
[[noreturn]] void fail_folder(const std::string& name) {
  fail_in_file(name, "is a directory: name a file in it");
}
bool is_folder(const system_files::Status& status) { return status.sort == system_files::Sort::folder; }

class InputDescriptor {
 public:
  explicit InputDescriptor(const std::string& path)
      : number_(path == "-" ? system_files::standard_input : system_files::open_to_read(path)) {
    if (number_ >= 0) return;
    const int reason = errno;
    if (is_folder(system_files::status_of(path))) fail_folder(path);
    fail_with_reason(path, reason);
  }
  ~InputDescriptor() {
    if (number_ != system_files::standard_input) system_files::close(number_);
  }
  InputDescriptor(const InputDescriptor&) = delete;
  InputDescriptor& operator=(const InputDescriptor&) = delete;
  [[nodiscard]] int number() const { return number_; }

 private:
  int number_;
};

// How much is to come, and how much may.
struct Size {
  std::size_t expected = 0;
  unsigned max_bits = 30;  // 2^max_bits bytes, or what is expected if that is more
};

Size size_of(int descriptor, const std::string& name) {
  const system_files::Status status = system_files::status_of(descriptor);
  if (is_folder(status)) fail_folder(name);
  // A terminal, or one that never ends.
  if (status.sort == system_files::Sort::character_device) return {0, 20};
  if (status.sort != system_files::Sort::file || status.size == 0) return {};
  if (status.size > system_files::memory_of_machine()) {
    fail_in_file(name, "is larger than the memory of this machine");
  }
  return {status.size};
}

}  // namespace

std::string read_file(const std::string& path, const WorkMonitor& monitor) {
  if (path.empty()) throw InputError(InputProblem::unreadable, "the name of the file to read is empty");
  const std::string name = input_name(path);
  const InputDescriptor descriptor(path);

  // The size is a hint: pipes have none, and a file may grow meanwhile.
  const Size limits = size_of(descriptor.number(), name);
  const std::size_t most = std::max(limits.expected, std::size_t{1} << limits.max_bits);
  constexpr std::size_t min_room = 64 * 1024;
  std::string bytes(limits.expected + min_room, '\0');
  std::size_t size = 0;
  for (;;) {
    monitor.checkpoint();
    if (bytes.size() == size) bytes.resize(2 * size);
    const std::ptrdiff_t got =
        system_files::read(descriptor.number(), bytes.data() + size, bytes.size() - size);
    if (got == 0) break;
    if (got < 0 && errno != EINTR) fail_with_reason(name, errno);
    if (got > 0) size += static_cast<std::size_t>(got);
    if (size > most) {
      fail_in_file(
          name, "does not end after 2^" + std::to_string(limits.max_bits) + " bytes: name a file that does");
    }
  }
  bytes.resize(size);
  return bytes;
}

std::string input_name(const std::string& path) { return path == "-" ? "standard input" : path; }

namespace {

using namespace std::string_view_literals;

struct Signature {
  std::string_view front;
  const char* sentence;
};

constexpr const char *utf16 = "this is UTF-16 text: save it as UTF-8",
                     *ply = "this is a PLY file: give it a name that ends in .ply",
                     *gltf = "this is a binary glTF file: give it a name that ends in .glb",
                     *usdc = "this is a binary USD file: convert it to text, usdcat -o mesh.usda";

constexpr std::array<Signature, 11> signatures{
    {{"\xFF\xFE"sv, utf16},
     {"\xFE\xFF"sv, utf16},
     {"\x1F\x8B"sv, "this is a gzip file: unpack it first"},
     {"PK\x03\x04"sv, "this is a zip archive: unpack it first"},
     {"BZh"sv, "this is a bzip2 file: unpack it first"},
     {"\xFD\x37zXZ"sv, "this is an xz file: unpack it first"},
     {"\x28\xB5\x2F\xFD"sv, "this is a Zstandard file: unpack it first"},
     {"glTF"sv, gltf},
     {"ply\n"sv, ply},
     {"ply\r"sv, ply},
     {"PXR-USDC"sv, usdc}}};

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
