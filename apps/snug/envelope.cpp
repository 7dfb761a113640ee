#include <fmt/core.h>
#include <snug/distance.h>
#include <snug/evaluate.h>
#include <snug/hull.h>
#include <snug/inspect.h>
#include <support/atomic_file.h>
#include <support/error.h>

#include "hulls_of_mesh.h"
#include "length.h"
#include "progress_bar.h"

namespace snug::command {
namespace {

struct Options : CommonOptions {
  std::string mesh, error, part;
};

// Where a part is: its surface and the envelope are `clearance` apart; nothing where it is undecided whether
// it is inside.
struct Fit {
  std::optional<bool> inside;
  Interval clearance;
};

void require_options(const Options& options) {
  require_error("envelope", options.error);
  if (options.output == "-") throw UsageError("envelope: standard output takes no envelope; give a file");
  if (options.output.empty() && options.part.empty()) {
    throw UsageError("envelope: give -o FILE, where the triangles go, or --part FILE, or both");
  }
}

// Of surfaces that do not meet, all of a face is inside of the other one or none of it.
Fit fit_of(const Surface& part, const Hull& envelope, const Options& options, const WorkMonitor& monitor) {
  const Surface around(mesh_of(envelope), {.scheme = Scheme::flat}, run_of(options, monitor));
  const WorkMonitor quiet{.on_progress = {}, .stop = monitor.stop};
  const Distance found = distance(part, around, {.relative = 0.01}, {.monitor = &quiet});
  Fit fit{.inside = {}, .clearance = found.distance};
  if (found.distance.upper == 0) fit.inside = false;
  if (!(found.distance.lower > 0)) return fit;
  fit.inside = true;
  for (std::uint32_t owner = 0; owner < part.owner_count() && fit.inside == true; ++owner) {
    const Place middle{owner, 0, 1.0 / 3, 1.0 / 3};
    if (!part.has(middle)) continue;
    const SurfacePoint at = evaluate(part, middle);
    // The limit point that it stands for is on the same side.
    if (2 * at.error > found.distance.lower) return {.inside = {}, .clearance = found.distance};
    fit.inside = contains(around, at.point, {.monitor = &quiet});
  }
  return fit;
}

void write_fit(Report& report, const Options& options, const Fit& fit) {
  if (report.json()) {
    JsonWriter& json = report.write();
    json.key("part").begin_object().field("mesh", options.part).key("inside");
    fit.inside ? json.value(*fit.inside) : json.null();
    json.key("clearance").begin_array().value(fit.clearance.lower).value(fit.clearance.upper).end_array();
    json.end_object();
  }
  const std::string apart =
      fmt::format("at least {} and at most {} from it", text_at_most(fit.clearance.lower),
                  text_at_most(fit.clearance.upper, true));
  if (!fit.inside) {
    report.text(
        fmt::format("{}: undecided, its limit surface is too near to the envelope, {}", options.part, apart));
  } else if (*fit.inside) {
    report.text(fmt::format("{}: proved, its limit surface is inside the envelope, {}", options.part, apart));
  } else if (fit.clearance.upper > 0) {
    report.text(fmt::format("{}: proved, its limit surface or a part of it is outside the envelope, {}",
                            options.part, apart));
  } else {
    report.text(fmt::format("{}: proved, its limit surface touches the envelope", options.part));
  }
}

void write_summary(Report& report, const Options& options, const Surface& surface, double error,
                   const Hulls& found) {
  if (report.json()) {
    report.write().field("error", error).key("envelope");
    write_hull(report.write(), found.outer);
  }
  if (found.outcome == Outcome::complete) {
    report.text(
        fmt::format("{}: {} triangles around the solid, proved closed and not to touch its limit surface, at "
                    "most {} from it",
                    options.output.empty() ? "envelope" : options.output, found.outer->triangles.size(),
                    text_at_most(found.outer->gap, true)));
  }
  write_verdict(report, found, surface.traits().owner());
}

ExitStatus run(const Options& options) {
  require_options(options);
  const Surface surface = read_surface(options.mesh, options, options.scheme);
  std::optional<Surface> part;
  if (!options.part.empty()) part.emplace(read_surface(options.part, options, options.scheme));
  CommonOptions to_standard_output = options;
  to_standard_output.output.clear();
  Report report("envelope", to_standard_output);
  report.heads({options.mesh}, {name_of(surface.scheme())});
  HullOptions how{.inner = false};
  how.single_precision = !options.output.empty() && format_of(options.output).floats;
  Hulls found;
  ProgressBar bar("making an envelope of " + options.mesh, options.quiet);
  const WorkMonitor monitor = bar.monitor();
  naming(options.mesh, [&] {
    how.error = parse_length(options.error, "--error").in_mesh_units(surface.size());
    require_closed(surface);
    if (count_elements(surface.mesh(), surface.scheme()).many_sided_edges > 0) {
      throw InputError(InputProblem::refused,
                       "envelope: edges of more than two faces have no envelope; 'snug info' lists them");
    }
    found = hull(surface, how, run_of(options, monitor));
  });
  std::optional<Fit> fit;
  if (part && found.outcome == Outcome::complete)
    naming(options.part, [&] { fit = fit_of(*part, *found.outer, options, monitor); });
  write_summary(report, options, surface, *how.error, found);
  if (fit) write_fit(report, options, *fit);
  const bool reached = found.outcome == Outcome::complete && (!fit || fit->inside);
  if (options.output.empty() || found.outcome != Outcome::complete) return report.finish(reached);
  AtomicFile file(options.output);
  write_facets(mesh_of(*found.outer), file, options.output, options);
  return report.finish(reached, {&file});
}

}  // namespace

Command envelope_command() {
  auto options = std::make_shared<Options>();
  options->max_splits = default_splits::hull;
  OptionList list;
  list.add(Group::own, "MESH", &options->mesh,
           "Control mesh of a solid (OBJ, OFF, PLY, STL, USD or glTF; - for standard input)");
  list.add(Group::own, "--error LENGTH", &options->error,
           "Largest distance between limit surface and envelope, either way; mesh units or percent, such as "
           "1%")
      .formerly("--tolerance");
  list.add(
      Group::own, "--part FILE", &options->part,
      "Report whether the limit surface of this control mesh lies inside the envelope, and how far from it");
  add_common_options(list, *options);
  list.add(Group::effort, "--max-splits N", &options->max_splits, "At most N triangles in the envelope")
      .formerly("--budget");
  return {
      "envelope",
      Topic::files,
      "Write a closed mesh around the solid bounded by a limit surface, proved not to touch it",
      {"snug envelope pawn.obj --error 1% -o around.stl", "snug envelope pawn.obj --error 2% --part pin.obj"},
      std::move(list),
      [options] { return run(*options); }};
}

}  // namespace snug::command
