#include <algorithm>
#include <numbers>
#include <optional>
#include <vector>

#include <snug/clearance.h>
#include <support/error.h>

#include <fmt/core.h>

#include "answer_writer.h"
#include "length.h"
#include "placed_pair.h"
#include "pose_file.h"
#include "progress_bar.h"
#include "solids.h"
#include "witness.h"

namespace snug::command {
namespace {

// How one mesh moves, as its options say it.
struct MoveOptions {
  std::string to, path, velocity, spin, about, deform;
};

struct Options : PairOptions {
  MoveOptions move_a, move_b;
  std::string tolerance = "0.1%", margin;
  std::string absolute;  // of clearance
  double relative = 0;
  bool solid = false;
  bool exit_code = false;
};

void add_move_options(OptionList& list, const std::string& suffix, const std::string& mesh,
                      MoveOptions& options) {
  const std::string to = "--to" + suffix, path = "--path" + suffix, velocity = "--velocity" + suffix,
                    spin = "--spin" + suffix;
  list.add(Group::own, to + " \"NUMBERS\"", &options.to,
           "Pose of " + mesh + " at time 1, as --place" + suffix + "; it moves there along a screw motion");
  list.add(
          Group::own, path + " FILE", &options.path,
          mesh + " moves along screw motions through the poses of a file, one per line, at times 0, 1, 2 ...")
      .excludes(to)
      .excludes("--place" + suffix)
      .excludes("--rotate" + suffix)
      .excludes("--move" + suffix);
  list.add(Group::own, velocity + " \"X Y Z\"", &options.velocity, "Translation of " + mesh + " until time 1")
      .excludes(to)
      .excludes(path);
  list.add(Group::own, spin + " \"AXIS DEGREES\"", &options.spin,
           "Rotation of " + mesh + " until time 1 about a point that moves with it")
      .excludes(to)
      .excludes(path);
  list.add(Group::own, "--about" + suffix + " \"X Y Z\"", &options.about,
           "That point at time 0, in world coordinates; default: the mesh's origin after placement")
      .needs(spin);
  list.add(Group::own, "--deform" + suffix + " MESH", &options.deform,
           "The same mesh at time 1; control points of " + mesh + " move there in straight lines")
      .excludes(path);
}

Trajectory read_path(const std::string& name, bool nearest_rigid) {
  const WorkMonitor never;
  PoseFile file(name, never);
  std::vector<Motion> poses;
  for (auto lines = file.next(never); !lines.empty(); lines = file.next(never)) {
    for (const PoseLine& line : lines) {
      try {
        const ReadPoses read = parse_pose_line(line.text, nearest_rigid);
        if (!read.b || read.a) {
          throw InputError(InputProblem::unreadable, "a path is of one mesh; give one pose a line");
        }
        poses.push_back(*read.b);
      } catch (const InputError& error) {
        throw InputError(error.problem(), file.name_of(line.number) + ": " + error.what());
      }
    }
  }
  if (poses.empty()) throw InputError(InputProblem::unreadable, name + ": no pose; give one or more lines");
  try {
    return Trajectory::through(poses);
  } catch (const InputError& error) {
    throw InputError(error.problem(), name + ": " + error.what());
  }
}

Trajectory motion_of(const MoveOptions& options, const std::string& suffix, const Motion& from,
                     const Mending& mending) {
  if (!options.path.empty()) return read_path(options.path, mending.nearest_rigid);
  if (!options.to.empty()) {
    const std::string option = "--to" + suffix;
    const Motion to = parse_pose(options.to, option, mending);
    try {
      return Trajectory::screw(from, to);
    } catch (const InputError& error) {
      throw InputError(error.problem(), option + ": " + error.what());
    }
  }
  if (options.velocity.empty() && options.spin.empty()) return from;
  SteadyMotion motion;
  motion.about = Point3{} + from.offset();
  if (!options.velocity.empty()) {
    motion.velocity = parse_vector(options.velocity, "--velocity" + suffix, "a translation");
  }
  if (!options.spin.empty()) {
    const AxisAngle spin = parse_axis_angle(options.spin, "--spin" + suffix);
    motion.axis = spin.axis;
    motion.radians = spin.degrees * (std::numbers::pi / 180);
  }
  if (!options.about.empty()) {
    motion.about = Point3{} + parse_vector(options.about, "--about" + suffix, "a point");
  }
  return Trajectory::steady(from, motion);
}

// Where the control points go; none if they stay.
std::vector<Point3> deformed(const std::string& path, const std::string& from, const ControlMesh& mesh,
                             const CommonOptions& options) {
  if (path.empty()) return {};
  ControlMesh end = load_mesh(path, options);
  const auto refuse = [&](const std::string& what) {
    throw InputError(InputProblem::refused,
                     path + ": " + what + " " + from + "; give the same mesh with other coordinates");
  };
  if (end.vertex_count() != mesh.vertex_count()) {
    refuse(fmt::format("{} vertices, not the {} of", end.vertex_count(), mesh.vertex_count()));
  }
  if (end.face_count() != mesh.face_count()) {
    refuse(fmt::format("{} faces, not the {} of", end.face_count(), mesh.face_count()));
  }
  for (std::size_t f = 0; f < mesh.face_count(); ++f) {
    const auto face = end.face(FaceId(f)), expected = mesh.face(FaceId(f));
    if (!std::equal(face.begin(), face.end(), expected.begin(), expected.end())) {
      refuse(fmt::format("face {} has other vertices than that of", f));
    }
  }
  return std::move(end.points);
}

std::string sentence(const TimeOfContact& answer, const TimeOfContactOptions& wanted) {
  const std::string lower = text_at_most(answer.time.lower), upper = text_at_most(answer.time.upper, true);
  const bool solid = wanted.solid;
  const std::string contact =
      wanted.margin == 0 ? "contact" : fmt::format("distance of {:.6g}", wanted.margin);
  switch (answer.verdict) {
    case Verdict::separated:
      return fmt::format("separated: proved, no {} up to time {}", contact, lower);
    case Verdict::within:
      return fmt::format("within: no {} before time {}, and at time {} at most {:.6g} apart", contact, lower,
                         upper, wanted.margin + *wanted.tolerance);
    case Verdict::intersecting:
      if (answer.contained) return "intersecting: proved, at time 0 " + inner_sentence(*answer.contained);
      return fmt::format("intersecting: proved, first {} at a time from {} to {}", contact, lower, upper);
    case Verdict::undecided:
      break;
  }
  if (answer.outcome == Outcome::budget_spent) {
    return fmt::format("undecided: no {} before time {}, unknown after that; give a larger --max-splits",
                       contact, lower);
  }
  if (solid && answer.time.lower == 0) {
    return "undecided: no proof at time 0 whether one solid is inside the other; move one of them slightly";
  }
  return fmt::format("undecided: no {} before time {}, then too close to decide; give a larger --tolerance",
                     contact, lower);
}

// The surface with its control points at a time.
Surface surface_at(const DeformingSurface& moving, double time) {
  if (moving.end.empty()) return moving.surface;
  const std::span<const Point3> begin = moving.surface.mesh().points;
  std::vector<Point3> points;
  for (std::size_t v = 0; v < begin.size(); ++v) {
    Point3& p = points.emplace_back();
    for (std::size_t k = 0; k < 3; ++k) p[k] = (1 - time) * begin[v][k] + time * moving.end[v][k];
  }
  return MovingSurface(moving.surface).move(points);
}

// Two meshes and their motions, read and made ready.
class MovingArguments {
 public:
  MovingArguments(const Options& options, const WorkMonitor& monitor) : pair(options) {
    const Mending mending{options.nearest_rigid, notes_for(options)};
    const Trajectory motion_a = motion_of(options.move_a, "-a", pair.a().pose(), mending),
                     motion_b = motion_of(options.move_b, "-b", pair.b().pose(), mending);
    const std::string &deform_a = options.move_a.deform, &deform_b = options.move_b.deform;
    duration_ = std::max(
        {motion_a.duration(), motion_b.duration(), deform_a.empty() && deform_b.empty() ? 0.0 : 1.0});
    if (duration_ == 0) {
      throw UsageError(
          "nothing moves; give --to-b, --velocity-b, --spin-b, --path-b or --deform-b, or the same for A");
    }
    pair.prepare(monitor);
    end_a_ = deformed(deform_a, options.mesh_a, pair.a().surface().mesh(), options);
    end_b_ = deformed(deform_b, options.mesh_b, pair.b().surface().mesh(), options);
    if (options.solid) pair.require_closed();
    a.emplace(DeformingSurface{pair.a().surface(), end_a_, motion_a});
    b.emplace(DeformingSurface{pair.b().surface(), end_b_, motion_b});
  }

