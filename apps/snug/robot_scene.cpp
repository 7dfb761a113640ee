#include <snug/robot.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <numbers>
#include <optional>

#include <fmt/core.h>
#include <support/error.h>
#include <support/number.h>
#include <support/parallel.h>
#include <support/read_file.h>
#include <support/system_files.h>

#include "answer_writer.h"
#include "common.h"
#include "pose.h"
#include "progress_bar.h"
#include "witness.h"

namespace snug::command {
namespace {

struct Options : CommonOptions {
  std::string robot, joints, path, srdf, group, root, tolerance = "0.1%", margin = "0",
                                                      primitive_error = "0.2%";
  std::vector<std::string> packages;
  bool visual = false, joined = false, exit_code = false;
};

using Given = std::vector<std::pair<std::string, double>>;

// "0.5", or "30deg".
double position_of(std::string word, const std::string& where) {
  const bool degrees = word.ends_with("deg");
  if (degrees) word.resize(word.size() - 3);
  const ParsedReal number = parse_real(word);
  if (!number.fault.empty()) throw UsageError(fmt::format("{}: '{}' {}", where, word, number.fault));
  return degrees ? number.value * (std::numbers::pi / 180) : number.value;
}

Given given_positions(const std::string& text) {
  Given given;
  for (const std::string& word : words_of(text)) {
    const auto equals = word.find('=');
    if (equals == std::string::npos || equals == 0)
      throw UsageError("--joints: '" + word + "' is not NAME=POSITION, as in \"elbow=0.5 wrist=30deg\"");
    given.emplace_back(word.substr(0, equals), position_of(word.substr(equals + 1), "--joints"));
  }
  return given;
}

// Names of joints in the first line, a position of each in every other one.
std::vector<std::vector<double>> read_path(const Robot& robot, const Options& options) {
  std::vector<std::vector<double>> positions;
  std::vector<std::string> names;
  const std::string bytes = read_file(options.path);
  const std::string_view text = plain_text(bytes, input_name(options.path));
  std::size_t number = 0;
  for (std::size_t begin = 0; begin < text.size();) {
    const std::size_t end = std::min(text.find('\n', begin), text.size());
    const std::vector<std::string> words = words_of(std::string(text.substr(begin, end - begin)));
    begin = end + 1;
    ++number;
    if (words.empty() || words[0].starts_with('#')) continue;
    if (names.empty()) {
      names = words;
      continue;
    }
    const std::string where = fmt::format("{}:{}", input_name(options.path), number);
    if (words.size() != names.size()) {
      throw InputError(InputProblem::unreadable,
                       fmt::format("{}: {} positions for {} joints", where, words.size(), names.size()));
    }
    Given given = given_positions(options.joints);
    std::erase_if(given, [&](const auto& own) { return std::ranges::find(names, own.first) != names.end(); });
    try {
      for (std::size_t i = 0; i < names.size(); ++i)
        given.emplace_back(names[i], position_of(words[i], where));
    } catch (const UsageError& error) {
      throw InputError(InputProblem::unreadable, error.what());
    }
    naming(where, [&] { positions.push_back(joint_positions(robot, given)); });
  }
  if (positions.size() < 2)
    throw InputError(
        InputProblem::unreadable,
        input_name(options.path) + ": give a line of joints' names, and two or more lines of positions");
  return positions;
}

// What other commands take by --scene.
void refuse_scenes(const std::string& path) {
  const std::string ending = system_files::ending_of(path);
  for (const char* const scene : {".json", ".3mf", ".gltf", ".glb", ".usda"}) {
    if (ending != scene) continue;
    throw UsageError(
        "scene: " + path +
        " is a scene of parts: collide, distance, tessellate, convert, envelope and view take it by "
        "--scene; this command takes robots (URDF)");
  }
}

Robot load_robot(const Options& options) {
  refuse_scenes(options.robot);
  RobotOptions how{.visual = options.visual, .root = options.root, .notes = notes_for(options)};
  for (const std::string& package : options.packages) {
    const auto equals = package.find('=');
    const bool named = equals != std::string::npos;
    how.packages[named ? package.substr(0, equals) : ""] = named ? package.substr(equals + 1) : package;
  }
  const Length error = parse_length(options.primitive_error, "--primitive-error");
  if (!error.percent || error.number < 1e-3 || error.number > 50)
    throw UsageError("--primitive-error: give percent of the radius, from 0.001% to 50%");
  how.primitive_error = error.number / 100;
  Robot robot = read_robot(options.robot, how);
  if (!options.srdf.empty()) allow_pairs(robot, read_file(options.srdf), options.srdf);
  return robot;
}

class RobotRun {
 public:
  RobotRun(const Options& options) : options_(options), robot_(load_robot(options)) {
    tolerance_ = parse_length(options.tolerance, "--tolerance", true);
    margin_ = parse_length(options.margin, "--margin", true);
    if (options.path.empty()) {
      positions_.push_back(joint_positions(robot_, given_positions(options.joints)));
    } else {
      positions_ = read_path(robot_, options);
    }
    for (std::size_t m = 0; m < robot_.meshes.size(); ++m) {
      naming(robot_.mesh_names[m], [&] {
        surfaces_.push_back(make_surface(robot_.meshes[m], robot_.mesh_names[m], options, options.scheme));
      });
    }
  }

