#include "poses.h"

#include <algorithm>
#include <cmath>

namespace snug::python {
namespace {

[[noreturn]] void refuse(const std::string& message) { throw InputError(InputProblem::value, message); }

double defect_of(const std::array<double, 12>& m) {
  double most = 0;
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t j = 0; j < 3; ++j) {
      const double entry = m[i] * m[j] + m[4 + i] * m[4 + j] + m[8 + i] * m[8 + j] - (i == j ? 1 : 0);
      if (!(std::abs(entry) <= most)) most = std::abs(entry);  // also if it is not a number
    }
  }
  return most;
}

// [(rotation, translation), ...]
bool is_list_of_pairs(py::handle given) {
  return PyList_Check(given.ptr()) && PyList_GET_SIZE(given.ptr()) > 0 &&
         PyTuple_Check(PyList_GET_ITEM(given.ptr(), 0)) &&
         PyTuple_GET_SIZE(PyList_GET_ITEM(given.ptr(), 0)) == 2;
}

}  // namespace

Poses::Poses(const py::object& given, const char* name, const py::object& rigid) : name_(name) {
  if (!rigid.is_none()) {
    if (!py::isinstance<py::str>(rigid) || rigid.cast<std::string>() != "nearest")
      refuse("rigid: give None or 'nearest'");
    nearest_ = true;
  }
  if (given.is_none()) return;
  if (is_list_of_pairs(given)) {
    *this = Poses(convert("pairs")(given, name), name, rigid);
    return;
  }
  if (!PyTuple_Check(given.ptr())) {
    numbers_.emplace(given, name);
    const std::size_t dimensions = numbers_->dimensions();
    if ((dimensions != 2 && dimensions != 3) || numbers_->last(0) != 4 ||
        (numbers_->last(1) != 3 && numbers_->last(1) != 4)) {
      refuse(std::string(name) + " has the shape " + numbers_->shape_text() +
             "; give (4, 4), (3, 4), a tuple (rotation, translation), or n of them");
    }
    form_ = numbers_->last(1) == 3 ? Form::matrix_3x4 : Form::matrix_4x4;
    if (dimensions == 3) count_ = numbers_->extent(0);
    return;
  }
  if (PyTuple_GET_SIZE(given.ptr()) != 2)
    refuse(std::string(name) + ": give a tuple (rotation, translation)");
  numbers_.emplace(PyTuple_GET_ITEM(given.ptr(), 0), name);
  translations_.emplace(PyTuple_GET_ITEM(given.ptr(), 1), name);
  const std::size_t many = translations_->dimensions() == 2 ? 1 : 0;
  const std::size_t dimensions = numbers_->dimensions();
  const bool matrices = dimensions == 2 + many && numbers_->last(0) == 3 && numbers_->last(1) == 3;
  const bool quaternions = dimensions == 1 + many && numbers_->last(0) == 4;
  const bool translations = translations_->dimensions() == 1 + many && translations_->last(0) == 3;
  if (!(matrices || quaternions) || !translations ||
      (many == 1 && numbers_->extent(0) != translations_->extent(0))) {
    refuse(std::string(name) + " has the shapes " + numbers_->shape_text() + " and " +
           translations_->shape_text() +
           "; give rotations (3, 3) or quaternions w x y z (4,) with translations (3,), or n of both");
  }
  form_ = matrices ? Form::rotation : Form::quaternion;
  if (many == 1) count_ = translations_->extent(0);
}

std::array<double, 12> Poses::matrix(std::size_t i) const {
  std::array<double, 12> result{};
  if (form_ == Form::rotation) {
    const double* const r = numbers_->data() + 9 * i;
    const double* const t = translations_->data() + 3 * i;
    for (std::size_t row = 0; row < 3; ++row) {
      std::copy_n(r + 3 * row, 3, result.begin() + static_cast<std::ptrdiff_t>(4 * row));
      result[4 * row + 3] = t[row];
    }
    return result;
  }
  std::copy_n(numbers_->data() + (form_ == Form::matrix_4x4 ? 16 : 12) * i, 12, result.begin());
  return result;
}

