#include "pose.h"

#include <algorithm>
#include <array>
#include <string_view>
#include <vector>

#include <fmt/core.h>
#include <support/error.h>
#include <support/number.h>

#include "length.h"

namespace snug::command {

std::vector<std::string> words_of(const std::string& text) {
  constexpr std::string_view blanks = " ,\t\r\n";
  std::vector<std::string> words;
  for (auto begin = text.find_first_not_of(blanks); begin != std::string::npos;) {
    const auto end = std::min(text.find_first_of(blanks, begin), text.size());
    words.push_back(text.substr(begin, end - begin));
    begin = text.find_first_not_of(blanks, end);
  }
  return words;
}

namespace {

double number_of(const std::string& word, const std::string& option) {
  const ParsedReal number = parse_real(word);
  if (!number.fault.empty()) {
    throw UsageError(fmt::format("{}: '{}' {}", option, word, number.fault));
  }
  return number.value;
}

std::vector<double> numbers_of(std::span<const std::string> words, const std::string& option) {
  std::vector<double> numbers;
  for (const std::string& word : words) numbers.push_back(number_of(word, option));
  return numbers;
}

// Calls `make`, and puts the option's name in front of what it refuses.
template <class Make>
auto naming_option(const std::string& option, const Make& make) {
  try {
    return make();
  } catch (const InputError& error) {
    throw InputError(error.problem(), option + ": " + error.what());
  }
}

}  // namespace

Vector3 parse_vector(const std::string& text, const std::string& option, const std::string& what) {
  const std::vector<double> numbers = numbers_of(words_of(text), option);
  if (numbers.size() != 3) {
    throw UsageError(
        fmt::format("{}: '{}' is not {}; give three numbers, as in \"3 0 0\"", option, text, what));
  }
  return {numbers[0], numbers[1], numbers[2]};
}

AxisAngle parse_axis_angle(const std::string& text, const std::string& option) {
  const std::vector<std::string> words = words_of(text);
  if (words.size() == 2) {
    constexpr std::array<std::string_view, 3> names{"x", "y", "z"};
    for (std::size_t axis = 0; axis < 3; ++axis) {
      if (words[0] != names[axis]) continue;
      Vector3 direction;
      direction[axis] = 1;
      return {direction, number_of(words[1], option)};
    }
  }
  if (words.size() != 4) {
    throw UsageError(
        fmt::format("{}: '{}' is not a rotation; give an axis and degrees, as in \"z 30\" or \"1 1 0 30\"",
                    option, text));
  }
  const std::vector<double> numbers = numbers_of(words, option);
  return {{numbers[0], numbers[1], numbers[2]}, numbers[3]};
}

void add_pose_options(OptionList& list, const std::string& suffix, const std::string& mesh,
                      PoseOptions& options) {
  const std::string place = "--place" + suffix;
  list.add(Group::placement, place + " \"NUMBERS\"", &options.place,
           "Pose of " + mesh + ": a rigid transform as a row-major 3x4 or 4x4 matrix");
  list.add(Group::placement, "--rotate" + suffix + " \"AXIS DEGREES\"", &options.rotate,
           "Rotate " + mesh + " about an axis through the origin: x, y, z or three numbers")
      .excludes(place);
  list.add(Group::placement, "--move" + suffix + " \"X Y Z\"", &options.move,
           "Translate " + mesh + ", after the rotation")
      .excludes(place);
}

Option& add_nearest_rigid_option(OptionList& list, bool& nearest_rigid) {
  return list.add(Group::placement, "--nearest-rigid", &nearest_rigid,
                  "Replace a pose that is not rigid to within 1e-9 by the nearest rigid one, and report how "
                  "far off it was");
}

TakenPose take_matrix(std::span<const double> numbers, bool nearest_rigid) {
  std::array<double, 12> matrix;
  if (numbers.size() == 16) {
    std::array<double, 16> whole;
    std::copy(numbers.begin(), numbers.end(), whole.begin());
    if (!std::equal(whole.begin() + 12, whole.end(), std::array{0.0, 0.0, 0.0, 1.0}.begin())) {
      return {Motion::from_4x4(whole), {}};  // says what is wrong
    }
    std::copy_n(whole.begin(), matrix.size(), matrix.begin());
  } else {
    std::copy(numbers.begin(), numbers.end(), matrix.begin());
  }
  if (!nearest_rigid) return {Motion::from_3x4(matrix), {}};
  const NearestRigid nearest = snug::nearest_rigid(matrix);
  if (nearest.defect <= 1e-9) return {Motion::from_3x4(matrix), {}};
  return {nearest.motion, nearest};
}

Motion parse_pose(const std::string& text, const std::string& option, const Mending& mending) {
  const std::vector<double> numbers = numbers_of(words_of(text), option);
  if (numbers.size() != 12 && numbers.size() != 16) {
    throw UsageError(
        fmt::format("{}: {} numbers; give the twelve of a row-major 3x4 matrix, or the sixteen of a 4x4 one",
                    option, numbers.size()));
  }
  const TakenPose pose = naming_option(option, [&] { return take_matrix(numbers, mending.nearest_rigid); });
  if (pose.mended && mending.notes) {
    mending.notes(fmt::format(
        "{}: off from rigid by {:.2g} (an entry of R'R); replaced by the nearest rotation, which changes "
        "entries by up to {:.2g}",
        option, pose.mended->defect, pose.mended->change));
  }
  return pose.motion;
}

Motion pose_of(const PoseOptions& options, const std::string& suffix, const Mending& mending) {
  if (!options.place.empty()) return parse_pose(options.place, "--place" + suffix, mending);
  Motion pose;
  if (!options.rotate.empty()) {
    const std::string option = "--rotate" + suffix;
    const AxisAngle turn = parse_axis_angle(options.rotate, option);
    pose = naming_option(option, [&] { return Motion::rotation_degrees(turn.axis, turn.degrees); });
  }
  if (!options.move.empty()) {
    pose = pose.with_offset(parse_vector(options.move, "--move" + suffix, "a translation"));
  }
  return pose;
}

}  // namespace snug::command
