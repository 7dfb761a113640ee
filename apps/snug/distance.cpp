#include <snug/distance.h>

#include <fmt/core.h>

#include "answer_writer.h"
#include "certificate_file.h"
#include "length.h"
#include "placed_pair.h"
#include "pose_answers.h"
#include "progress_bar.h"
#include "scene_run.h"
#include "solids.h"
#include "witness.h"

namespace snug::command {
namespace {

struct Options : PairOptions {
  std::string precision = "0.01%";
  double relative = 0;
  bool solid = false;
  std::string limit;
};

// Bounds of the distance and witnesses of one pose among many.
std::string row(const Distance& answer) {
  const Point3 &a = answer.witness[0].point, &b = answer.witness[1].point;
  return fmt::format("{} {} {} {} {} {} {} {}", text_at_most(answer.distance.lower),
                     text_at_most(answer.distance.upper, true), a.x, a.y, a.z, b.x, b.y, b.z);
}

ExitStatus run_poses(const Options& options, PairArguments& pair, Report& report,
                     const DistanceOptions& wanted, const WorkMonitor& monitor) {
  const WorkMonitor quiet{.on_progress = {}, .stop = monitor.stop};
  const auto ask = [&](const PlacedSurface& a, const PlacedSurface& b, Workspace& workspace) {
    Distance answer = distance(a, b, wanted, run_of(options, quiet, &workspace));
    return PoseAnswer{
        .fields = [answer, sides = Sides{a, b}](JsonWriter& json) { write_fields(json, answer, sides); },
        .row = row(answer),
        .reached = answer.outcome == Outcome::complete};
  };
  CertificateFile certificate(options);
  const ProvePoses prove = [&](const std::vector<PosePair>& poses, std::vector<AtomicFile*>& files) {
    static_cast<void>(distance(pair.a().surface(), pair.b().surface(), poses, wanted,
                               certificate.with(run_of(options, monitor))));
    certificate.add_to(report, files);
  };
  return answer_poses(pair, report, "lower upper ax ay az bx by bz", ask,
                      certificate.wanted() ? prove : ProvePoses(), monitor);
}

ExitStatus run_scene(const Options& options) {
  if (options.limit.empty()) throw UsageError("--scene needs --limit: the largest clearance to list");
  const Length precision = parse_length(options.precision, "--absolute", true);
  const Length limit = parse_length(options.limit, "--limit", true);
  if (limit.percent) throw UsageError("--limit: give mesh units; parts of a scene differ in size");
  ProgressBar bar("measuring", options.quiet);
  const WorkMonitor monitor = bar.monitor();
  SceneRun run(options, monitor);
  const double within = limit.in_mesh_units(0, run.units());
  if (options.solid) run.require_closed();
  const WorkMonitor quiet{.on_progress = {}, .stop = monitor.stop};
  CertificateFile certificate(options);
  if (certificate.wanted()) run.require_alone();
  KeptAnswers<PairDistance> proved;
  SceneQuestion question;
  question.key = fmt::format("{} {}{} {} {} {}", precision.number, precision.percent, precision.unit,
                             options.relative, options.solid, options.max_splits);
  question.margin = within;
  question.margins = false;
  question.header = "lower upper ax ay az bx by bz";
  question.ask = [&](const ScenePair& pair, Workspace& workspace, SceneAnswer& answer, JsonWriter* json) {
    DistanceOptions wanted;
    wanted.absolute = precision.in_mesh_units(run.size_of(pair.parts), run.units());
    wanted.relative = options.relative;
    wanted.solid = options.solid;
    const std::optional<Distance> found =
        distance(run.scene(), pair, wanted, run_of(options, quiet, &workspace));
    if (found && certificate.wanted()) proved.add({pair.parts, *found});
    if (!found) {
      answer.verdict = Verdict::separated;
      return;
    }
    answer.verdict = found->distance.upper == 0 ? Verdict::intersecting : Verdict::within;
    answer.reached = found->outcome == Outcome::complete;
    answer.row = row(*found);
    if (json) write_fields(*json, *found, run.sides_of(pair.parts));
  };
  if (certificate.wanted()) {
    question.prove = [&](Report& report, std::vector<AtomicFile*>& files) {
      const DistanceOptions wanted{.solid = options.solid};
      certify(run.scene(), within, wanted, proved.all(), certificate.with(run_of(options, quiet)));
      certificate.add_to(report, files);
    };
  }
  question.head = [&](JsonWriter& json) {
    json.field("limit", within).key("absolute");
    precision.percent ? json.value(fmt::format("{}%", precision.number))
                      : json.value(precision.in_mesh_units(1, run.units()));
    json.field("relative", options.relative);
  };
  return run.answer(question, "distance", false);
}

ExitStatus run(const Options& options) {
  if (!options.scene.empty()) return run_scene(options);
  const Length precision = parse_length(options.precision, "--absolute", true);
  PairArguments pair(options);
  DistanceOptions wanted;
  wanted.absolute = precision.in_mesh_units(pair.size(), pair.units());
  wanted.relative = options.relative;
  wanted.solid = options.solid;
  ProgressBar bar("measuring", options.quiet);
  const WorkMonitor monitor = bar.monitor();
  pair.prepare(monitor);
  if (options.solid) pair.require_closed();
  Report report("distance", options);
  pair.write_heads(report);
  if (report.json()) report.write().field("absolute", *wanted.absolute).field("relative", *wanted.relative);
  if (!options.poses.empty()) return run_poses(options, pair, report, wanted, monitor);
  const Sides sides{pair.a(), pair.b()};
  CertificateFile certificate(options);
  const Distance answer = distance(pair.a(), pair.b(), wanted, certificate.with(run_of(options, monitor)));
  if (report.json()) {
    write_poses(report.write(), {pair.a().pose(), pair.b().pose()});
    write_fields(report.write(), answer, sides);
  }
  if (answer.distance.upper == 0) {
    report.text(answer.contained ? "proved: " + inner_sentence(*answer.contained)
                                 : "proved: the limit surfaces have a point in common");
  } else {
    report.text(fmt::format("the limit surfaces are at least {} and at most {} apart{}",
                            text_at_most(answer.distance.lower), text_at_most(answer.distance.upper, true),
                            answer.outcome == Outcome::complete ? ""
                            : answer.outcome == Outcome::budget_spent
                                ? "; the precision was not reached, give a larger --max-splits"
                                : "; the precision was not reached because of rounding or memory"));
  }
  for (const std::string& line : witness_lines(sides, answer.witness)) {
    report.text(line);
  }
  if (answer.distance.lower > 0 && !options.solid) note_nesting(options, pair.a(), pair.b(), monitor);
  std::vector<AtomicFile*> files;
  certificate.add_to(report, files);
  return report.finish(answer.outcome == Outcome::complete, files);
}

}  // namespace

Command distance_command() {
  auto options = std::make_shared<Options>();
  options->max_splits = default_splits::distance;
  OptionList list;
  list.add(Group::own, "--absolute LENGTH", &options->precision,
           "Largest width of the interval; mesh units, or percent of the larger mesh")
      .formerly("--precision");
  list.add(Group::own, "--relative SHARE", &options->relative, "Or this fraction of the upper bound")
      .between(0, 1);
  list.add(Group::own, "--solid", &options->solid,
           "Compare solids bounded by closed surfaces: 0 if one is inside the other");
  add_pair_options(list, *options);
  add_certificate_option(list, *options).excludes("--resume");
  list.add(Group::own, "--limit LENGTH", &options->limit,
           "List the pairs of a scene that are at most this far apart; mesh units")
      .needs("--scene");
  return {"distance",
          Topic::two_surfaces,
          "How far apart are two limit surfaces? Prints bounds and two points",
          {"snug distance pawn.obj bust.obj --rotate-b \"z 30\" --move-b \"9 0 0\"",
           "snug distance --scene assembly.json --limit 0.5"},
          std::move(list),
          [options] { return run(*options); }};
}

}  // namespace snug::command
