#include "pose_answers.h"

#include <algorithm>
#include <exception>
#include <optional>

#include <fmt/core.h>
#include <support/error.h>
#include <support/workers.h>

#include "pose_file.h"

namespace snug::command {
namespace {

struct Item {
  PosePair poses;
  std::string json, row;
  bool reached = true;
  std::optional<double> mended;
  std::optional<InputError> error;
};

// Changes made by --nearest-rigid, in the order of the file.
class Mended {
 public:
  void add(const Item& item, std::size_t line) {
    if (!item.mended) return;
    if (count_++ == 0) first_ = line;
    worst_ = std::max(worst_, *item.mended);
  }
  void report(const Notes& notes, const std::string& file) const {
    if (count_ == 0 || !notes) return;
    notes(fmt::format(
        "{}: {} lines with poses off from rigid by up to {:.2g} (an entry of R'R), the first is line {}; "
        "replaced by the nearest rotations",
        file, count_, worst_, first_));
  }

 private:
  std::size_t count_ = 0, first_ = 0;
  double worst_ = 0;
};

// One line's answer as an object on a line of its own.
std::string json_of(const PoseAnswer& answer, const PosePair& poses, std::size_t line) {
  std::string text;
  JsonWriter json([&](std::string_view part) { text += part; }, JsonWriter::Lines::one);
  json.begin_object().field("line", line);
  answer.fields(json);
  write_poses(json, poses);
  json.end_object().finish();
  return text;
}

class PoseAnswers {
 public:
  PoseAnswers(PairArguments& pair, Report& report, const AskPose& ask, bool keeps_poses)
      : pair_(pair),
        report_(report),
        ask_(ask),
        keeps_poses_(keeps_poses),
        workers_(Workspace::of_this_thread(), pair.threads()) {}

  // Answers for some lines, one after the other where they are written, in parallel before that.
  void answer(const PoseFile& file, const std::vector<PoseLine>& lines, const WorkMonitor& monitor) {
    items_.assign(lines.size(), {});
    workers_.for_each(lines.size(), [&](Workspace& workspace, std::size_t i) {
      try {
        items_[i] = answer_line(lines[i], workspace, monitor);
      } catch (const InputError& error) {
        items_[i].error = error;
      }
    });
    for (std::size_t i = 0; i < lines.size(); ++i) write(items_[i], file, lines[i].number);
    report_.flush();
  }

  void finish(const PoseFile& file) const { mended_.report(pair_.notes(), file.name()); }
  [[nodiscard]] std::size_t count() const { return count_; }
  [[nodiscard]] const std::vector<PosePair>& poses() const { return poses_; }
  [[nodiscard]] bool reached() const { return reached_; }

 private:
  Item answer_line(const PoseLine& line, Workspace& workspace, const WorkMonitor& monitor) const {
    monitor.checkpoint();
    const ReadPoses read = parse_pose_line(line.text, pair_.nearest_rigid());
    const PosePair poses{read.a.value_or(pair_.a().pose()), read.b.value_or(pair_.b().pose())};
    const PoseAnswer answer =
        ask_(pair_.a().surface().at(poses.a), pair_.b().surface().at(poses.b), workspace);
    return {.poses = poses,
            .json = report_.json() ? json_of(answer, poses, line.number) : "",
            .row = fmt::format("{} {}", line.number, answer.row),
            .reached = answer.reached,
            .mended = read.defect,
            .error = {}};
  }

  void write(const Item& item, const PoseFile& file, std::size_t line) {
    if (item.error) {
      report_.flush();  // answers before it stand
      throw InputError(item.error->problem(), file.name_of(line) + ": " + item.error->what());
    }
    if (report_.json()) report_.write().spliced(item.json);
    report_.text(item.row);
    mended_.add(item, line);
    reached_ = reached_ && item.reached;
    ++count_;
    if (keeps_poses_) poses_.push_back(item.poses);
  }

  PairArguments& pair_;
  Report& report_;
  const AskPose& ask_;
  bool keeps_poses_;
  std::vector<PosePair> poses_;
  Workers<Workspace> workers_;
  std::vector<Item> items_;
  Mended mended_;
  std::size_t count_ = 0;
  bool reached_ = true;
};

}  // namespace

ExitStatus answer_poses(PairArguments& pair, Report& report, const std::string& header, const AskPose& ask,
                        const ProvePoses& prove, const WorkMonitor& monitor) {
  PoseFile file(pair.poses(), monitor);
  PoseAnswers answers(pair, report, ask, bool(prove));
  if (report.json()) report.write().key("results").begin_array();
  report.text("# line " + header);
  for (std::vector<PoseLine> lines = file.next(monitor); !lines.empty(); lines = file.next(monitor)) {
    answers.answer(file, lines, monitor);
    monitor.report(file.share());
  }
  answers.finish(file);
  if (report.json()) report.write().end_array().field("count", answers.count());
  std::vector<AtomicFile*> files;
  if (prove) prove(answers.poses(), files);
  return report.finish(answers.reached(), files);
}

}  // namespace snug::command