Motion Poses::made(std::size_t i) const {
  switch (form_) {
    case Form::identity:
      return {};
    case Form::matrix_4x4: {
      std::array<double, 16> whole;
      std::copy_n(numbers_->data() + 16 * i, 16, whole.begin());
      return Motion::from_4x4(whole);
    }
    case Form::quaternion: {
      const double* const q = numbers_->data() + 4 * i;
      const double* const t = translations_->data() + 3 * i;
      return Motion::from_quaternion({q[0], q[1], q[2], q[3]}, {t[0], t[1], t[2]});
    }
    case Form::matrix_3x4:
    case Form::rotation:
      break;
  }
  return Motion::from_3x4(matrix(i));
}

Motion Poses::at(std::size_t i) const {
  if (!count_) i = 0;
  try {
    return made(i);
  } catch (const InputError& error) {
    return mended(i, error.what());
  }
}

// For numbers that are no motion: the nearest one, if that is wanted and there is one.
Motion Poses::mended(std::size_t i, std::string_view fault) const {
  const auto refuse_pose = [&](std::string_view why, double defect, const char* next_step) {
    constexpr std::string_view prefix = "pose: ";
    if (why.starts_with(prefix)) why.remove_prefix(prefix.size());
    why = why.substr(0, why.find("; take the nearest rotation (--"));  // the command's next step
    throw PoseFault(name_ + (count_ ? "[" + std::to_string(i) + "]: " : ": ") + std::string(why) + next_step,
                    defect);
  };
  const double* const last = form_ == Form::matrix_4x4 ? numbers_->data() + 16 * i + 12 : nullptr;
  const bool affine =
      form_ != Form::quaternion && (!last || (last[0] == 0 && last[1] == 0 && last[2] == 0 && last[3] == 1));
  if (!affine) refuse_pose(fault, std::nan(""), "");
  const std::array<double, 12> numbers = matrix(i);
  try {
    const NearestRigid nearest = nearest_rigid(numbers);
    if (nearest_) return nearest.motion;
  } catch (const InputError& error) {
    refuse_pose(nearest_ ? error.what() : fault, defect_of(numbers), "");
  }
  refuse_pose(fault, defect_of(numbers), "; rigid=\"nearest\" takes the nearest rotation");
  return {};
}

Motion pose_of(const py::object& given, const char* name, const py::object& rigid) {
  const Poses poses(given, name, rigid);
  if (poses.count()) refuse(std::string(name) + ": give one pose");
  return poses.at(0);
}

py::object matrix_of_pose(const py::object& given, const std::string& name, const py::object& rigid) {
  return matrix_of(pose_of(given, name.c_str(), rigid));
}

py::object matrix_of(const Motion& motion) {
  py::array_t<double> result({4, 4});
  std::ranges::copy(motion.numbers(), result.mutable_data());
  std::ranges::copy(std::array{0.0, 0.0, 0.0, 1.0}, result.mutable_data() + 12);
  return result;
}

std::optional<std::size_t> common_count(const Poses& a, const Poses& b) {
  if (a.count() && b.count() && *a.count() != *b.count()) {
    refuse("pose_a has " + std::to_string(*a.count()) + " poses and pose_b " + std::to_string(*b.count()) +
           "; give as many, or one on one side");
  }
  return a.count() ? a.count() : b.count();
}

std::vector<PosePair> pairs_of(const Poses& a, const Poses& b, std::size_t count) {
  std::vector<PosePair> pairs;
  pairs.reserve(count);
  const Motion first_a = a.count() ? Motion() : a.at(0), first_b = b.count() ? Motion() : b.at(0);
  for (std::size_t i = 0; i < count; ++i)
    pairs.push_back({a.count() ? a.at(i) : first_a, b.count() ? b.at(i) : first_b});
  return pairs;
}

}  // namespace snug::python
