#include <snug/hull.h>

#include <algorithm>
#include <deque>

#include <fmt/core.h>
#include <support/atomic_file.h>

#include "hulls_of_mesh.h"
#include "length.h"
#include "progress_bar.h"

namespace snug::command {
namespace {

struct Options : CommonOptions {
  std::string mesh, error, inner, outer;
};

void require_options(const Options& options) {
  require_error("hull", options.error);
  if (options.inner.empty() && options.outer.empty()) {
    throw UsageError("hull: give --inner FILE, --outer FILE, or both: where the triangles go");
  }
  if (options.inner == options.outer) throw UsageError("hull: --inner and --outer name the same file");
  for (const std::string& file : {options.inner, options.outer}) {
    if (file == "-") throw UsageError("hull: standard output takes no hull; give a file");
    if (file.empty()) continue;
    static_cast<void>(format_of(file));
    require_writable(file);
  }
}

HullOptions how_to(const Options& options, const Surface& surface) {
  HullOptions how;
  how.error = parse_length(options.error, "--error").in_mesh_units(surface.size(), units_of(surface));
  how.inner = !options.inner.empty();
  how.outer = !options.outer.empty();
  how.single_precision =
      (how.inner && format_of(options.inner).floats) || (how.outer && format_of(options.outer).floats);
  return how;
}

void write_summary(Report& report, const Options& options, const Surface& surface, double error,
                   const Hulls& found) {
  if (report.json()) {
    JsonWriter& json = report.write();
    json.field("error", error).field("closed", found.closed);
    json.key("inner");
    write_hull(json, found.inner);
    json.key("outer");
    write_hull(json, found.outer);
  }
  for (const auto& [hull, file, name] :
       {std::tuple{&found.inner, &options.inner, "inner"}, {&found.outer, &options.outer, "outer"}}) {
    if (!*hull || found.outcome != Outcome::complete) continue;
    report.text(
        fmt::format("{}: {} hull of {} triangles, proved not to meet the limit surface, at most {} from it",
                    *file, name, (*hull)->triangles.size(), text_at_most((*hull)->gap, true)));
  }
  if (found.outcome == Outcome::complete && !found.closed) {
    report.text("the surface is open: the hulls are sheets behind and in front of it, not solids");
  }
  write_verdict(report, found, surface.traits().owner());
  // Of surfaces through themselves each place says so.
  if (found.outcome != Outcome::complete &&
      std::none_of(found.problems.begin(), found.problems.end(),
                   [](const HullProblem& p) { return p.fault == HullFault::through_itself; })) {
    if (!options.inner.empty() && !options.outer.empty() && !found.outer)
      report.text("no outer hull was made, since the inner one failed; without --inner it is made alone");
    report.text("snug envelope makes one closed mesh around a surface of any sort, within an error too");
  }
}

ExitStatus run(const Options& options) {
  require_options(options);
  const Surface surface = read_surface(options.mesh, options, options.scheme);
  Report report("hull", options);
  report.heads({options.mesh}, {name_of(surface.scheme())});
  HullOptions how;
  Hulls found;
  naming(options.mesh, [&] {
    how = how_to(options, surface);
    ProgressBar bar("making hulls of " + options.mesh, options.quiet);
    const WorkMonitor monitor = bar.monitor();
    found = hull(surface, how, run_of(options, monitor));
  });
  std::deque<AtomicFile> files;
  for (const auto& [hull, path] : {std::pair{&found.inner, &options.inner}, {&found.outer, &options.outer}}) {
    if (!*hull || found.outcome != Outcome::complete) continue;
    write_facets(mesh_of(**hull), files.emplace_back(*path), *path, options, units_of(surface));
  }
  write_summary(report, options, surface, *how.error, found);
  std::vector<AtomicFile*> written;
  for (AtomicFile& file : files) written.push_back(&file);
  return report.finish(found.outcome == Outcome::complete, written);
}

}  // namespace

Command hull_command() {
  auto options = std::make_shared<Options>();
  options->max_splits = default_splits::hull;
  OptionList list;
  list.add(Group::own, "MESH", &options->mesh, mesh_or_input_help);
  list.add(Group::own, "--error LENGTH", &options->error,
           "Largest distance between limit surface and hulls, either way; mesh units or percent, such as 1%")
      .formerly("--tolerance");
  list.add(Group::own, "--inner FILE", &options->inner,
           "Write the hull behind the surface, inside the solid (OBJ, OFF, PLY, STL, USD, glTF or 3MF)");
  list.add(Group::own, "--outer FILE", &options->outer,
           "Write the hull in front of the surface, around the solid");
  add_common_options(list, *options);
  list.add(Group::effort, "--max-splits N", &options->max_splits, "At most N triangles in a hull")
      .formerly("--budget");
  return {"hull",
          Topic::files,
          "Write triangles inside and outside a limit surface, proved not to touch it",
          {"snug hull pawn.obj --error 1% --inner inner.ply --outer outer.ply"},
          std::move(list),
          [options] { return run(*options); }};
}

}  // namespace snug::command
