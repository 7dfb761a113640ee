#pragma once

#include <cstdint>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "scene_answer.h"

namespace snug::command {

/// Answers of a scene kept in a file while they are found, a line each, for a run that goes on after this one has ended in
/// whatever way.
///
/// Guarantee: a line that was written is there after the process is killed. A torn last line, as after the machine's power
///            failed, is dropped with all that follows it.
/// Errors:    InputError (unreadable) that names the file: one that is not a journal, or of another scene or other options;
///            one in use by another process; whatever the system reports, such as a full disk. What was written stays.
/// Cost:      a system call an answer; 24 bytes of memory for one that an earlier run left.
class Journal {
 public:
  /// Opens or creates it. `fingerprint` stands for the scene and the options that answers depend on.
  Journal(const std::string& path, std::uint64_t fingerprint);
  ~Journal();
  Journal(const Journal&) = delete;
  Journal& operator=(const Journal&) = delete;

  /// The answer of an earlier run, if there is one.
  [[nodiscard]] std::optional<SceneAnswer> find(const PartPair& parts) const;
  [[nodiscard]] std::size_t found() const { return entries_.size(); }
  /// Writes an answer; may be called by several threads.
  void add(const PartPair& parts, const SceneAnswer& answer);

 private:
  struct Entry {
    std::uint64_t key, offset;
    std::uint32_t size;
  };
  void read_entries(const std::string& head);
  std::size_t take_lines(std::string_view text, std::uint64_t offset, bool& torn);
  void write(std::string_view text);
  [[noreturn]] void fail(const std::string& reason) const;

  std::string path_;
  int descriptor_ = -1;
  std::uint64_t end_ = 0;       // of the last whole line
  std::vector<Entry> entries_;  // by key
  std::mutex mutex_;
};

}  // namespace snug::command
