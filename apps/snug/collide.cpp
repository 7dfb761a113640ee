#include <snug/collide.h>

#include <optional>

#include <fmt/core.h>
#include <snug/contacts.h>
#include <support/atomic_file.h>
#include <support/run.h>

#include "answer_writer.h"
#include "certificate_file.h"
#include "contact_report.h"
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
  std::string tolerance = "0.1%", margin = "0";
  bool solid = false;
  bool penetration = false;
  bool exit_code = false;
  bool all = false;
  std::string precision = "0.1%", curves;
  bool all_pairs = false;
};

// How to decide more: where the budget was not spent, rounding is in the way.
const char* advice(const Collision& answer, const CollideOptions& asked) {
  if (answer.outcome == Outcome::budget_spent) return "give a larger --max-splits";
  return *asked.tolerance > 0
             ? "rounding is in the way: give a larger --tolerance"
             : "surfaces that touch cannot be distinguished from surfaces one rounding apart: give a "
               "--tolerance above 0";
}

// The verdict as a sentence for people.
std::string sentence(const Collision& answer, const CollideOptions& asked) {
  const bool measured = answer.distance.upper < INFINITY;
  const std::string upper = measured ? text_at_most(answer.distance.upper, true) : "";
  switch (answer.verdict) {
    case Verdict::separated:
      return fmt::format("separated: proved, the limit surfaces are at least {} apart{}",
                         text_at_most(answer.distance.lower), measured ? ", at most " + upper : "");
    case Verdict::within:
      return fmt::format("within: two points of the limit surfaces are at most {} apart (asked: {:.6g})",
                         upper, asked.margin + *asked.tolerance);
    case Verdict::intersecting:
      return answer.contained ? "intersecting: proved, " + inner_sentence(*answer.contained)
             : asked.solid    ? "intersecting: proved, the solids have a point in common"
                              : "intersecting: proved, the limit surfaces have a point in common";
    case Verdict::undecided:
      break;
  }
  return fmt::format("undecided: the distance lies in [{}, {}]; {}", text_at_most(answer.distance.lower),
                     measured ? upper : "?", advice(answer, asked));
}

// Verdict, bounds of the distance and witnesses of one pose among many.
std::string row(const Collision& answer) {
  std::string text =
      fmt::format("{} {} {}", name_of(answer.verdict), text_at_most(answer.distance.lower),
                  answer.distance.upper < INFINITY ? text_at_most(answer.distance.upper, true) : "-");
  for (std::size_t side = 0; side < 2; ++side) {
    if (!answer.witness) {
      text += " - - -";
      continue;
    }
    const Point3& p = (*answer.witness)[side].point;
    text += fmt::format(" {} {} {}", p.x, p.y, p.z);
  }
  return text;
}

// The command is asked once, and says all that can be shown.
constexpr CollideOptions thorough{.prove_contact = true, .measure = true};

ExitStatus run_poses(const Options& options, PairArguments& pair, Report& report,
                     const CollideOptions& wanted, const WorkMonitor& monitor) {
  const WorkMonitor quiet{.on_progress = {}, .stop = monitor.stop};
  const auto ask = [&](const PlacedSurface& a, const PlacedSurface& b, Workspace& workspace) {
    Collision answer = collide(a, b, wanted, run_of(options, quiet, &workspace));
    return PoseAnswer{
        .fields = [answer, sides = Sides{a, b}](JsonWriter& json) { write_fields(json, answer, sides); },
        .row = row(answer),
        .reached = answer.verdict != Verdict::undecided};
  };
  CertificateFile certificate(options);
  const ProvePoses prove = [&](const std::vector<PosePair>& poses, std::vector<AtomicFile*>& files) {
    static_cast<void>(collide(pair.a().surface(), pair.b().surface(), poses, wanted,
                              certificate.with(run_of(options, monitor))));
    certificate.add_to(report, files);
  };
  return answer_poses(pair, report, "verdict lower upper ax ay az bx by bz", ask,
                      certificate.wanted() ? prove : ProvePoses(), monitor);
}

void require_curves(const Options& options) {
  if (options.curves.empty()) return;
  if (!options.curves.ends_with(".obj")) {
    throw UsageError("collide: --curves writes lines of OBJ; give a file name that ends in .obj");
  }
  require_writable(options.curves);
}

