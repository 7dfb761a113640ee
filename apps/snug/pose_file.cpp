#include "pose_file.h"

#include <algorithm>
#include <array>
#include <cerrno>
#include <system_error>

#include <fmt/core.h>
#include <support/error.h>
#include <support/number.h>
#include <support/read_file.h>
#include <support/system_files.h>

#include "pose.h"
#include "process.h"
#include "words.h"

namespace snug::command {
namespace {

// Enough lines for all threads at once, few enough that answers come soon.
constexpr std::size_t longest_line = 256 * 1024;

[[noreturn]] void fail(const std::string& message) { throw InputError(InputProblem::unreadable, message); }

constexpr const char* forms =
    "a line is 12 or 16 numbers, or {\"a\": POSE, \"b\": POSE} with a list of them or "
    "{\"quaternion\": [w, x, y, z], \"translation\": [x, y, z]} for a POSE";

// The motion of a list of numbers; `defect` grows to what was mended.
Motion motion_of(const std::vector<double>& numbers, bool nearest_rigid, std::optional<double>& defect) {
  if (numbers.size() != 12 && numbers.size() != 16) {
    fail(fmt::format("{} numbers; a pose is the 12 of a row-major 3x4 matrix, or the 16 of a 4x4 one",
                     numbers.size()));
  }
  const TakenPose pose = take_matrix(numbers, nearest_rigid);
  if (pose.mended) defect = std::max(defect.value_or(0), pose.mended->defect);
  return pose.motion;
}

// One line of JSON, as far as poses need it: objects with plain keys, and lists of numbers.
class JsonLine {
 public:
  explicit JsonLine(std::string_view text) : rest_(text) {}

  // The next character but blanks; zero at the end.
  [[nodiscard]] char peek() {
    rest_.remove_prefix(std::min(rest_.find_first_not_of(" \t\r"), rest_.size()));
    return rest_.empty() ? '\0' : rest_.front();
  }
  bool take(char c) {
    if (peek() != c) return false;
    rest_.remove_prefix(1);
    return true;
  }
  void expect(char c) {
    if (!take(c)) fail(fmt::format("{} is missing{}; {}", quoted(c), where(), forms));
  }
  [[nodiscard]] std::string key() {
    expect('"');
    const auto end = rest_.find('"');
    if (end == std::string_view::npos) fail(fmt::format("a name does not end{}; {}", where(), forms));
    const std::string name(rest_.substr(0, end));
    rest_.remove_prefix(end + 1);
    expect(':');
    return name;
  }
  // Calls entry(name) for each entry of an object.
  template <class Entry>
  void object(const Entry& entry) {
    expect('{');
    if (take('}')) return;
    do {
      entry(key());
    } while (take(','));
    expect('}');
  }
  [[nodiscard]] std::vector<double> numbers() {
    std::vector<double> result;
    expect('[');
    if (take(']')) return result;
    do {
      result.push_back(number());
    } while (take(','));
    expect(']');
    return result;
  }
  [[nodiscard]] std::vector<double> numbers(const char* what, std::size_t count) {
    std::vector<double> result = numbers();
    if (result.size() != count) fail(fmt::format("{} has {} numbers, not {}", what, result.size(), count));
    return result;
  }

 private:
  [[nodiscard]] double number() {
    static_cast<void>(peek());
    const std::string_view word = rest_.substr(0, std::min(rest_.find_first_of(",]} \t\r"), rest_.size()));
    const ParsedReal parsed = parse_real(word);
    if (!parsed.fault.empty()) {
      fail(fmt::format("'{}' {}; {}", word.substr(0, 40), parsed.fault, forms));
    }
    rest_.remove_prefix(word.size());
    return parsed.value;
  }
  static std::string quoted(char c) { return std::string("'") + c + "'"; }
  [[nodiscard]] std::string where() const {
    return rest_.empty() ? " at the end" : fmt::format(" before '{}'", rest_.substr(0, 20));
  }

