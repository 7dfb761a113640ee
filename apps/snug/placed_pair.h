#pragma once

#include <memory>
#include <optional>
#include <string>

#include <snug/search/workspace.h>

#include "common.h"
#include "pose.h"

namespace snug::command {

/// How a surface is made ready for queries.
[[nodiscard]] SurfaceBvhOptions model_options(const CommonOptions& options);

struct PairOptions : CommonOptions {
  std::string mesh_a, mesh_b;
  std::string scheme_a, scheme_b;
  PoseOptions pose_a, pose_b;
  bool nearest_rigid = false;
  std::string poses;         ///< a file of poses; empty for none
  bool moves = false;        ///< other options have poses, too
  std::string scene;         ///< a file of many parts, in place of both meshes; empty for none
  std::string journal;       ///< --resume; empty for none
  double rank_timeout = 60;  ///< seconds
};
/// Those of two meshes and their poses; of commands that answer many, --poses and --scene too.
void add_pair_options(OptionList& list, PairOptions& options, bool many = true);

/// The fields place_a and place_b: the twelve numbers of each pose.
void write_poses(JsonWriter& json, const PosePair& poses);

/// Two meshes, read and made ready.
class PairArguments {
 public:
  /// Errors:    UsageError; InputError that names the mesh or the pose.
  explicit PairArguments(const PairOptions& options);

  /// Makes the models.
  void prepare(const WorkMonitor& monitor);
  /// For --solid.
  /// Requires:  prepare().
  /// Errors:    InputError (refused) that names the mesh which is not closed.
  void require_closed() const;
  /// Requires:  prepare().
  [[nodiscard]] PlacedBvh a() { return {*model_a_, *scratch_a_, pose_a_}; }
  [[nodiscard]] PlacedBvh b() { return {*model_b_, *scratch_b_, pose_b_}; }
  [[nodiscard]] const SurfaceBvh& model_a() const { return *model_a_; }
  [[nodiscard]] const SurfaceBvh& model_b() const { return *model_b_; }
  [[nodiscard]] const Motion& pose_a() const { return pose_a_; }
  [[nodiscard]] const Motion& pose_b() const { return pose_b_; }
  [[nodiscard]] const std::string& poses() const { return options_.poses; }
  [[nodiscard]] bool nearest_rigid() const { return options_.nearest_rigid; }
  [[nodiscard]] int threads() const { return options_.threads; }
  [[nodiscard]] Notes notes() const { return notes_for(options_); }
  /// Of the longer one.
  [[nodiscard]] double size() const { return std::max(surface_a_->size(), surface_b_->size()); }
  /// The fields of both in the head of a report.
  void write_heads(Report& report) const;

 private:
  const PairOptions& options_;
  SurfaceBvhOptions model_options_;
  Motion pose_a_, pose_b_;
  std::optional<LimitSurface> surface_a_, surface_b_;
  std::optional<SurfaceBvh> model_a_, model_b_;
  std::optional<SurfaceWorkspace> scratch_a_, scratch_b_;
};

}  // namespace snug::command
