#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include <snug/geometry.h>
#include <snug/mesh.h>

#include "options.h"

namespace snug::command {

/// The words between blanks or commas.
[[nodiscard]] std::vector<std::string> words_of(const std::string& text);

/// Where one mesh stands, as its options say it.
struct PoseOptions {
  std::string place, rotate, move;
};

/// Adds --place, --rotate and --move with a suffix, such as "-b", for the mesh that --help calls `mesh`.
void add_pose_options(OptionList& list, const std::string& suffix, const std::string& mesh,
                      PoseOptions& options);
Option& add_nearest_rigid_option(OptionList& list, bool& nearest_rigid);

/// How matrices that are no motions are treated.
struct Mending {
  bool nearest_rigid = false;  ///< take the nearest motion; else they are refused
  Notes notes = {};            ///< one for each
};

/// The motion of twelve numbers, row-major 3x4, or of sixteen.
/// Returns:   also the defect that was mended, if one was.
/// Requires:  12 or 16 numbers.
/// Errors:    InputError (pose).
struct TakenPose {
  Motion motion;
  std::optional<NearestRigid> mended;
};
[[nodiscard]] TakenPose take_matrix(std::span<const double> numbers, bool nearest_rigid);

/// Twelve or sixteen numbers, separated by blanks or commas.
/// Errors:    UsageError for another count or text that is no number; InputError (pose). Both name `option`.
[[nodiscard]] Motion parse_pose(const std::string& text, const std::string& option, const Mending& mending);

/// Three numbers; an axis, x, y, z or three numbers, with degrees after it.
/// Errors:    UsageError that names `option` and says that the text is not `what`, such as "a translation".
[[nodiscard]] Vector3 parse_vector(const std::string& text, const std::string& option,
                                   const std::string& what);
struct AxisAngle {
  Vector3 axis;
  double degrees;
};
[[nodiscard]] AxisAngle parse_axis_angle(const std::string& text, const std::string& option);

/// The pose that options with this suffix name: the rotation, then the translation, or the matrix.
/// Errors:    UsageError; InputError (pose). Both name the option.
[[nodiscard]] Motion pose_of(const PoseOptions& options, const std::string& suffix, const Mending& mending);

}  // namespace snug::command
