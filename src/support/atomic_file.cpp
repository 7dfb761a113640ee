#include <support/atomic_file.h>

#include <array>
#include <atomic>
#include <cerrno>
#include <cstring>
#include <system_error>

#include <support/error.h>
#include <support/system_files.h>

namespace snug {
namespace {

constexpr std::size_t buffer_size = 64 * 1024;

[[noreturn]] void refuse(const std::string& name, int reason) {
  throw InputError(InputProblem::unreadable,
                   name + ": cannot be written: " + std::generic_category().message(reason));
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
    if (file.there.load()) system_files::remove(file.name.data());
  }
}

void require_writable(const std::string& path) {
  using enum system_files::Sort;
  const system_files::Sort sort = path == "-" ? other : system_files::status_of(path).sort;
  if (sort == missing || sort == file || sort == folder) {
    const AtomicFile trial(path);
  } else if (path != "-" && !system_files::is_writable(path)) {
    refuse(path, errno);
  }
}

AtomicFile::AtomicFile(const std::string& path)
    : name_(path == "-" ? "standard output" : path), target_(path) {
  if (path.empty()) throw InputError(InputProblem::unreadable, "the name of the file to write is empty");
  buffer_.reserve(buffer_size);
  if (path == "-") {
    descriptor_ = system_files::standard_output;
    return;
  }
  const system_files::Status status = system_files::status_of(path);
  if (status.sort == system_files::Sort::missing) {
    open_temporary(0666);
    return;
  }
  if (status.sort == system_files::Sort::folder) fail(EISDIR);
  if (status.sort != system_files::Sort::file) {
    descriptor_ = system_files::open_to_write(path);
    if (descriptor_ < 0) fail(errno);
    return;
  }
  // A rename would replace a write-protected file without asking.
  if (!system_files::is_writable(path)) fail(errno);
  target_ = system_files::canonical(path);
  if (target_.empty()) fail(errno);
  open_temporary(status.permissions);
  system_files::set_permissions(descriptor_, status.permissions);
}

AtomicFile::~AtomicFile() { abandon(); }

void AtomicFile::open_temporary(unsigned mode) {
  static std::atomic<unsigned> serial{0};
  const std::string stem =
      system_files::folder_of(target_) + "/.snug-" + std::to_string(system_files::process_id()) + '-';
  do {
    forget_temporary();
    temporary_ = stem + std::to_string(serial++) + ".part";
    held_ = hold_name(temporary_);  // before the file is there: no signal comes in between
    descriptor_ = system_files::create(temporary_, mode);
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
    const std::ptrdiff_t count =
        system_files::write(descriptor_, buffer_.data() + written, buffer_.size() - written);
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
  if (!temporary_.empty() && system_files::sync(descriptor_) != 0) fail(errno);
}

void AtomicFile::commit() {
  complete();
  if (!temporary_.empty()) {
    const int closing = descriptor_;
    descriptor_ = -1;
    if (system_files::close(closing) != 0) fail(errno);
    if (system_files::rename(temporary_, target_) != 0) fail(errno);
    forget_temporary();
    system_files::sync_folder(system_files::folder_of(target_));
  }
  finished_ = true;
}

void AtomicFile::abandon() noexcept {
  if (descriptor_ >= 0 && descriptor_ != system_files::standard_output) system_files::close(descriptor_);
  descriptor_ = -1;
  if (!temporary_.empty()) system_files::remove(temporary_.c_str());
  forget_temporary();
}

void AtomicFile::fail(int reason) {
  abandon();
  finished_ = true;
  refuse(name_, reason);
}

}  // namespace snug
