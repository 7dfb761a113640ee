#include <algorithm>
#include <span>

#include <fmt/core.h>
#include <snug/distance.h>
#include <snug/evaluate.h>
#include <snug/hull.h>
#include <snug/inspect.h>
#include <support/atomic_file.h>
#include <support/error.h>
#include <support/read_file.h>

#include "answer_writer.h"
#include "hulls_of_mesh.h"
#include "length.h"
#include "pose.h"
#include "progress_bar.h"
#include "scene_file.h"

namespace snug::command {
namespace {

struct Options : CommonOptions {
  std::string mesh, scene, error, clearance, gap, part;
  bool nearest_rigid = false;
};

// The triangles, and what is proved of them.
struct Found {
  Hulls hulls;  // the outer one
  std::optional<Interval> volume;
  double clearance = 0;  // 0 where they do not touch the surface, and no more is known
  std::optional<double> gap;
  std::size_t bridges = 0;
  double bridge_distance = 0;
};

// The surfaces to wrap: one, or the parts of a scene.
struct Wrapped {
  std::string name;  // of the file
  std::vector<std::string> meshes, schemes;
  std::vector<PlacedSurface> parts;
  double size = 0;                // that lengths in percent are of
  std::optional<double> units{};  // in metres
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
    write_field(json, "clearance", fit.clearance, {});
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

void write_summary(Report& report, const Options& options, const Wrapped& wrapped, double error,
                   const Found& found) {
  const std::optional<Hull>& outer = found.hulls.outer;
  const bool complete = found.hulls.outcome == Outcome::complete;
  if (report.json()) {
    JsonWriter& json = report.write();
    if (!options.scene.empty()) json.field("scene", options.scene);
    json.field("error", error).field("clearance", found.clearance).key("envelope");
    write_hull(json, outer);
    write_field(json, "volume", complete ? found.volume : std::nullopt, {});
    if (found.gap) {
      json.key("bridges").begin_object().field("diameter", *found.gap).field("triangles", found.bridges);
      json.field("distance", found.bridge_distance).end_object();
    }
  }
  if (complete) {
    const std::string apart = found.clearance > 0
                                  ? fmt::format("at least {} and", text_at_most(found.clearance))
                                  : "not to touch its limit surface,";
    report.text(fmt::format("{}: {} triangles around the surface, proved closed and {} at most {} from {}",
                            options.output.empty() ? "envelope" : options.output, outer->triangles.size(),
                            apart, text_at_most(found.gap ? error : outer->gap, true),
                            found.clearance > 0 ? "its limit surface" : "it"));
    if (found.bridges > 0) {
      report.text(fmt::format(
          "but for {} of them, across holes that no ball of diameter {:.6g} gets into: at most {}",
          found.bridges, *found.gap, text_at_most(found.bridge_distance, true)));
    } else if (found.gap) {
      report.text(fmt::format("a ball of diameter {:.6g} gets near enough everywhere: no hole is filled",
                              *found.gap));
    }
  }
  write_verdict(report, found.hulls, wrapped.parts.front().surface().traits().owner());
}

Wrapped read_wrapped(const Options& options, const WorkMonitor& monitor) {
  if (options.scene.empty()) {
    const Surface surface = read_surface(options.mesh, options, options.scheme);
    return {options.mesh, {options.mesh}, {name_of(surface.scheme())},
            {surface},    surface.size(), units_of(surface)};
  }
  const LoadedScene scene = load_scene(
      options.scene, options, options.nearest_rigid,
      [&](const std::string& path) { return read_file(path, monitor); }, monitor);
  Wrapped wrapped{.name = options.scene, .meshes = {}, .schemes = {}, .parts = scene.scene.parts};
  for (std::size_t i = 0; i < scene.surfaces.size(); ++i) {
    wrapped.meshes.push_back(scene.text.meshes[i].file);
    wrapped.schemes.push_back(name_of(scene.surfaces[i].scheme()));
  }
  wrapped.units = common_units(scene.surfaces, wrapped.meshes);
  // As envelope() takes it: of the box around all.
  const SceneBroadPhase broad(scene.scene, 0, false, run_of(options, monitor));
  Box3 all;
  for (std::uint32_t i = 0; i < wrapped.parts.size(); ++i) all.add(broad.box(i));
  for (std::size_t a = 0; a < 3; ++a) wrapped.size = std::max(wrapped.size, all.upper[a] - all.lower[a]);
  return wrapped;
}

// A wrap; the outer hull of a solid where the error is too small for that.
Found find(const Wrapped& wrapped, const Options& options, double error, const WorkMonitor& monitor) {
  EnvelopeOptions how{.error = error};
  how.single_precision = !options.output.empty() && format_of(options.output).floats;
  if (!options.clearance.empty()) {
    how.clearance = parse_length(options.clearance, "--clearance").in_mesh_units(wrapped.size, wrapped.units);
  }
  if (!options.gap.empty())
    how.gap = parse_length(options.gap, "--gap").in_mesh_units(wrapped.size, wrapped.units);
  Envelope wrap = envelope(wrapped.parts, how, run_of(options, monitor));
  Found found;
  const Surface& surface = wrapped.parts.front().surface();
  if (options.scene.empty() && wrap.outcome == Outcome::budget_spent && !how.clearance && !how.gap &&
      !surface.open_reason() && count_elements(surface.mesh(), surface.scheme()).many_sided_edges == 0) {
    // Triangles take more memory than cubes.
    Run run = run_of(options, monitor);
    run.max_splits = std::min(options.max_splits, default_splits::hull);
    found.hulls =
        hull(surface, {.error = error, .inner = false, .single_precision = how.single_precision}, run);
    return found;
  }
  found.clearance = wrap.clearance;
  found.gap = how.gap;
  found.bridges = wrap.bridges.size();
  found.bridge_distance = wrap.bridge_distance;
  found.volume = wrap.volume;
  found.hulls.outcome = wrap.outcome;
  found.hulls.problems = std::move(wrap.problems);
  found.hulls.outer = Hull{.positions = std::move(wrap.positions),
                           .triangles = std::move(wrap.triangles),
                           .owners = {},
                           .gap = std::max(error, wrap.bridge_distance)};
  return found;
}

ExitStatus run(const Options& options) {
  require_options(options);
  const WorkMonitor reading = stopped_by_interrupts();
  const Wrapped wrapped = read_wrapped(options, reading);
  std::optional<Surface> part;
  if (!options.part.empty()) part.emplace(read_surface(options.part, options, options.scheme));
  CommonOptions to_standard_output = options;
  to_standard_output.output.clear();
  Report report("envelope", to_standard_output);
  report.heads(wrapped.meshes, wrapped.schemes);
  Found found;
  double error = 0;
  ProgressBar bar("making an envelope of " + wrapped.name, options.quiet);
  const WorkMonitor monitor = bar.monitor();
  naming(wrapped.name, [&] {
    error = parse_length(options.error, "--error").in_mesh_units(wrapped.size, wrapped.units);
    found = find(wrapped, options, error, monitor);
  });
  const bool complete = found.hulls.outcome == Outcome::complete;
  std::optional<Fit> fit;
  if (part && complete)
    naming(options.part, [&] { fit = fit_of(*part, *found.hulls.outer, options, monitor); });
  write_summary(report, options, wrapped, error, found);
  if (fit) write_fit(report, options, *fit);
  const bool reached = complete && (!fit || fit->inside);
  if (options.output.empty() || !complete) return report.finish(reached);
  AtomicFile file(options.output);
  write_facets(mesh_of(*found.hulls.outer), file, options.output, options, wrapped.units);
  return report.finish(reached, {&file});
}

}  // namespace

Command envelope_command() {
  auto options = std::make_shared<Options>();
  options->max_splits = default_splits::envelope;
  OptionList list;
  list.add(Group::own, "MESH", &options->mesh,
           "Control mesh (OBJ, OFF, PLY, STL, USD, glTF or 3MF; - for standard input), open or closed")
      .unless("--scene");
  list.add(Group::own, "--scene FILE", &options->scene,
           "Wrap all parts that a JSON file names and places together, instead of MESH");
  list.add(Group::own, "--error LENGTH", &options->error,
           "Largest distance of the envelope's points from the limit surface; mesh units or percent, such as "
           "1%")
      .formerly("--tolerance");
  list.add(Group::own, "--clearance LENGTH", &options->clearance,
           "Their least distance; mesh units or percent. Default: a quarter of the error");
  list.add(Group::own, "--gap LENGTH", &options->gap,
           "Fill what no ball of this diameter gets into from outside: holes, tubes, grooves; mesh units or "
           "percent");
  list.add(
      Group::own, "--part FILE", &options->part,
      "Report whether the limit surface of this control mesh lies inside the envelope, and how far from it");
  add_nearest_rigid_option(list, options->nearest_rigid).needs("--scene");
  add_common_options(list, *options);
  list.add(Group::effort, "--max-splits N", &options->max_splits,
           "At most N cubes in which it is sampled, or triangles of a hull")
      .formerly("--budget");
  return {"envelope",
          Topic::files,
          "Write a closed mesh around a limit surface of any sort, proved to keep a clearance",
          {"snug envelope pawn.obj --error 1% -o around.stl",
           "snug envelope scan.stl --error 1% --gap 5% -o closed.stl",
           "snug envelope pawn.obj --error 2% --part pin.obj"},
          std::move(list),
          [options] { return run(*options); }};
}

}  // namespace snug::command
