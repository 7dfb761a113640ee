#include <snug/io/read_file.h>

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdint>
#include <system_error>

#include <snug/base/error.h>
#include <snug/io/text_cursor.h>

namespace snug {
namespace {

[[noreturn]] void fail_with_reason(const std::string& name, int reason) {
  fail_in_file(name, "cannot be read: " + std::generic_category().message(reason));
}

class InputDescriptor {
 public:
  explicit InputDescriptor(const std::string& path)
      : number_(path == "-" ? STDIN_FILENO : ::open(path.c_str(), O_RDONLY | O_CLOEXEC)) {
    if (number_ < 0) fail_with_reason(path, errno);
  }
  ~InputDescriptor() {
    if (number_ != STDIN_FILENO) ::close(number_);
  }
  InputDescriptor(const InputDescriptor&) = delete;
  InputDescriptor& operator=(const InputDescriptor&) = delete;
  [[nodiscard]] int number() const { return number_; }

 private:
  int number_;
};

std::size_t memory_of_machine() {
  const long pages = ::sysconf(_SC_PHYS_PAGES), size = ::sysconf(_SC_PAGESIZE);
  if (pages <= 0 || size <= 0) return SIZE_MAX;
  return static_cast<std::size_t>(pages) * static_cast<std::size_t>(size);
}

// How much is to come, and how much may.
struct Size {
  std::size_t expected = 0;
  unsigned most_bits = 30;  // 2^most_bits bytes, or what is expected if that is more
};

Size size_of(int descriptor, const std::string& name) {
  struct stat status {};
  if (::fstat(descriptor, &status) != 0) return {};
  if (S_ISDIR(status.st_mode)) fail_in_file(name, "is a directory: name a file in it");
  // A terminal, or one that never ends.
  if (S_ISCHR(status.st_mode)) return {0, 20};
  if (!S_ISREG(status.st_mode) || status.st_size <= 0) return {};
  const auto size = static_cast<std::size_t>(status.st_size);
  if (size > memory_of_machine()) fail_in_file(name, "is larger than the memory of this machine");
  return {size};
}

}  // namespace

std::string read_file(const std::string& path, const WorkMonitor& monitor) {
  if (path.empty()) throw InputError(InputProblem::unreadable, "the name of the file to read is empty");
  const std::string name = input_name(path);
  const InputDescriptor descriptor(path);

  // The size is a hint: pipes have none, and a file may grow meanwhile.
  const Size limits = size_of(descriptor.number(), name);
  const std::size_t most = std::max(limits.expected, std::size_t{1} << limits.most_bits);
  constexpr std::size_t least_room = 64 * 1024;
  std::string bytes(limits.expected + least_room, '\0');
  std::size_t size = 0;
  for (;;) {
    monitor.checkpoint();
    if (bytes.size() == size) bytes.resize(2 * size);
    const ssize_t got = ::read(descriptor.number(), bytes.data() + size, bytes.size() - size);
    if (got == 0) break;
    if (got < 0 && errno != EINTR) fail_with_reason(name, errno);
    if (got > 0) size += static_cast<std::size_t>(got);
    if (size > most) {
      fail_in_file(
          name, "does not end after 2^" + std::to_string(limits.most_bits) + " bytes: name a file that does");
    }
  }
  bytes.resize(size);
  return bytes;
}

std::string input_name(const std::string& path) { return path == "-" ? "standard input" : path; }

}  // namespace snug
