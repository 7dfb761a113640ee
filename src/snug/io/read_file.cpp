#include <snug/io/read_file.h>

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <system_error>

#include <snug/base/error.h>

namespace snug {
namespace {

[[noreturn]] void fail(const std::string& path, const std::string& message) {
  throw InputError(InputProblem::unreadable, input_name(path) + ": " + message);
}

[[noreturn]] void fail_with_reason(const std::string& path, int reason) {
  fail(path, "cannot be read: " + std::generic_category().message(reason));
}

class InputDescriptor {
 public:
  explicit InputDescriptor(const std::string& path) {
    if (path != "-") {
      number_ = ::open(path.c_str(), O_RDONLY | O_CLOEXEC);
      if (number_ < 0) fail_with_reason(path, errno);
    }
  }
  ~InputDescriptor() {
    if (number_ != STDIN_FILENO) ::close(number_);
  }
  InputDescriptor(const InputDescriptor&) = delete;
  InputDescriptor& operator=(const InputDescriptor&) = delete;
  [[nodiscard]] int number() const { return number_; }

 private:
  int number_ = STDIN_FILENO;
};

}  // namespace

std::string read_file(const std::string& path, const WorkMonitor& monitor) {
  if (path.empty()) throw InputError(InputProblem::unreadable, "the name of the file to read is empty");
  const InputDescriptor descriptor(path);

  // The size is a hint: pipes have none, and a file may grow meanwhile.
  struct stat status {};
  std::size_t expected = 0;
  if (::fstat(descriptor.number(), &status) == 0) {
    if (S_ISDIR(status.st_mode)) fail(path, "is a directory: name a file in it");
    if (S_ISREG(status.st_mode) && status.st_size > 0) expected = static_cast<std::size_t>(status.st_size);
  }
  constexpr std::size_t least_room = 64 * 1024;
  std::string bytes(expected + least_room, '\0');
  std::size_t size = 0;
  for (;;) {
    if (bytes.size() == size) bytes.resize(2 * size);
    const ssize_t got = ::read(descriptor.number(), bytes.data() + size, bytes.size() - size);
    if (got == 0) break;
    if (got > 0) {
      size += static_cast<std::size_t>(got);
    } else if (errno == EINTR) {
      monitor.checkpoint();
    } else {
      fail_with_reason(path, errno);
    }
  }
  bytes.resize(size);
  return bytes;
}

std::string input_name(const std::string& path) { return path == "-" ? "standard input" : path; }

}  // namespace snug
