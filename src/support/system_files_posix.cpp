#ifndef _WIN32

#include <support/system_files.h>

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>
#ifdef __GLIBC__
#include <malloc.h>
#endif

#include <cerrno>
#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <system_error>

namespace snug::system_files {
namespace {

Status status_from(const struct stat& found) {
  Status status;
  status.permissions = found.st_mode & 0777;
  if (S_ISREG(found.st_mode)) {
    status.sort = Sort::file;
    status.size = found.st_size > 0 ? static_cast<std::size_t>(found.st_size) : 0;
  } else {
    status.sort = S_ISDIR(found.st_mode)   ? Sort::folder
                  : S_ISCHR(found.st_mode) ? Sort::character_device
                                           : Sort::other;
  }
  return status;
}

}  // namespace

Status status_of(const std::string& path) {
  struct stat found {};
  return ::stat(path.c_str(), &found) == 0 ? status_from(found) : Status{};
}

Status status_of(int descriptor) {
  struct stat found {};
  return ::fstat(descriptor, &found) == 0 ? status_from(found) : Status{};
}

int open_to_read(const std::string& path) { return ::open(path.c_str(), O_RDONLY | O_CLOEXEC); }
int open_to_write(const std::string& path) { return ::open(path.c_str(), O_WRONLY | O_CLOEXEC); }
int create(const std::string& path, unsigned permissions) {
  return ::open(path.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, permissions);
}
std::ptrdiff_t read(int descriptor, char* bytes, std::size_t count) {
  return ::read(descriptor, bytes, count);
}
std::ptrdiff_t write(int descriptor, const char* bytes, std::size_t count) {
  return ::write(descriptor, bytes, count);
}
int open_to_update(const std::string& path) {
  return ::open(path.c_str(), O_RDWR | O_CREAT | O_CLOEXEC | O_NONBLOCK, 0666);
}
int lock(int descriptor) { return ::flock(descriptor, LOCK_EX | LOCK_NB); }
std::ptrdiff_t read_at(int descriptor, char* bytes, std::size_t count, std::uint64_t offset) {
  return ::pread(descriptor, bytes, count, static_cast<off_t>(offset));
}
std::ptrdiff_t write_at(int descriptor, const char* bytes, std::size_t count, std::uint64_t offset) {
  return ::pwrite(descriptor, bytes, count, static_cast<off_t>(offset));
}
int truncate(int descriptor, std::uint64_t size) { return ::ftruncate(descriptor, static_cast<off_t>(size)); }
int close(int descriptor) noexcept { return ::close(descriptor); }
int remove(const char* path) noexcept { return ::unlink(path); }

bool is_writable(const std::string& path) { return ::access(path.c_str(), W_OK) == 0; }
void set_permissions(int descriptor, unsigned permissions) noexcept {
  static_cast<void>(::fchmod(descriptor, permissions));
}
int sync(int descriptor) { return ::fsync(descriptor); }

void sync_folder(const std::string& folder) {
  const int descriptor = ::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (descriptor < 0) return;
  static_cast<void>(::fsync(descriptor));
  ::close(descriptor);
}

int rename(const std::string& from, const std::string& to) { return std::rename(from.c_str(), to.c_str()); }

std::string canonical(const std::string& path) {
  std::error_code error;
  const std::filesystem::path resolved = std::filesystem::canonical(path, error);
  if (!error) return resolved.string();
  errno = error.value();
  return {};
}

std::filesystem::path path_of(const std::string& name) { return name; }
std::string name_of(const std::filesystem::path& path) { return path.generic_string(); }

std::string folder_of(const std::string& path) {
  const std::string folder = std::filesystem::path(path).parent_path().string();
  return folder.empty() ? "." : folder;
}

unsigned long process_id() { return static_cast<unsigned long>(::getpid()); }

std::size_t memory_of_machine() {
  const long pages = ::sysconf(_SC_PHYS_PAGES), size = ::sysconf(_SC_PAGESIZE);
  if (pages <= 0 || size <= 0) return SIZE_MAX;
  return static_cast<std::size_t>(pages) * static_cast<std::size_t>(size);
}

void return_free_memory() noexcept {
#ifdef __GLIBC__
  ::malloc_trim(0);
#endif
}

}  // namespace snug::system_files

#endif