// With --all: every contact, and the file of --curves.
std::optional<Contacts> all_contacts(const Options& options, double tolerance, double precision,
                                     PairArguments& pair, const WorkMonitor& monitor) {
  if (!options.all) return std::nullopt;
  return contacts(pair.a(), pair.b(), {.within = tolerance, .error = precision}, run_of(options, monitor));
}

void prove_contact(Collision& answer) {
  answer.verdict = Verdict::intersecting;
  answer.outcome = Outcome::complete;
  answer.distance = {0, 0};
}

// Fills the row, and writes the fields where they are wanted.
void write_to(const Collision& found, const SceneRun& run, const ScenePair& pair, SceneAnswer& answer,
              JsonWriter* json) {
  answer.verdict = found.verdict;
  answer.reached = found.verdict != Verdict::undecided;
  answer.row = row(found);
  if (json) write_fields(*json, found, run.sides_of(pair.parts));
}

ExitStatus run_scene(const Options& options) {
  ProgressBar bar("colliding", options.quiet);
  const WorkMonitor monitor = bar.monitor();
  SceneRun run(options, monitor);
  if (options.solid) run.require_closed();
  const SceneText& text = run.loaded().text;
  const Length tolerance = text.tolerance.value_or(parse_length(options.tolerance, "--tolerance", true));
  const WorkMonitor quiet{.on_progress = {}, .stop = monitor.stop};
  CertificateFile certificate(options);
  if (certificate.wanted()) run.require_alone();
  KeptAnswers<PairCollision> proved;
  SceneQuestion question;
  question.key = fmt::format("{} {}{} {} {}", tolerance.number, tolerance.percent, tolerance.unit,
                             options.solid, options.max_splits);
  question.margin = text.margin;
  question.all_pairs = options.all_pairs;
  question.header = "verdict lower upper ax ay az bx by bz";
  question.ask = [&](const ScenePair& pair, Workspace& workspace, SceneAnswer& answer, JsonWriter* json) {
    CollideOptions wanted = thorough;
    wanted.tolerance = tolerance.in_mesh_units(run.size_of(pair.parts), run.units());
    wanted.solid = options.solid;
    const Collision found = collide(run.scene(), pair, wanted, run_of(options, quiet, &workspace));
    if (certificate.wanted()) proved.add({pair.parts, found});
    write_to(found, run, pair, answer, json);
  };
  if (certificate.wanted()) {
    question.prove = [&](Report& report, std::vector<AtomicFile*>& files) {
      const CollideOptions wanted{.margin = text.margin, .solid = options.solid};
      certify(run.scene(), wanted, proved.all(), certificate.with(run_of(options, quiet)));
      certificate.add_to(report, files);
    };
  }
  question.separated = [&](const ScenePair& pair, SceneAnswer& answer, JsonWriter* json) {
    Collision apart;
    apart.verdict = Verdict::separated;
    apart.distance.lower = pair.gap;
    write_to(apart, run, pair, answer, json);
  };
  question.head = [&](JsonWriter& json) {
    json.key("tolerance");
    tolerance.percent ? json.value(fmt::format("{}%", tolerance.number))
                      : json.value(tolerance.in_mesh_units(1, run.units()));
    json.field("margin", text.margin);
  };
  return run.answer(question, "collide", options.exit_code);
}

