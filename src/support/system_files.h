#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>

#include <support/number.h>

/// Files as POSIX and Windows have them: names are UTF-8 of any length, nothing is translated in text. Functions return what
/// POSIX's do, -1 with errno on failure.
namespace snug::system_files {

enum class Sort { missing, file, folder, character_device, other };
struct Status {
  Sort sort = Sort::missing;
  std::size_t size = 0;  ///< of a file
  unsigned permissions = 0;
};
/// Follows symbolic links.
[[nodiscard]] Status status_of(const std::string& path);
[[nodiscard]] Status status_of(int descriptor);

[[nodiscard]] int open_to_read(const std::string& path);
[[nodiscard]] int open_to_write(const std::string& path);
/// Fails with EEXIST if there is one.
[[nodiscard]] int create(const std::string& path, unsigned permissions);
/// Bytes read, at most `count`; 0 at the end.
[[nodiscard]] std::ptrdiff_t read(int descriptor, char* bytes, std::size_t count);
[[nodiscard]] std::ptrdiff_t write(int descriptor, const char* bytes, std::size_t count);
/// Opens a file to read and write it, which is made if there is none.
[[nodiscard]] int open_to_update(const std::string& path);
/// At once, or fails where another process holds it; ends with the descriptor.
[[nodiscard]] int lock(int descriptor);
/// The same as read() and write() at an offset; where read() and write() go on is not defined after it.
[[nodiscard]] std::ptrdiff_t read_at(int descriptor, char* bytes, std::size_t count, std::uint64_t offset);
[[nodiscard]] std::ptrdiff_t write_at(int descriptor, const char* bytes, std::size_t count,
                                      std::uint64_t offset);
[[nodiscard]] int truncate(int descriptor, std::uint64_t size);
int close(int descriptor) noexcept;
/// Async-signal-safe, as write() is.
int remove(const char* path) noexcept;

/// Is a file there that may be written?
[[nodiscard]] bool is_writable(const std::string& path);
/// Restores what the umask removed; file systems without permissions refuse.
void set_permissions(int descriptor, unsigned permissions) noexcept;
/// On the disk.
[[nodiscard]] int sync(int descriptor);
/// A rename survives a power failure only once its folder is on the disk. Some file systems cannot do this
/// for folders; the file is complete all the same.
void sync_folder(const std::string& folder);
/// Replaces what is at `to`, in one step.
[[nodiscard]] int rename(const std::string& from, const std::string& to);
/// Symbolic links resolved; empty with errno on failure.
[[nodiscard]] std::string canonical(const std::string& path);
/// As the standard library has it. Of what is not UTF-8 Windows keeps U+FFFD.
[[nodiscard]] std::filesystem::path path_of(const std::string& name);
/// Its name, with `/`.
[[nodiscard]] std::string name_of(const std::filesystem::path& path);
/// The last part of a name, without its extension.
[[nodiscard]] inline std::string stem_of(const std::string& name) { return name_of(path_of(name).stem()); }
/// The extension with its dot, letters of ASCII in lower case.
[[nodiscard]] inline std::string ending_of(const std::string& name) {
  std::string ending = name_of(path_of(name).extension());
  std::ranges::transform(ending, ending.begin(), lower_case);
  return ending;
}
/// With `/`, or "." for a bare name.
[[nodiscard]] std::string folder_of(const std::string& path);

[[nodiscard]] unsigned long process_id();
/// In bytes; SIZE_MAX if the system does not say.
[[nodiscard]] std::size_t memory_of_machine();
/// Gives free memory back where the C library would keep it: what freed blocks leave is in pieces, and of no use to large arrays.
/// Cost:      below a millisecond for a hundred megabytes.
void return_free_memory() noexcept;

inline constexpr int standard_input = 0, standard_output = 1, standard_error = 2;

}  // namespace snug::system_files