  PairArguments pair;
  std::optional<DeformingSurface> a, b;

  // The surfaces at a time; their poses are written.
  [[nodiscard]] Sides at(double time, Report& report) const {
    const PosePair at{a->motion.at(time), b->motion.at(time)};
    if (report.json()) {
      report.write().field("duration", duration_);
      write_poses(report.write(), at);
    }
    return {surface_at(*a, time).at(at.a), surface_at(*b, time).at(at.b)};
  }

 private:
  std::vector<Point3> end_a_, end_b_;
  double duration_ = 0;
};

ExitStatus run(const Options& options) {
  const Length tolerance = parse_length(options.tolerance, "--tolerance", true);
  ProgressBar bar("moving", options.quiet);
  const WorkMonitor monitor = bar.monitor();
  const MovingArguments moving(options, monitor);
  TimeOfContactOptions wanted;
  wanted.tolerance = tolerance.in_mesh_units(moving.pair.size(), moving.pair.units());
  if (!options.margin.empty())
    wanted.margin =
        parse_length(options.margin, "--margin", true).in_mesh_units(moving.pair.size(), moving.pair.units());
  wanted.solid = options.solid;
  Report report("time-of-contact", options);
  moving.pair.write_heads(report);
  const TimeOfContact answer = time_of_contact(*moving.a, *moving.b, wanted, run_of(options, monitor));
  if (report.json()) report.write().field("tolerance", *wanted.tolerance).field("margin", wanted.margin);
  // Where the witnesses are: at contact, or at the beginning.
  const Sides sides = moving.at(answer.time.upper < INFINITY ? answer.time.upper : 0, report);
  if (report.json()) write_fields(report.write(), answer, sides);
  report.text(sentence(answer, wanted));
  if (answer.witness) {
    for (const std::string& line : witness_lines(sides, *answer.witness)) report.text(line);
  }
  const ExitStatus status = report.finish(answer.outcome == Outcome::complete);
  return options.exit_code ? status_of(answer.verdict) : status;
}

ExitStatus run_clearance(const Options& options) {
  ProgressBar bar("moving", options.quiet);
  const WorkMonitor monitor = bar.monitor();
  const MovingArguments moving(options, monitor);
  ClearanceOptions wanted;
  if (!options.absolute.empty() || options.relative > 0) {
    wanted.absolute = options.absolute.empty() ? 0
                                               : parse_length(options.absolute, "--absolute", true)
                                                     .in_mesh_units(moving.pair.size(), moving.pair.units());
    wanted.relative = options.relative;
  } else {
    wanted.absolute = 1e-3 * moving.pair.size();
    wanted.relative = 0.1;
  }
  wanted.solid = options.solid;
  Report report("clearance", options);
  moving.pair.write_heads(report);
  const Clearance answer = clearance(*moving.a, *moving.b, wanted, run_of(options, monitor));
  if (report.json()) report.write().field("absolute", *wanted.absolute).field("relative", *wanted.relative);
  const Sides sides = moving.at(answer.time, report);
  if (report.json()) write_fields(report.write(), answer, sides);
  report.text(answer.distance.upper == 0
                  ? fmt::format("proved: at time {:.6g} they have a point in common", answer.time)
                  : fmt::format("at all times they are at least {} apart, at time {:.6g} at most {}",
                                text_at_most(answer.distance.lower), answer.time,
                                text_at_most(answer.distance.upper, true)));
  for (const std::string& line : witness_lines(sides, answer.witness)) report.text(line);
  for (const ClearanceSpan& span : answer.spans) {
    report.text(fmt::format("  from {:.6g} to {:.6g}: at least {}", span.time.lower, span.time.upper,
                            text_at_most(span.distance.lower)));
  }
  return report.finish(answer.outcome == Outcome::complete);
}

}  // namespace

namespace {

std::shared_ptr<Options> moving_options(OptionList& list) {
  auto options = std::make_shared<Options>();
  options->moves = true;
  options->max_splits = default_splits::time_of_contact;
  add_move_options(list, "-a", "A", options->move_a);
  add_move_options(list, "-b", "B", options->move_b);
  list.add(Group::own, "--solid", &options->solid,
           "Compare solids bounded by closed surfaces: one inside the other is in contact");
  return options;
}

}  // namespace

Command contact_command() {
  OptionList list;
  const std::shared_ptr<Options> options = moving_options(list);
  list.add(Group::own, "--tolerance LENGTH", &options->tolerance,
           "Surfaces this close may be reported as within; the time is narrowed until no point moves farther "
           "than this within its interval; mesh units, or percent of the larger mesh");
  list.add(Group::own, "--margin LENGTH", &options->margin,
           "Contact is being at most so far apart; mesh units, or percent of the larger mesh");
  list.add(Group::own, "--exit-code", &options->exit_code,
           "Exit with 0 if separated, 10 within, 11 intersecting, 12 undecided");
  add_pair_options(list, *options, false);
  return {
      "time-of-contact",
      Topic::two_surfaces,
      "Bound the time when two moving limit surfaces first touch; the lower bound is never too late",
      {"snug time-of-contact pawn.obj bust.obj --move-b \"3 0 0\" --velocity-b \"-3 0 0\" --spin-b \"z 90\"",
       "snug time-of-contact ball.obj hand.obj --deform-b closed_hand.obj"},
      std::move(list),
      [options] { return run(*options); },
      "contact"};
}

Command clearance_command() {
  OptionList list;
  const std::shared_ptr<Options> options = moving_options(list);
  list.add(Group::own, "--absolute LENGTH", &options->absolute,
           "Largest width of the interval of each span; mesh units, or percent of the larger mesh; default "
           "0.1%, or "
           "10 percent of the distance if that is more");
  list.add(Group::own, "--relative SHARE", &options->relative, "Or this fraction of its upper end")
      .between(0, 1);
  add_pair_options(list, *options, false);
  return {"clearance",
          Topic::two_surfaces,
          "How far apart do two moving limit surfaces stay? Bounds for every time, not for samples alone",
          {"snug clearance pawn.obj bust.obj --move-b \"9 0 -9\" --velocity-b \"0 0 18\"",
           "snug clearance gripper.obj part.obj --path-a path.txt --absolute 0.1 --json"},
          std::move(list),
          [options] { return run_clearance(*options); }};
}

}  // namespace snug::command