ExitStatus run(const Options& options) {
  if (!options.scene.empty()) return run_scene(options);
  require_curves(options);
  const Length precision = parse_length(options.precision, "--error");
  const Length tolerance = parse_length(options.tolerance, "--tolerance", true);
  const Length margin = parse_length(options.margin, "--margin", true);
  PairArguments pair(options);
  CollideOptions wanted = thorough;
  wanted.tolerance = tolerance.in_mesh_units(pair.size(), pair.units());
  wanted.margin = margin.in_mesh_units(pair.size(), pair.units());
  wanted.solid = options.solid;
  ProgressBar bar("colliding", options.quiet);
  const WorkMonitor monitor = bar.monitor();
  pair.prepare(monitor);
  if (options.solid) pair.require_closed();
  Report report("collide", options);
  pair.write_heads(report);
  if (report.json()) report.write().field("tolerance", *wanted.tolerance).field("margin", wanted.margin);
  if (!options.poses.empty()) return run_poses(options, pair, report, wanted, monitor);
  const Sides sides{pair.a(), pair.b()};
  CertificateFile certificate(options);
  Collision answer = collide(pair.a(), pair.b(), wanted, certificate.with(run_of(options, monitor)));
  std::optional<Penetration> depth;
  if (options.penetration) depth = penetration(pair.a(), pair.b(), {}, {.monitor = &monitor});
  if (depth && depth->depth.lower > 0) prove_contact(answer);
  const std::optional<Contacts> all = all_contacts(
      options, *wanted.tolerance, precision.in_mesh_units(pair.size(), pair.units()), pair, monitor);
  // A curve, a crossing or an area proves what the verdict alone may not.
  if (all && std::any_of(all->regions.begin(), all->regions.end(), [](const ContactRegion& region) {
        return region.verdict == Verdict::intersecting;
      })) {
    prove_contact(answer);
  }
  std::optional<AtomicFile> curves;
  if (all && !options.curves.empty()) write_curves(all->curves, curves.emplace(options.curves));
  if (report.json()) {
    write_poses(report.write(), {pair.a().pose(), pair.b().pose()});
    Collision shown = answer;
    if (all) shown.outcome = worse(answer.outcome, all->outcome);
    write_fields(report.write(), shown, sides);
    if (depth) write_field(report.write(), "penetration", *depth, sides);
    if (all) write_fields(report.write(), *all, sides, "outcome");
  }
  report.text(sentence(answer, wanted));
  if (answer.witness) {
    for (const std::string& line : witness_lines(sides, *answer.witness)) {
      report.text(line);
    }
  }
  if (depth) {
    report.text(penetration_sentence(*depth));
    if (depth->outcome != Outcome::complete) report.text("the bounds of the depth differ by more than 5 %");
  }
  if (all) {
    for (const std::string& line : contact_lines(sides, *all)) report.text(line);
  }
  if (answer.verdict == Verdict::separated && !options.solid)
    note_nesting(options, pair.a(), pair.b(), monitor);
  std::vector<AtomicFile*> files;
  if (curves) files.push_back(&*curves);
  certificate.add_to(report, files);
  const ExitStatus status =
      report.finish(answer.verdict != Verdict::undecided && (!depth || depth->outcome == Outcome::complete) &&
                        (!all || all->outcome == Outcome::complete),
                    files);
  return options.exit_code ? status_of(answer.verdict) : status;
}

}  // namespace

Command collide_command() {
  auto options = std::make_shared<Options>();
  options->max_splits = default_splits::collide;
  OptionList list;
  list.add(Group::own, "--tolerance LENGTH", &options->tolerance,
           "Surfaces this close may be reported as within; mesh units, or percent of the larger mesh");
  list.add(Group::own, "--margin LENGTH", &options->margin,
           "Required clearance; mesh units, or percent of the larger mesh");
  list.add(Group::own, "--solid", &options->solid,
           "Compare solids bounded by closed surfaces: one inside the other intersects it");
  list.add(Group::own, "--penetration", &options->penetration,
           "Bound the shortest translation that separates the solids, and print one that does")
      .needs("--solid")
      .excludes("--poses")
      .excludes("--scene");
  list.add(Group::own, "--all", &options->all,
           "List every contact within the tolerance, in regions, and the curves in which the surfaces "
           "intersect")
      .excludes("--poses")
      .excludes("--scene")
      .excludes("--solid");
  list.add(Group::own, "--error LENGTH", &options->precision,
           "Largest distance between a curve and the line segments through its points; mesh units, or "
           "percent of the larger mesh")
      .formerly("--precision")
      .needs("--all");
  list.add(Group::own, "--curves FILE", &options->curves, "Write the curves as lines of an OBJ file")
      .needs("--all");
  list.add(Group::own, "--exit-code", &options->exit_code,
           "Exit with 0 if separated, 10 within, 11 intersecting, 12 undecided; for a scene, the first of "
           "11, 12, 10, 0 that occurs")
      .excludes("--poses");
  list.at("--tolerance").excludes("--scene");
  list.at("--margin").excludes("--scene");
  add_pair_options(list, *options);
  add_certificate_option(list, *options).excludes("--penetration").excludes("--all").excludes("--resume");
  list.add(Group::own, "--all-pairs", &options->all_pairs,
           "Also list the pairs of a scene that are separated by the boxes around its parts")
      .needs("--scene");
  return {"collide",
          Topic::two_surfaces,
          "Do two limit surfaces touch? The verdict is a proof",
          {"snug collide pawn.obj bust.obj --move-b \"3 0 0\"", "snug collide --scene assembly.json --json"},
          std::move(list),
          [options] { return run(*options); }};
}

}  // namespace snug::command
