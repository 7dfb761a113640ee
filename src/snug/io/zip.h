#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <string>
#include <string_view>

namespace snug {

/// The files of a ZIP archive, ZIP64 too.
///
/// Guarantee: all that read() returns is at most 100 times the archive and a mebibyte, whatever it promises.
/// Requires:  bytes and name outlive it.
/// Errors:    InputError (unreadable) naming the archive and the file in it: truncated and encrypted ones, other methods than
///            stored and deflated (stored alone where snug was built without zlib), wrong sizes and check sums.
class ZipArchive {
 public:
  ZipArchive(std::string_view bytes, const std::string& name);

  [[nodiscard]] bool holds(const std::string& path) const { return entries_.contains(path); }
  [[nodiscard]] std::string read(const std::string& path);

 private:
  struct Entry {
    std::uint64_t begin, packed, size;  // where its local header is, and its sizes
    std::uint32_t check;
    std::uint16_t method, flags;
  };
  [[noreturn]] void fail(const std::string& message) const;
  [[nodiscard]] std::string_view packed(const std::string& path, const Entry& entry) const;
  void read_directory();
  void read_entry(std::size_t& at);

  std::string_view bytes_;
  const std::string& name_;
  std::map<std::string, Entry> entries_;
  std::uint64_t left_;  // bytes that may still be unpacked
};

/// Whether the bytes begin like a ZIP archive that is not empty.
[[nodiscard]] bool begins_like_zip(std::string_view bytes);

/// Files on their way into an archive; deflated where snug was built with zlib.
class ZipWriter {
 public:
  using Append = std::function<void(std::string_view)>;

  void add(const std::string& path, std::string_view bytes);
  /// A file whose bytes fill(append) makes part by part; how they are cut makes no difference to the archive.
  void add(const std::string& path, const std::function<void(const Append&)>& fill);
  /// The archive.
  /// Errors:    InputError (refused) beyond 4 GiB.
  [[nodiscard]] std::string finish(const std::string& name);

 private:
  std::string bytes_, directory_;
  std::uint16_t count_ = 0;
  bool fits_ = true;
};

}  // namespace snug
