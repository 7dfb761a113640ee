#pragma once

#include <memory>
#include <optional>
#include <string>

#include <snug/collide.h>

#include "common.h"
#include "pose.h"

namespace snug::command {

struct PairOptions : CommonOptions {
  std::string mesh_a, mesh_b;
  std::string scheme_a, scheme_b;
  PoseOptions pose_a, pose_b;
  bool nearest_rigid = false;
  std::string poses;                ///< a file of poses; empty for none
  double scale_a = 0, scale_b = 0;  ///< in place of --scale; 0: that
  bool moves = false;               ///< other options have poses, too
  std::string scene;                ///< a file of many parts, in place of both meshes; empty for none
  std::string journal;              ///< --resume; empty for none
  double rank_timeout = 60;         ///< seconds
};
/// Those of two meshes and their poses; of commands that answer many, --poses and --scene too.
void add_pair_options(OptionList& list, PairOptions& options, bool many = true);

/// The fields place_a and place_b: the twelve numbers of each pose.
void write_poses(JsonWriter& json, const PosePair& poses);

/// With --exit-code.
[[nodiscard]] ExitStatus status_of(Verdict verdict);

/// Two meshes, read and made ready.
class PairArguments {
 public:
  /// Errors:    UsageError; InputError that names the mesh or the pose.
  explicit PairArguments(const PairOptions& options);

  /// Prepares both for queries.
  void prepare(const WorkMonitor& monitor) const;
  /// For --solid.
  /// Requires:  prepare().
  /// Errors:    InputError (refused) that names the mesh which is not closed.
  void require_closed() const;
  /// Requires:  prepare().
  [[nodiscard]] const PlacedSurface& a() const { return *a_; }
  [[nodiscard]] const PlacedSurface& b() const { return *b_; }
  [[nodiscard]] const std::string& poses() const { return options_.poses; }
  [[nodiscard]] bool nearest_rigid() const { return options_.nearest_rigid; }
  [[nodiscard]] int threads() const { return options_.threads; }
  [[nodiscard]] Notes notes() const { return notes_for(options_); }
  /// Metres of a unit, if both have the same one.
  [[nodiscard]] std::optional<double> units() const { return units_; }
  /// Of the longer one.
  [[nodiscard]] double size() const { return std::max(a_->surface().size(), b_->surface().size()); }
  /// The fields of both in the head of a report.
  void write_heads(Report& report) const;

 private:
  const PairOptions& options_;
  std::optional<PlacedSurface> a_, b_;
  std::optional<double> units_;
};

}  // namespace snug::command
