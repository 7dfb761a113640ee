#ifdef _WIN32

#include <support/system_files.h>

#include <fcntl.h>
#include <io.h>
#include <sys/stat.h>
#include <windows.h>

#include <algorithm>
#include <cerrno>
#include <cstdint>
#include <cwchar>

namespace snug::system_files {
namespace {

std::wstring wide(const std::string& utf8) {
  const int count = ::MultiByteToWideChar(CP_UTF8, 0, utf8.data(), static_cast<int>(utf8.size()), nullptr, 0);
  std::wstring result(static_cast<std::size_t>(std::max(count, 0)), L'\0');
  ::MultiByteToWideChar(CP_UTF8, 0, utf8.data(), static_cast<int>(utf8.size()), result.data(), count);
  return result;
}

std::string narrow(const std::wstring& text) {
  const int count = ::WideCharToMultiByte(CP_UTF8, 0, text.data(), static_cast<int>(text.size()), nullptr, 0,
                                          nullptr, nullptr);
  std::string result(static_cast<std::size_t>(std::max(count, 0)), '\0');
  ::WideCharToMultiByte(CP_UTF8, 0, text.data(), static_cast<int>(text.size()), result.data(), count, nullptr,
                        nullptr);
  return result;
}

// Names of more than 259 characters are known in full and with a prefix alone.
std::wstring full_name(const std::string& path) {
  std::wstring name = wide(path);
  if (name.size() < 240 || name.starts_with(LR"(\\?\)")) return name;
  const DWORD count = ::GetFullPathNameW(name.c_str(), 0, nullptr, nullptr);
  std::wstring full(count, L'\0');
  full.resize(::GetFullPathNameW(name.c_str(), count, full.data(), nullptr));
  return full.starts_with(LR"(\\)") ? LR"(\\?\UNC)" + full.substr(1) : LR"(\\?\)" + full;
}

int failed_as_windows_says() {
  const DWORD reason = ::GetLastError();
  errno = reason == ERROR_FILE_NOT_FOUND || reason == ERROR_PATH_NOT_FOUND     ? ENOENT
          : reason == ERROR_ACCESS_DENIED || reason == ERROR_SHARING_VIOLATION ? EACCES
          : reason == ERROR_ALREADY_EXISTS || reason == ERROR_FILE_EXISTS      ? EEXIST
          : reason == ERROR_DISK_FULL                                          ? ENOSPC
                                                                               : EIO;
  return -1;
}

Status status_from(const struct _stat64& found) {
  Status status;
  status.permissions = found.st_mode & 0777u;
  const auto sort = found.st_mode & _S_IFMT;
  if (sort == _S_IFREG) {
    status.sort = Sort::file;
    status.size = found.st_size > 0 ? static_cast<std::size_t>(found.st_size) : 0;
  } else {
    status.sort = sort == _S_IFDIR ? Sort::folder : sort == _S_IFCHR ? Sort::character_device : Sort::other;
  }
  return status;
}

// Standard streams translate ends of lines unless told not to.
void as_bytes(int descriptor) {
  if (descriptor <= standard_error) static_cast<void>(::_setmode(descriptor, _O_BINARY));
}

HANDLE handle_of(int descriptor) {
  return reinterpret_cast<HANDLE>(::_get_osfhandle(descriptor));  // NOLINT: Windows declares it as a number
}

OVERLAPPED at(std::uint64_t offset) {
  OVERLAPPED place{};
  place.Offset = static_cast<DWORD>(offset);
  place.OffsetHigh = static_cast<DWORD>(offset >> 32);
  return place;
}

constexpr std::size_t most_at_once = std::size_t{1} << 30;

}  // namespace

Status status_of(const std::string& path) {
  struct _stat64 found {};
  return ::_wstat64(full_name(path).c_str(), &found) == 0 ? status_from(found) : Status{};
}

Status status_of(int descriptor) {
  struct _stat64 found {};
  return ::_fstat64(descriptor, &found) == 0 ? status_from(found) : Status{};
}

int open_to_read(const std::string& path) {
  return ::_wopen(full_name(path).c_str(), _O_RDONLY | _O_BINARY | _O_NOINHERIT);
}
int open_to_write(const std::string& path) {
  return ::_wopen(full_name(path).c_str(), _O_WRONLY | _O_BINARY | _O_NOINHERIT);
}
// Shared with whoever removes it, as remove_unfinished_files() does while it is open; _wopen() does not.
int create(const std::string& path, unsigned permissions) {
  const HANDLE handle = ::CreateFileW(
      full_name(path).c_str(), GENERIC_WRITE, FILE_SHARE_READ | FILE_SHARE_WRITE | FILE_SHARE_DELETE, nullptr,
      CREATE_NEW, (permissions & 0200u) != 0 ? FILE_ATTRIBUTE_NORMAL : FILE_ATTRIBUTE_READONLY, nullptr);
  if (handle == INVALID_HANDLE_VALUE) return failed_as_windows_says();
  const int descriptor = ::_open_osfhandle(reinterpret_cast<std::intptr_t>(handle),
                                           _O_BINARY | _O_NOINHERIT);  // NOLINT: as above
  if (descriptor < 0) ::CloseHandle(handle);
  return descriptor;
}
std::ptrdiff_t read(int descriptor, char* bytes, std::size_t count) {
  as_bytes(descriptor);
  return ::_read(descriptor, bytes, static_cast<unsigned>(std::min(count, most_at_once)));
}
std::ptrdiff_t write(int descriptor, const char* bytes, std::size_t count) {
  as_bytes(descriptor);
  return ::_write(descriptor, bytes, static_cast<unsigned>(std::min(count, most_at_once)));
}
int open_to_update(const std::string& path) {
  return ::_wopen(full_name(path).c_str(), _O_RDWR | _O_CREAT | _O_BINARY | _O_NOINHERIT,
                  _S_IREAD | _S_IWRITE);
}
int lock(int descriptor) {
  OVERLAPPED everything{};
  constexpr DWORD how = LOCKFILE_EXCLUSIVE_LOCK | LOCKFILE_FAIL_IMMEDIATELY;
  return ::LockFileEx(handle_of(descriptor), how, 0, MAXDWORD, MAXDWORD, &everything)
             ? 0
             : failed_as_windows_says();
}
std::ptrdiff_t read_at(int descriptor, char* bytes, std::size_t count, std::uint64_t offset) {
  OVERLAPPED place = at(offset);
  DWORD got = 0;
  if (::ReadFile(handle_of(descriptor), bytes, static_cast<DWORD>(std::min(count, most_at_once)), &got,
                 &place))
    return got;
  return ::GetLastError() == ERROR_HANDLE_EOF ? 0 : failed_as_windows_says();
}
std::ptrdiff_t write_at(int descriptor, const char* bytes, std::size_t count, std::uint64_t offset) {
  OVERLAPPED place = at(offset);
  DWORD done = 0;
  const auto part = static_cast<DWORD>(std::min(count, most_at_once));
  return ::WriteFile(handle_of(descriptor), bytes, part, &done, &place) ? static_cast<std::ptrdiff_t>(done)
                                                                        : failed_as_windows_says();
}
int truncate(int descriptor, std::uint64_t size) {
  const errno_t reason = ::_chsize_s(descriptor, static_cast<long long>(size));
  if (reason == 0) return 0;
  errno = reason;
  return -1;
}
int close(int descriptor) noexcept { return ::_close(descriptor); }
// An open file is gone for others at once, and its name when it is closed.
int remove(const char* path) noexcept {
  return ::DeleteFileW(full_name(path).c_str()) ? 0 : failed_as_windows_says();
}

bool is_writable(const std::string& path) { return ::_waccess(full_name(path).c_str(), 2) == 0; }
void set_permissions(int, unsigned) noexcept {}
int sync(int descriptor) { return ::_commit(descriptor); }
void sync_folder(const std::string&) {}  // the rename writes through

int rename(const std::string& from, const std::string& to) {
  constexpr DWORD how = MOVEFILE_REPLACE_EXISTING | MOVEFILE_WRITE_THROUGH;
  return ::MoveFileExW(full_name(from).c_str(), full_name(to).c_str(), how) ? 0 : failed_as_windows_says();
}

// What a rename would replace: the file itself, for links are rare here and stay as they are.
std::string canonical(const std::string& path) {
  const std::wstring name = wide(path);
  const DWORD count = ::GetFullPathNameW(name.c_str(), 0, nullptr, nullptr);
  if (count == 0) {
    failed_as_windows_says();
    return {};
  }
  std::wstring full(count, L'\0');
  full.resize(::GetFullPathNameW(name.c_str(), count, full.data(), nullptr));
  return narrow(full);
}

std::filesystem::path path_of(const std::string& name) { return wide(name); }
std::string name_of(const std::filesystem::path& path) { return narrow(path.generic_wstring()); }

std::string folder_of(const std::string& path) {
  const std::size_t end = path.find_last_of("/\\");
  if (end == std::string::npos) return path.size() > 1 && path[1] == ':' ? path.substr(0, 2) + "." : ".";
  return end == 0 || path[end - 1] == ':' ? path.substr(0, end + 1) : path.substr(0, end);
}

unsigned long process_id() { return ::GetCurrentProcessId(); }

std::size_t memory_of_machine() {
  MEMORYSTATUSEX status{};
  status.dwLength = sizeof(status);
  return ::GlobalMemoryStatusEx(&status) ? static_cast<std::size_t>(status.ullTotalPhys) : SIZE_MAX;
}

void return_free_memory() noexcept {}

}  // namespace snug::system_files

#endif
