#include <support/atomic_file.h>

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <system_error>

#include <support/error.h>

namespace snug {
namespace {

constexpr std::size_t buffer_size = 64 * 1024;

[[noreturn]] void refuse(const std::string& name, int reason) {
  throw InputError(InputProblem::unreadable,
                   name + ": cannot be written: " + std::generic_category().message(reason));
}

std::string folder_of(const std::string& path) {
  const std::string folder = std::filesystem::path(path).parent_path().string();
  return folder.empty() ? "." : folder;
}

/// A rename survives a power failure only once its folder is on the disk. Some file systems cannot do this
/// for folders; the file is complete all the same.
void sync_folder(const std::string& folder) {
  const int descriptor = ::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (descriptor < 0) return;
  static_cast<void>(::fsync(descriptor));
  ::close(descriptor);
}

// Names for remove_unfinished_files(): they stay where they are, since a signal may come at any time. A place
// is taken, then its name is written, then it counts.
struct Unfinished {
  std::atomic<bool> taken{false}, there{false};
  std::array<char, 4096> name{};
};
constinit std::array<Unfinished, 64> unfinished{};

int hold_name(const std::string& name) {
  if (name.size() >= unfinished[0].name.size()) return -1;
  for (std::size_t i = 0; i < unfinished.size(); ++i) {
    if (unfinished[i].taken.exchange(true)) continue;
    std::memcpy(unfinished[i].name.data(), name.c_str(), name.size() + 1);
    unfinished[i].there.store(true);
    return static_cast<int>(i);
  }
  return -1;
}

void release_name(int place) noexcept {
  if (place < 0) return;
  unfinished[static_cast<std::size_t>(place)].there.store(false);
  unfinished[static_cast<std::size_t>(place)].taken.store(false);
}

}  // namespace

void remove_unfinished_files() noexcept {
  for (const Unfinished& file : unfinished) {
    if (file.there.load()) ::unlink(file.name.data());
  }
}

void require_writable(const std::string& path) {
  struct stat status {};
  const bool stream = path == "-" || (::stat(path.c_str(), &status) == 0 && !S_ISREG(status.st_mode) &&
                                      !S_ISDIR(status.st_mode));
  if (!stream) {
    const AtomicFile trial(path);
  } else if (path != "-" && ::access(path.c_str(), W_OK) != 0) {
    refuse(path, errno);
  }
}

AtomicFile::AtomicFile(const std::string& path)
    : name_(path == "-" ? "standard output" : path), target_(path) {
  if (path.empty()) throw InputError(InputProblem::unreadable, "the name of the file to write is empty");
  buffer_.reserve(buffer_size);
  if (path == "-") {
    descriptor_ = STDOUT_FILENO;
    return;
  }
  struct stat status {};
  if (::stat(path.c_str(), &status) != 0) {
    open_temporary(0666);
    return;
  }
  if (S_ISDIR(status.st_mode)) fail(EISDIR);
  if (!S_ISREG(status.st_mode)) {
    descriptor_ = ::open(path.c_str(), O_WRONLY | O_CLOEXEC);
    if (descriptor_ < 0) fail(errno);
    return;
  }
  // A rename would replace a write-protected file without asking.
  if (::access(path.c_str(), W_OK) != 0) fail(errno);
  std::error_code error;
  const std::filesystem::path resolved = std::filesystem::canonical(path, error);
  if (error) fail(error.value());
  target_ = resolved.string();
  const unsigned permissions = status.st_mode & 0777;
  open_temporary(permissions);
  // Restores what the umask removed; file systems without permissions refuse.
  static_cast<void>(::fchmod(descriptor_, permissions));
}

AtomicFile::~AtomicFile() { abandon(); }

void AtomicFile::open_temporary(unsigned mode) {
  static std::atomic<unsigned> serial{0};
  const std::string stem = folder_of(target_) + "/.snug-" + std::to_string(::getpid()) + '-';
  do {
    forget_temporary();
    temporary_ = stem + std::to_string(serial++) + ".part";
    held_ = hold_name(temporary_);  // before the file is there: no signal comes in between
    descriptor_ = ::open(temporary_.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, mode);
  } while (descriptor_ < 0 && errno == EEXIST);
  if (descriptor_ >= 0) return;
  const int reason = errno;
  forget_temporary();
  fail(reason);
}

void AtomicFile::forget_temporary() noexcept {
  release_name(held_);
  held_ = -1;
  temporary_.clear();
}

void AtomicFile::write(std::string_view bytes) {
  require_value(!finished_, "a file to write is used after commit() or a failure; open another one");
  while (!bytes.empty()) {
    const std::string_view part = bytes.substr(0, buffer_size - buffer_.size());
    buffer_.append(part);
    bytes.remove_prefix(part.size());
    if (buffer_.size() == buffer_size) flush();
  }
}

void AtomicFile::write(std::string_view bytes, const WorkMonitor& monitor) {
  constexpr std::size_t part = std::size_t{1} << 20;
  for (std::size_t begin = 0; begin < bytes.size(); begin += part) {
    monitor.checkpoint();
    write(bytes.substr(begin, part));
  }
}

void AtomicFile::flush() {
  std::size_t written = 0;
  while (written < buffer_.size()) {
    const ssize_t count = ::write(descriptor_, buffer_.data() + written, buffer_.size() - written);
    if (count >= 0) {
      written += static_cast<std::size_t>(count);
    } else if (errno != EINTR) {
      fail(errno);
    }
  }
  buffer_.clear();
}

void AtomicFile::send() {
  require_value(!finished_, "a file to write is used after commit() or a failure; open another one");
  if (temporary_.empty()) flush();
}

void AtomicFile::complete() {
  require_value(!finished_, "a file to write is used after commit() or a failure; open another one");
  flush();
  if (!temporary_.empty() && ::fsync(descriptor_) != 0) fail(errno);
}

void AtomicFile::commit() {
  complete();
  if (!temporary_.empty()) {
    const int closing = descriptor_;
    descriptor_ = -1;
    if (::close(closing) != 0) fail(errno);
    if (std::rename(temporary_.c_str(), target_.c_str()) != 0) fail(errno);
    forget_temporary();
    sync_folder(folder_of(target_));
  }
  finished_ = true;
}

void AtomicFile::abandon() noexcept {
  if (descriptor_ >= 0 && descriptor_ != STDOUT_FILENO) ::close(descriptor_);
  descriptor_ = -1;
  if (!temporary_.empty()) ::unlink(temporary_.c_str());
  forget_temporary();
}

void AtomicFile::fail(int reason) {
  abandon();
  finished_ = true;
  refuse(name_, reason);
}

}  // namespace snug