  ExitStatus run() {
    Report report("scene", options_);
    write_head(report);
    const std::vector<LinkContact> contacts = ask_all();
    std::array<std::size_t, 4> counts{};
    bool complete = true;
    for (const LinkContact& contact : contacts) {
      ++counts[static_cast<std::size_t>(contact.answer.verdict)];
      complete = complete && contact.answer.outcome == Outcome::complete;
      if (report.json()) write_json(report.write(), contact);
      if (contact.answer.verdict != Verdict::separated) report.text(row(contact));
    }
    if (report.json()) {
      report.write().end_array();
      for (std::size_t i = 0; i < counts.size(); ++i)
        report.write().field(name_of(static_cast<Verdict>(i)), counts[i]);
    }
    std::string sentence = fmt::format("{} pairs of shapes", contacts.size());
    for (std::size_t i = 0; i < counts.size(); ++i) {
      if (counts[i] > 0) sentence += fmt::format(", {} {}", counts[i], name_of(static_cast<Verdict>(i)));
    }
    report.text(sentence);
    const ExitStatus status = report.finish(complete);
    if (!options_.exit_code) return status;
    const auto some = [&](Verdict verdict) { return counts[static_cast<std::size_t>(verdict)] > 0; };
    return some(Verdict::intersecting) ? ExitStatus::intersecting
           : some(Verdict::undecided)  ? ExitStatus::undecided
           : some(Verdict::within)     ? ExitStatus::within
                                       : ExitStatus::answered;
  }

 private:
  [[nodiscard]] std::vector<LinkContact> ask_all() const {
    ProgressBar bar("moving", options_.quiet);
    const WorkMonitor monitor = bar.monitor();
    const auto of_size = [](const Length& length) {
      return [&length](double size) { return length.in_mesh_units(size, 1.0); };
    };
    return first_contacts(
        robot_, surfaces_, positions_,
        {.tolerance = of_size(tolerance_),
         .margin = of_size(margin_),
         .joined = options_.joined,
         .group = options_.group},
        {.threads = options_.threads, .monitor = &monitor, .max_splits = options_.max_splits});
  }

  void write_head(Report& report) const {
    const std::size_t moving = static_cast<std::size_t>(std::ranges::count_if(
        robot_.joints, [](const Robot::Joint& joint) { return !joint.fixed && !joint.mimic; }));
    report.text(fmt::format("robot {}: {} links, {} joints that move, {} meshes", robot_.name,
                            robot_.links.size(), moving, robot_.meshes.size()));
    report.text(options_.path.empty() ? "# a b verdict" : "# a b verdict no-contact-before contact-by");
    if (!report.json()) return;
    JsonWriter& json = report.write();
    json.field("robot", robot_.name).field("links", robot_.links.size());
    json.key("joints").begin_array();
    for (const Robot::Joint& joint : robot_.joints) {
      if (!joint.fixed) json.value(joint.name);
    }
    json.end_array().field("duration", static_cast<double>(positions_.size() - 1));
    double outward = 0;
    for (const double own : robot_.outward) outward = std::max(outward, own);
    json.field("outward", outward).key("results").begin_array();
  }

