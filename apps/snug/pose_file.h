#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <snug/geometry.h>
#include <snug/run.h>

namespace snug::command {

/// A line of a file of poses.
struct PoseLine {
  std::string_view text;
  std::size_t number;  ///< from 1 on
};

/// A file of poses, or a stream that may never end, read as its lines come.
///
/// Cost:      512 KiB.
class PoseFile {
 public:
  /// "-" is standard input.
  /// Errors:    InputError (unreadable) that names the file; Interrupted.
  PoseFile(const std::string& path, const WorkMonitor& monitor);
  ~PoseFile();
  PoseFile(const PoseFile&) = delete;
  PoseFile& operator=(const PoseFile&) = delete;

  /// Name of a line in messages: "poses.txt:7".
  [[nodiscard]] std::string name_of(std::size_t line) const;
  [[nodiscard]] const std::string& name() const { return name_; }
  /// The next lines but blank ones and those that begin with #: what is there at once, at least one. None at
  /// the end. They are gone with the next call.
  /// Errors:    InputError (unreadable) for a line of more than 256 KiB, and whatever the system reports;
  ///            Interrupted.
  [[nodiscard]] std::vector<PoseLine> next(const WorkMonitor& monitor);
  /// How much has been handed out, in [0, 1]; 0 for a stream.
  [[nodiscard]] double share() const;

 private:
  bool read(const WorkMonitor& monitor);
  void take_lines(std::size_t size, std::vector<PoseLine>& lines);

  std::string name_;
  int descriptor_;
  std::string buffer_;
  std::size_t taken_ = 0;  // of the buffer
  std::size_t lines_ = 0;
  std::uint64_t read_ = 0, size_ = 0;
  bool at_end_ = false;
};

/// Poses on one line of text, and how far off they were.
struct ReadPoses {
  std::optional<Motion> a, b;
  std::optional<double> defect;  ///< the worst that was mended
};

/// Twelve or sixteen numbers, the pose of B; or the same as a JSON list; or a JSON object with `a`, `b` or
/// both, each a list or {"quaternion": [w, x, y, z], "translation": [x, y, z]}.
///
/// Errors:    InputError: unreadable for another text, pose for what is no motion.
[[nodiscard]] ReadPoses parse_pose_line(std::string_view text, bool nearest_rigid);

}  // namespace snug::command