  std::string_view rest_;
};

Motion motion_of(JsonLine& line, bool nearest_rigid, std::optional<double>& defect) {
  if (line.peek() != '{') return motion_of(line.numbers(), nearest_rigid, defect);
  std::optional<std::array<double, 4>> quaternion;
  Vector3 translation;
  line.object([&](const std::string& key) {
    if (key == "quaternion") {
      const std::vector<double> wxyz = line.numbers("quaternion", 4);
      quaternion = {wxyz[0], wxyz[1], wxyz[2], wxyz[3]};
    } else if (key == "translation") {
      const std::vector<double> xyz = line.numbers("translation", 3);
      translation = {xyz[0], xyz[1], xyz[2]};
    } else {
      fail(fmt::format("'{}' is not part of a pose; {}", key, forms));
    }
  });
  if (!quaternion) fail(std::string("a pose has no quaternion; ") + forms);
  return Motion::from_quaternion(*quaternion, translation);
}

ReadPoses parse_json(std::string_view text, bool nearest_rigid) {
  JsonLine line(text);
  ReadPoses poses;
  if (line.peek() == '[') {
    poses.b = motion_of(line, nearest_rigid, poses.defect);
  } else {
    line.object([&](const std::string& key) {
      if (key != "a" && key != "b") fail(fmt::format("'{}' is neither a nor b; {}", key, forms));
      std::optional<Motion>& pose = key == "a" ? poses.a : poses.b;
      if (pose) fail(fmt::format("{} appears twice; {}", key, forms));
      try {
        pose = motion_of(line, nearest_rigid, poses.defect);
      } catch (const InputError& error) {
        throw InputError(error.problem(), key + ": " + error.what());
      }
    });
  }
  if (line.peek() != '\0') fail(std::string("something follows the pose; ") + forms);
  if (!poses.a && !poses.b) fail(std::string("no pose; ") + forms);
  return poses;
}

}  // namespace

ReadPoses parse_pose_line(std::string_view text, bool nearest_rigid) {
  const auto first = text.find_first_not_of(" \t\r");
  if (first != std::string_view::npos && (text[first] == '{' || text[first] == '[')) {
    return parse_json(text, nearest_rigid);
  }
  std::vector<double> numbers;
  while (!text.empty()) {
    const auto begin = text.find_first_not_of(" ,\t\r");
    if (begin == std::string_view::npos) break;
    const auto end = std::min(text.find_first_of(" ,\t\r", begin), text.size());
    const ParsedReal number = parse_real(text.substr(begin, end - begin));
    if (!number.fault.empty()) {
      fail(fmt::format("'{}' {}; {}", text.substr(begin, std::min<std::size_t>(end - begin, 40)),
                       number.fault, forms));
    }
    numbers.push_back(number.value);
    text.remove_prefix(end);
  }
  ReadPoses poses;
  poses.b = motion_of(numbers, nearest_rigid, poses.defect);
  return poses;
}

PoseFile::PoseFile(const std::string& path, const WorkMonitor& monitor)
    : name_(input_name(path)), descriptor_(system_files::standard_input) {
  if (path != "-") {
    // A pipe waits here for who writes to it.
    while ((descriptor_ = system_files::open_to_read(path)) < 0 && errno == EINTR) {
      monitor.checkpoint();
    }
  }
  if (descriptor_ < 0) fail(name_ + ": cannot be read: " + std::generic_category().message(errno));
  size_ = system_files::status_of(descriptor_).size;
}

PoseFile::~PoseFile() {
  if (descriptor_ != system_files::standard_input) system_files::close(descriptor_);
}

std::string PoseFile::name_of(std::size_t line) const { return name_ + ":" + std::to_string(line); }

double PoseFile::share() const {
  return size_ == 0 ? 0
                    : std::min(1.0, static_cast<double>(read_ - (buffer_.size() - taken_)) /
                                        static_cast<double>(size_));
}

// Reads what is there; false where a signal ended the wait.
bool PoseFile::read(const WorkMonitor& monitor) {
  const std::size_t size = buffer_.size();
  buffer_.resize(2 * longest_line);
  const std::ptrdiff_t got = system_files::read(descriptor_, buffer_.data() + size, buffer_.size() - size);
  const int reason = errno;
  buffer_.resize(size + (got > 0 ? static_cast<std::size_t>(got) : 0));
  if (got < 0 && reason != EINTR) {
    fail(name_ + ": cannot be read: " + std::generic_category().message(reason));
  }
  if (got < 0) monitor.checkpoint();
  if (got > 0) read_ += static_cast<std::uint64_t>(got);
  at_end_ = got == 0;
  return got >= 0;
}

// Adds the lines in the first `size` bytes of the buffer that have not been taken.
void PoseFile::take_lines(std::size_t size, std::vector<PoseLine>& lines) {
  std::string_view text = std::string_view(buffer_).substr(taken_, size - taken_);
  taken_ = size;
  while (!text.empty()) {
    const auto end = std::min(text.find('\n'), text.size());
    const std::string_view line = text.substr(0, end);
    text.remove_prefix(std::min(end + 1, text.size()));
    ++lines_;
    std::string_view rest = line;
    const std::string_view first = next_word(rest);
    if (!first.empty() && first.front() != '#') lines.push_back({line, lines_});
  }
}

std::vector<PoseLine> PoseFile::next(const WorkMonitor& monitor) {
  buffer_.erase(0, taken_);
  taken_ = 0;
  std::vector<PoseLine> lines;
  while (lines.empty()) {
    while (!at_end_ && buffer_.size() < longest_line) {
      if (!read(monitor)) continue;
      if (buffer_.find('\n') != std::string::npos && !process::can_read_now(descriptor_)) break;
    }
    const auto last = buffer_.rfind('\n');
    if (at_end_) {
      take_lines(buffer_.size(), lines);
      break;
    }
    if (last == std::string::npos) {
      fail(
          fmt::format("{}: a line of more than {} KiB; {}", name_of(lines_ + 1), longest_line / 1024, forms));
    }
    take_lines(last + 1, lines);
    if (lines.empty()) {
      buffer_.erase(0, taken_);
      taken_ = 0;
    }
  }
  return lines;
}

}  // namespace snug::command
