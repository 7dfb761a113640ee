#pragma once

#include <functional>
#include <string>

#include "placed_pair.h"

namespace snug::command {

/// The answer for one pose.
struct PoseAnswer {
  std::function<void(JsonWriter&)> fields;  ///< writes its fields
  std::string row;                          ///< for people
  bool reached = true;
};
/// Asks about one pose; called by several threads.
using AskPose =
    std::function<PoseAnswer(const PlacedSurface& a, const PlacedSurface& b, Workspace& workspace)>;

/// Proves the answers for all poses, and adds the file of the proof.
using ProvePoses = std::function<void(const std::vector<PosePair>&, std::vector<AtomicFile*>& files)>;

/// Answers every pose of --poses in the file's order, to the end of the report: `results` and `count`, or a row each below
/// `header`.
///
/// Guarantee: memory does not grow with the number of poses, if `prove` is empty. What is written depends on the file and the
///            options alone.
/// Returns:   not_reached if one was not.
/// Errors:    InputError that names the line, after the answers before it were written; Interrupted.
[[nodiscard]] ExitStatus answer_poses(PairArguments& pair, Report& report, const std::string& header,
                                      const AskPose& ask, const ProvePoses& prove,
                                      const WorkMonitor& monitor);

}  // namespace snug::command