  static void write_json(JsonWriter& json, const LinkContact& contact) {
    json.begin_object().field("a", contact.a).field("b", contact.b).field("frame", contact.frame);
    write_fields(json, contact.answer, contact.placed);
    json.end_object();
  }

  [[nodiscard]] std::string row(const LinkContact& contact) const {
    const TimeOfContact& answer = contact.answer;
    std::string text = fmt::format("{} {} {}", contact.a, contact.b, name_of(answer.verdict));
    if (options_.path.empty()) return text;
    return text + fmt::format(" {} {}", text_at_most(answer.time.lower),
                              answer.time.upper < INFINITY ? text_at_most(answer.time.upper, true) : "-");
  }

  const Options& options_;
  Robot robot_;
  Length tolerance_, margin_;
  std::vector<std::vector<double>> positions_;
  std::vector<Surface> surfaces_;  // one a mesh
};

}  // namespace

Command robot_command() {
  auto options = std::make_shared<Options>();
  options->max_splits = default_splits::time_of_contact;
  OptionList list;
  list.add(Group::own, "ROBOT", &options->robot, "Robot (URDF)");
  list.add(Group::own, "--joints \"NAME=POSITION ...\"", &options->joints,
           "Positions of joints in radians and metres, or as in 30deg; others are at 0, or at the limit "
           "nearest to it");
  list.add(Group::own, "--path FILE", &options->path,
           "First contact along a path: the first line names joints, each other one has their positions at "
           "times 0, 1, 2 ...; "
           "between them all joints go at constant speeds");
  list.add(Group::own, "--srdf FILE", &options->srdf,
           "Pairs of links that may touch, and groups: an SRDF file");
  list.add(Group::own, "--group NAME", &options->group,
           "Only pairs with a link of this group of the SRDF file");
  list.add(Group::own, "--joined", &options->joined, "Also ask pairs of links that a joint joins");
  list.add(Group::own, "--visual", &options->visual,
           "Take the visual shapes instead of the collision shapes");
  list.add(Group::own, "--package NAME=FOLDER", &options->packages,
           "Where package://NAME/ is; without NAME= a folder that holds all packages");
  list.add(Group::own, "--root FOLDER", &options->root,
           "Folder that paths of meshes may not leave; default: that of the robot's file");
  list.add(Group::own, "--tolerance LENGTH", &options->tolerance,
           "Shapes this close may be reported as within; metres, percent of the larger mesh, or with a unit "
           "(0.1mm)");
  list.add(Group::own, "--margin LENGTH", &options->margin,
           "Contact is being at most so far apart; metres, percent of the larger mesh, or with a unit");
  list.add(Group::own, "--primitive-error PERCENT", &options->primitive_error,
           "How far meshes of cylinders and spheres may go beyond them, of the radius");
  list.add(Group::own, "--exit-code", &options->exit_code,
           "Exit with 0 if all pairs are separated, 10 within, 11 intersecting, 12 undecided");
  add_common_options(list, *options);
  list.add(Group::effort, "--max-splits N", &options->max_splits, "Budget of each pair in each unit of time");
  return {"scene",
          Topic::two_surfaces,
          "Prove which links of a robot (URDF) meet, at a position or along a path of its joints",
          {"snug scene arm.urdf --joints \"elbow=30deg\"",
           "snug scene arm.urdf --path moves.txt --srdf arm.srdf --json"},
          std::move(list),
          [options] { return RobotRun(*options).run(); }};
}

}  // namespace snug::command
