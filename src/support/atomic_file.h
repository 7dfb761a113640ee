#pragma once

#include <string>
#include <string_view>

#include <snug/run.h>

namespace snug {

/// A file that is written whole or not at all: bytes go to a temporary file in the folder of the target, and
/// commit() puts it in the target's place.
///
///     AtomicFile file(path);
///     file.write(bytes);
///     file.commit();
///
/// Guarantee: until commit() returns, the target is as it was; afterwards it holds all bytes, on the disk,
///            with the permissions it had or those of a new file. If commit() is not reached, the destructor
///            removes the temporary file, and remove_unfinished_files() does where nothing unwinds. A
///            symbolic link to a file stays one: the file behind it is replaced. Targets that cannot be
///            replaced, "-" (standard output), devices, pipes and sockets, receive the bytes as they come,
///            without a promise of all or nothing.
/// Errors:    InputError (unreadable) that names the target and the system's reason, from every member but
///            the destructor; a file is then as it was. InputError (value) if it is used after commit() or a
///            failure.
class AtomicFile {
 public:
  /// Creates the temporary file; fails early if the target is a directory or write protected.
  explicit AtomicFile(const std::string& path);
  ~AtomicFile();
  AtomicFile(const AtomicFile&) = delete;
  AtomicFile& operator=(const AtomicFile&) = delete;

  void write(std::string_view bytes);
  /// The same in parts of 1 MiB, each after a checkpoint.
  void write(std::string_view bytes, const WorkMonitor& monitor);
  /// Hands a target that receives bytes as they come all that it has not had; does nothing for a file.
  void send();
  /// Brings all bytes to the disk, or to where the target takes them: what commit() has left to do is a
  /// rename. For several files of which all are to be written or none.
  void complete();
  /// complete(), and puts the file in place.
  void commit();

 private:
  void open_temporary(unsigned mode);
  void flush();
  void forget_temporary() noexcept;
  void abandon() noexcept;
  [[noreturn]] void fail(int reason);

  std::string name_;       ///< for messages
  std::string target_;     ///< symbolic links resolved
  std::string temporary_;  ///< empty if the bytes go to the target directly
  std::string buffer_;
  int descriptor_ = -1;
  int held_ = -1;          ///< place in the list of unfinished files
  bool finished_ = false;  ///< committed or failed
};

/// Before work whose result an AtomicFile will take: can it be opened? Throws as its constructor. Nothing is
/// left of the trial, and devices, pipes and sockets are not opened, which would be seen.
void require_writable(const std::string& path);

/// Removes the temporary files of all AtomicFiles of this process that are not committed; for handlers of
/// signals that end it. At most 64 files at a time are known; names of more than 4095 bytes are not.
///
/// Guarantee: async-signal-safe.
void remove_unfinished_files() noexcept;

}  // namespace snug
