#include <snug/hull.h>

#include <deque>

#include <fmt/core.h>
#include <support/atomic_file.h>

#include "hulls_of_mesh.h"
#include "length.h"
#include "progress_bar.h"

namespace snug::command {
namespace {

struct Options : CommonOptions {
  std::string mesh, tolerance, inner, outer;
  std::uint64_t most = HullOptions{}.budget;
};

void require_options(const Options& options) {
  require_tolerance("hull", options.tolerance);
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
  how.tolerance = parse_length(options.tolerance, "--tolerance").in_mesh_units(surface.size());
  how.inner = !options.inner.empty();
  how.outer = !options.outer.empty();
  how.budget = options.most;
  how.threads = options.threads;
  how.single_precision =
      (how.inner && format_of(options.inner).floats) || (how.outer && format_of(options.outer).floats);
  return how;
}

void write_summary(Report& report, const Options& options, const Surface& surface, double tolerance,
                   const Hulls& found) {
  if (report.json()) {
    JsonWriter& json = report.write();
    json.field("tolerance", tolerance).field("closed", found.closed);
    json.key("inner");
    write_hull(json, found.inner, found.verified);
    json.key("outer");
    write_hull(json, found.outer, found.verified);
  }
  for (const auto& [hull, file, name] :
       {std::tuple{&found.inner, &options.inner, "inner"}, {&found.outer, &options.outer, "outer"}}) {
    if (!*hull || !found.verified) continue;
    report.text(
        fmt::format("{}: {} hull of {} triangles, proved not to meet the limit surface, at most {} from it",
                    *file, name, (*hull)->triangles.size(), text_at_most((*hull)->gap, true)));
  }
  if (found.verified && !found.closed) {
    report.text("the surface is open: the hulls are sheets behind and in front of it, not solids");
  }
  write_verdict(report, found, surface.traits().owner());
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
    found = hulls(surface, how, monitor);
  });
  std::deque<AtomicFile> files;
  for (const auto& [hull, path] : {std::pair{&found.inner, &options.inner}, {&found.outer, &options.outer}}) {
    if (!*hull || !found.verified) continue;
    write_facets(mesh_of(**hull), files.emplace_back(*path), *path, options);
  }
  write_summary(report, options, surface, how.tolerance, found);
  std::vector<AtomicFile*> written;
  for (AtomicFile& file : files) written.push_back(&file);
  return report.finish(found.verified, written);
}

}  // namespace

Command hull_command() {
  auto options = std::make_shared<Options>();
  OptionList list;
  list.add(Group::own, "MESH", &options->mesh,
           "Control mesh (OBJ, OFF, PLY, STL, USD or glTF; - for standard input)");
  list.add(Group::own, "--tolerance LENGTH", &options->tolerance,
           "Largest distance between limit surface and hulls, either way; mesh units or percent (1%)");
  list.add(Group::own, "--inner FILE", &options->inner,
           "Write the hull behind the surface, inside the solid (OBJ, OFF, PLY, STL, USD or glTF)");
  list.add(Group::own, "--outer FILE", &options->outer,
           "Write the hull in front of the surface, around the solid");
  add_common_options(list, *options);
  list.add(Group::effort, "--budget N", &options->most, "At most N triangles in a hull");
  return {"hull",
          Topic::files,
          "Write triangles inside and outside a limit surface, proved not to touch it",
          {"snug hull pawn.obj --tolerance 1% --inner inner.ply --outer outer.ply"},
          std::move(list),
          [options] { return run(*options); }};
}

}  // namespace snug::command
