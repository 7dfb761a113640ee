#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <snug/geometry.h>

#include "arrays.h"

namespace snug::python {

/// A matrix that is not a motion.
class PoseFault : public InputError {
 public:
  PoseFault(const std::string& message, double defect)
      : InputError(InputProblem::pose, message), defect_(defect) {}
  /// The largest entry of |R'R - I|, roughly; not finite if the matrix is not.
  [[nodiscard]] double defect() const { return defect_; }

 private:
  double defect_;
};

/// The poses of one side, as Python gives them: None, matrices (4, 4) or (3, 4), a tuple of rotation matrices (3, 3) or
/// quaternions w x y z (4,) and translations (3,); or n of them, with n in front of each shape or in a list.
class Poses {
 public:
  /// `rigid`: None, or "nearest": what is not rigid is replaced by the nearest motion.
  Poses(const py::object& given, const char* name, const py::object& rigid);

  /// Empty: one pose.
  [[nodiscard]] std::optional<std::size_t> count() const { return count_; }
  /// Without the GIL, too. Errors: PoseFault, naming the pose.
  [[nodiscard]] Motion at(std::size_t i) const;

 private:
  enum class Form { identity, matrix_3x4, matrix_4x4, rotation, quaternion };

  [[nodiscard]] Motion made(std::size_t i) const;
  [[nodiscard]] Motion mended(std::size_t i, std::string_view fault) const;
  [[nodiscard]] std::array<double, 12> matrix(std::size_t i) const;

  const char* name_;
  bool nearest_ = false;
  Form form_ = Form::identity;
  std::optional<std::size_t> count_;
  std::optional<Doubles> numbers_, translations_;
};

/// One pose. Errors: those of Poses; ValueError for more than one.
[[nodiscard]] Motion pose_of(const py::object& given, const char* name, const py::object& rigid);
/// The pose as the doubles that queries take, (4, 4). Errors: those of Poses; ValueError for more than one.
[[nodiscard]] py::object matrix_of_pose(const py::object& given, const std::string& name,
                                        const py::object& rigid);

/// The twelve numbers and 0 0 0 1, (4, 4).
[[nodiscard]] py::object matrix_of(const Motion& motion);

/// The poses of both sides; one on one side stands beside each of the other's.
/// Errors:    ValueError where their numbers differ.
[[nodiscard]] std::optional<std::size_t> common_count(const Poses& a, const Poses& b);
[[nodiscard]] std::vector<PosePair> pairs_of(const Poses& a, const Poses& b, std::size_t count);

}  // namespace snug::python
